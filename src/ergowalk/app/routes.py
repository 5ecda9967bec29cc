"""The addresses of the app: its page, its sessions, their solves, and what is downloaded."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from importlib import resources
from urllib.parse import unquote

from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Route

from ergowalk.app.desk import Desk
from ergowalk.app.events import EventStream
from ergowalk.app.guard import Guard, body_within, too_large
from ergowalk.app.options import Options
from ergowalk.app.problems import asked_problem, form, short, uploaded_problem, values_of
from ergowalk.app.process import WorkerError
from ergowalk.app.results import DOWNLOADS, PAYLOAD
from ergowalk.app.sessions import OPEN, Job, Session
from ergowalk.errors import ErgowalkError, InputError

UNKNOWN = "this page is no longer known to the server; load it again"

FORM = 16384
"""Bytes that a form may have beyond a problem file: every default is in it."""

Handler = Callable[[Desk, Request], Awaitable[Response]]


def application(desk: Desk) -> Starlette:
    """The app as something that a server of the ASGI kind can serve."""
    routes = [
        *(_asset_route(path, *asset) for path, asset in ASSETS.items()),
        Route("/session", _bound(desk, _session), methods=["POST"]),
        Route("/events", _bound(desk, _events)),
        Route("/problem", _bound(desk, _problem), methods=["POST"]),
        Route("/solves", _bound(desk, _solve), methods=["POST"]),
        Route("/solves/{id}", _bound(desk, _remove), methods=["DELETE"]),
        Route("/solves/{id}/cancel", _bound(desk, _cancel), methods=["POST"]),
        Route("/solves/{id}/problem", _bound(desk, _values)),
        Route("/solves/{id}/payload", _bound(desk, _payload)),
        Route("/solves/{id}/{file}", _bound(desk, _download)),
    ]
    return Starlette(routes=routes, middleware=[Middleware(Guard, options=desk.options)])


class NotThere(ErgowalkError):
    """A session, a solve or a file that is not, or no longer, there."""


def _bound(desk: Desk, handler: Handler) -> Callable[[Request], Awaitable[Response]]:
    """The handler with the desk; what goes wrong on purpose becomes a sentence for the page."""

    async def handle(request: Request) -> Response:
        try:
            return await handler(desk, request)
        except NotThere as error:
            return JSONResponse({"error": str(error)}, 404)
        except InputError as error:
            return JSONResponse({"error": str(error), "field": error.field}, 422)
        except WorkerError as error:
            return JSONResponse({"error": str(error)}, 500)
        except Exception as error:
            what = " ".join(f"{type(error).__name__}: {error}".split())
            sentence = f"the server stopped where it should not ({what}); please report it"
            return JSONResponse({"error": sentence}, 500)

    return handle


async def _session(desk: Desk, request: Request) -> Response:
    """The session of a browser, a new one if it has none, and what its form shows."""
    session = desk.sessions.find(request.cookies.get(_cookie(desk.options)))
    answer = {
        **form(),
        "upload_limit": desk.options.upload_limit,
        "too_large": str(too_large(desk.options)),
    }
    if session is not None:
        return JSONResponse(answer)
    session = desk.sessions.create()
    response = JSONResponse(answer)
    response.set_cookie(
        _cookie(desk.options), session.token, httponly=True, samesite="strict", path="/"
    )
    return response


def _cookie(options: Options) -> str:
    """Name of the cookie: a browser does not tell servers on other ports of a machine apart."""
    return f"ergowalk-{options.port}"


def _session_of(desk: Desk, request: Request) -> Session:
    session = desk.sessions.find(request.cookies.get(_cookie(desk.options)))
    if session is None:
        raise NotThere(UNKNOWN)
    return session


def _job_of(desk: Desk, request: Request) -> Job:
    job = _session_of(desk, request).jobs.get(request.path_params["id"])
    if job is None:
        raise NotThere("there is no such solve")
    return job


async def _events(desk: Desk, request: Request) -> Response:
    return EventStream(desk, _session_of(desk, request))


async def _problem(desk: Desk, request: Request) -> Response:
    """The values of an uploaded problem file, for the form."""
    _session_of(desk, request)
    name = unquote(request.headers.get("x-file-name", ""))
    try:
        content = await body_within(request, desk.options)
    except InputError as error:
        raise error.located(short(name, "problem file")) from None
    return JSONResponse({"problem": values_of(uploaded_problem(content, name))})


async def _solve(desk: Desk, request: Request) -> Response:
    session = _session_of(desk, request)
    problem = asked_problem(await body_within(request, desk.options, FORM))
    return JSONResponse({"id": desk.submit(session, problem).id})


async def _cancel(desk: Desk, request: Request) -> Response:
    desk.cancel(_job_of(desk, request))
    return JSONResponse({})


async def _remove(desk: Desk, request: Request) -> Response:
    job = _job_of(desk, request)
    desk.cancel(job)
    job.session.remove(job)
    return JSONResponse({})


async def _values(desk: Desk, request: Request) -> Response:
    return JSONResponse({"problem": values_of(_job_of(desk, request).problem)})


async def _payload(desk: Desk, request: Request) -> Response:
    return _file(_job_of(desk, request), PAYLOAD, "application/json")


async def _download(desk: Desk, request: Request) -> Response:
    job, name = _job_of(desk, request), request.path_params["file"]
    if name and name == job.said.get("film"):
        return await _film(desk, request, job)
    if name not in DOWNLOADS:
        raise NotThere("there is no such file")
    return _file(job, name, DOWNLOADS[name], filename=name)


async def _film(desk: Desk, request: Request, job: Job) -> Response:
    """The film of a gait; its making ends when nobody waits for it any longer."""
    making = asyncio.create_task(desk.film(job))
    gone = asyncio.create_task(_gone(request))
    try:
        await asyncio.wait({making, gone}, return_when=asyncio.FIRST_COMPLETED)
        if gone.done() or desk.closing.is_set():
            return Response(status_code=204)  # nobody reads it
        await making
    finally:
        gone.cancel()
        making.cancel()
        await asyncio.gather(gone, making, return_exceptions=True)
    name = str(job.said["film"])
    return _file(job, name, filename=name)


async def _gone(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass


def _file(
    job: Job, name: str, media_type: str | None = None, filename: str | None = None
) -> Response:
    """A file of a result that is complete; ``name`` is one of ours, never a page's."""
    path = job.folder / name
    if job.state in OPEN or not path.is_file():
        raise NotThere("there is no such file")
    return FileResponse(path, media_type=media_type, filename=filename)


def _package(path: str) -> str:
    return resources.files("ergowalk").joinpath(path).read_text("utf-8")


def _page() -> str:
    return _package("app/static/app.html").replace("{viewer}", _package("viewer/viewer.html"))


HTML, CSS, SCRIPT, SVG = "text/html", "text/css", "text/javascript", "image/svg+xml"

ASSETS: dict[str, tuple[Callable[[], str], str]] = {
    "/": (_page, HTML),
    "/page.css": (lambda: _package("viewer/page.css"), CSS),
    "/viewer.css": (lambda: _package("viewer/viewer.css"), CSS),
    "/viewer.js": (lambda: _package("viewer/viewer.js"), SCRIPT),
    "/app.css": (lambda: _package("app/static/app.css"), CSS),
    "/app.js": (lambda: _package("app/static/app.js"), SCRIPT),
    "/icon.svg": (lambda: _package("app/static/icon.svg"), SVG),
}
"""What the page consists of: text and media type by address."""


def _asset_route(path: str, text: Callable[[], str], media_type: str) -> Route:
    content = text()

    async def asset(request: Request) -> Response:
        return Response(content, media_type=media_type)

    return Route(path, asset)
