"""What a local server must refuse: pages of other sites, names not its own, large bodies."""

from __future__ import annotations

import asyncio
import ipaddress
import socket

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect, Request
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from ergowalk.app.options import KIB, Options
from ergowalk.errors import ProblemError

HEADERS = {
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    # the viewer sets widths and places of its bars and ticks
    "style-src-attr 'unsafe-inline'; img-src 'self'; connect-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    "cache-control": "no-store",
}
"""Sent with every answer: nothing may be fetched from elsewhere, or be embedded there."""

READING = 20.0
"""Longest time that a body may take [s]."""

CHANGING = ("POST", "PUT", "PATCH", "DELETE")


class Guard:
    """Answers only what comes from a page of this server.

    A page of another site can make a browser send requests here, and can point a name of its own
    at this machine (DNS rebinding). The first is told by ``Origin`` and ``Sec-Fetch-Site``, the
    second by ``Host``: a loopback server answers to loopback names alone, another one to
    addresses, which cannot be rebound, and to the names of this machine.
    """

    def __init__(self, app: ASGIApp, options: Options) -> None:
        self._app = app
        self._loopback = options.loopback
        self._names = {"localhost"}
        if not options.loopback:
            self._names |= {n.lower() for n in (options.host, socket.gethostname())}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse a request, or hand it on and add :data:`HEADERS` to its answer."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        async def send_guarded(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        why = self._refusal(scope)
        answer = self._app if why is None else PlainTextResponse(why, 403)
        await answer(scope, receive, send_guarded)

    def _refusal(self, scope: Scope) -> str | None:
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if not self._own(host):
            return "This server does not go by that name; open the address that it printed."
        site = headers.get("sec-fetch-site", "none")
        page = scope["path"] == "/" and scope["method"] == "GET"  # a link may lead there
        if site not in ("none", "same-origin") and not page:
            return "Only the page of this server may ask for that."
        if scope["method"] in CHANGING and headers.get("origin") != f"http://{host}":
            return "Only the page of this server may ask for that."
        return None

    def _own(self, host: str) -> bool:
        """Whether a Host header names this machine."""
        name = host.lower()
        if not name.endswith("]"):
            name, _, port = name.partition("]:") if name.startswith("[") else name.partition(":")
            if port and not port.isdigit():
                return False
        name = name.strip("[]")
        if name in self._names:
            return True
        try:
            address = ipaddress.ip_address(name)
        except ValueError:
            return False
        return address.is_loopback or not self._loopback


async def body_within(request: Request, options: Options, beyond: int = 0) -> bytes:
    """The body of a request, refused before it is read if it says that it is too large.

    Raises
    ------
    ProblemError
        If it is more than ``beyond`` bytes larger than a problem file may be, or takes too long
        to arrive.
    """
    largest = options.upload_limit + beyond
    length = request.headers.get("content-length", "")
    if length.isdigit() and int(length) > largest:
        raise too_large(options)
    content = bytearray()
    try:
        async with asyncio.timeout(READING):
            async for part in request.stream():
                content += part
                if len(content) > largest:
                    raise too_large(options)
    except (TimeoutError, ClientDisconnect):
        raise ProblemError("did not arrive", "send it again") from None
    return bytes(content)


def too_large(options: Options) -> ProblemError:
    """What is said of a problem file that is too large."""
    return ProblemError(
        f"larger than {options.upload_limit // KIB} KiB",
        "give a problem file; 'ergowalk init -o FILE' writes one",
    )
