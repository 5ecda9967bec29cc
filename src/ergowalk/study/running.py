"""Running a sweep on Dask: cases leave when their neighbours are done, results stay on disk."""

from __future__ import annotations

import contextlib
import heapq
import math
import queue
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ergowalk.errors import InputError, SweepError
from ergowalk.study.cases import DEFAULT_SOLVER, Case, Record, cases_of
from ergowalk.study.cluster import cluster_client, dashboard, greeted, needed, slots
from ergowalk.study.definition import SearchOptions, Sweep
from ergowalk.study.looks import Looks
from ergowalk.study.plan import Step, planned
from ergowalk.study.store import Store
from ergowalk.study.tally import Tally
from ergowalk.study.worker import run_case

if TYPE_CHECKING:
    import xarray as xr

FINISHED = ("accepted", "rejected", "refused")
"""Status of a case whose search has ended by itself."""

FAILED = ("error", "out of time", "out of memory", "crashed")
"""Status of a case that may be tried again."""

TICK_S = 0.5
"""How often a sweep looks up from waiting."""

INDEX_EVERY_S = 20.0
"""How often the index on disk is brought up to date while cases run."""


Watch = Callable[[Tally], None]


def sweep(
    definition: Sweep,
    folder: str | Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    retry: bool = False,
    solver: str = DEFAULT_SOLVER,
    progress: Watch | None = None,
) -> xr.Dataset:
    """Solve all cases of a sweep that the folder does not have yet, and collect them.

    Each case begins at the gait of its neighbour in a tree that is fixed before the work, so the
    result does not depend on the workers. Second looks follow where the sweep asks for them: see
    :mod:`ergowalk.study.looks`. A case that fails, takes too long, takes too much memory
    or crashes is recorded with its reason; the cases that should have begun at it begin at the
    last accepted gait on the way to it.

    Parameters
    ----------
    definition : Sweep
    folder : str or Path
        Where results go and stay. The workers of a cluster must see it under the same name.
    workers : int, optional
        Processes of a cluster on this machine (default: one for each processor).
    scheduler : str, optional
        Address of the scheduler of a cluster that exists, instead.
    retry : bool
        Whether cases that failed before are tried again.
    solver : str
        What solves a case, as ``module:function``; see
        :func:`ergowalk.study.searching.searched`.
    progress : callable, optional
        Called with a :class:`Tally` whenever a case ends, and twice a second.

    Returns
    -------
    xarray.Dataset
        See :func:`ergowalk.study.collect`.

    Raises
    ------
    InputError
        If the sweep cannot be used, the folder not written, or the cluster not reached or lost.
        What was done until then is kept: start the same sweep again.
    """
    from ergowalk.study.results import collect

    needed()
    _check(definition, workers, scheduler)
    cases = cases_of(definition, solver)
    store = Store(Path(folder).absolute())
    name = store.prepare(definition, cases)
    for case in cases:
        if case.problem is None and store.record(case.key) is None:
            store.write_record(_refused(case))
    again = FAILED if retry else ()
    first = store.keep_start(definition.start)
    options = definition.solve
    try:
        with contextlib.ExitStack() as stack:
            client = None
            for words, steps in _parts(definition, cases, store, name):
                run = _Run(store, steps, words, options, first, again, solver, progress)
                if run.missing and client is None:
                    looks = options.probes or options.second_looks
                    most = len(steps) if looks else len(run.missing)
                    client = stack.enter_context(cluster_client(workers, scheduler, most))
                    greeted(client, store.folder, f"sweeps/{name}.json")
                if run.missing:
                    run.on(client)
    finally:
        store.write_index()
    return collect(folder, name)


def _parts(
    definition: Sweep, cases: Sequence[Case], store: Store, name: str
) -> Iterator[tuple[str, tuple[Step, ...]]]:
    """The cases, then round by round the second looks at them, with what to call them."""
    yield "cases", planned(definition, cases)
    known = {case.key: case for case in cases}
    for number, looks in enumerate(Looks(store.definition(name), store.done).each_round()):
        words = f"looks of round {number}" if number else "probes"
        yield words, tuple(Step(known[look.case], None, look) for look in looks)


def _check(definition: Sweep, workers: int | None, scheduler: str | None) -> None:
    """Refuse what cannot be used, before there is a folder."""
    if workers is not None and scheduler is not None:
        raise SweepError("have their own workers", "leave out one", field="workers and scheduler")
    if workers is not None and workers < 1:
        raise SweepError("must be 1 or more", "give a whole number", field="workers", value=workers)
    if definition.start is not None:
        from ergowalk.solution import Solution

        Solution.load(definition.start)


class _Run:
    """The cases of a sweep, or a round of second looks: what is missing, under way and done."""

    def __init__(
        self,
        store: Store,
        steps: tuple[Step, ...],
        words: str,
        options: SearchOptions,
        start: Path | None,
        retried: tuple[str, ...],
        solver: str,
        progress: Watch | None,
    ) -> None:
        self.store, self.options, self.start, self.retried = store, options, start, retried
        self.solver, self.progress, self.words = solver, progress, words
        self.steps = {step.key: step for step in steps}
        self.keys = list(self.steps)
        self.place = {key: i for i, key in enumerate(self.keys)}
        known = store.done(self.steps)
        self.done = {k: r["status"] for k, r in known.items() if r["status"] not in retried}
        self.missing = [key for key in self.steps if key not in self.done]
        self.ready: list[int] = []
        """Heap of places of cases that may leave."""
        self.followers: dict[str, list[str]] = {}
        """Cases that wait for another."""
        self.flying: dict[Any, str] = {}
        self.landed: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self.fresh, self.last = 0, ""
        self.threads, self.counted = 0, -math.inf
        self.began = self.indexed = time.monotonic()
        for key in self.missing:
            neighbour = self.steps[key].neighbour
            if neighbour is None or neighbour.key in self.done:
                heapq.heappush(self.ready, self.place[key])
            else:
                self.followers.setdefault(neighbour.key, []).append(key)

    def on(self, client: Any) -> None:
        """Let the missing cases run on a cluster."""
        self.store.make_room(self.missing)  # second looks have names of their own
        self.began = self.indexed = time.monotonic()
        try:
            while self.ready or self.flying:
                self._launch(client)
                self._tell(client)
                self._land(client)
                if time.monotonic() - self.indexed > INDEX_EVERY_S:
                    self.store.write_index()
                    self.indexed = time.monotonic()
        finally:
            with contextlib.suppress(Exception):  # of a cluster that was lost
                client.cancel(list(self.flying))
        self._tell(client)

    def _launch(self, client: Any) -> None:
        """Send cases whose neighbours are done, two for each thread: none of them should wait."""
        if time.monotonic() - self.counted > TICK_S:
            self.counted, self.threads = time.monotonic(), slots(client)
        while self.ready and len(self.flying) < 2 * max(self.threads, 1):
            key = self.keys[heapq.heappop(self.ready)]
            future = client.submit(run_case, self._ticket(key), pure=False, key=_task_name(key))
            self.flying[future] = key
            future.add_done_callback(self.landed.put)

    def _land(self, client: Any) -> None:
        """Take what has ended, or wait a moment."""
        try:
            future = self.landed.get(timeout=TICK_S)
        except queue.Empty:
            if client.status not in ("running", "connecting"):
                raise _lost(client) from None
            return
        key = self.flying.pop(future)
        self.done[key] = self._record(client, future, key)["status"]
        self.fresh, self.last = self.fresh + 1, f"{key}: {self.done[key]}"
        for follower in self.followers.pop(key, ()):
            heapq.heappush(self.ready, self.place[follower])

    def _record(self, client: Any, future: Any, key: str) -> Record:
        from distributed import KilledWorker

        if future.status in ("cancelled", "lost"):
            raise _lost(client)
        try:
            record: Record = future.result()
            return record
        except KilledWorker as error:
            record = self._killed(key, str(error))
            self.store.write_record(record)
            return record
        except InputError:
            raise
        except Exception as error:
            words = " ".join(str(error).split())[:200]
            raise SweepError(
                f"cannot run a case ({type(error).__name__}: {words})",
                "install the same ergowalk and its libraries on all workers",
                field="workers",
            ) from None

    def _killed(self, key: str, words: str) -> Record:
        case = self.steps[key].case
        return {
            "key": key,
            "status": "crashed",
            "case": case.key,
            "values": case.values,
            "begun_at": self._begin_at(key) or "",
            "gait": "",
            "reason": f"the workers that ran it were lost one after the other: {words}"[:300],
        }

    def _ticket(self, key: str) -> dict[str, Any]:
        case, look, options = self.steps[key].case, self.steps[key].look, self.options
        before = self._begin_at(key)
        start = self.store.gait(before) if before else None if look else self.start
        return {
            "folder": str(self.store.folder),
            "key": key,
            "case": case.key,
            "values": case.values,
            "begun_at": before or "",
            "solver": self.solver,
            "retry": list(self.retried),
            "task": {
                "problem": self.store.problem_text(case),
                "gait": str(self.store.gait(key)),
                "start": None if start is None else str(start),
                "starts": 0 if look else options.starts,
                "seed": options.seed,
                "time_limit_s": options.time_limit_s,
                "memory_limit_mb": options.memory_limit_mb,
            },
        }

    def _begin_at(self, key: str) -> str | None:
        """The nearest case with an accepted gait on the way from a case to the first one."""
        step: Step | None = self.steps[key]
        if step is not None and step.look is not None:
            return step.look.start or None
        while step is not None and step.neighbour is not None:
            step = self.steps[step.neighbour.key]
            if self.done[step.case.key] == "accepted":
                return step.case.key
        return None

    def _tell(self, client: Any) -> None:
        if self.progress is None:
            return
        status = Counter(self.done.values())
        self.progress(
            Tally(
                total=len(self.steps),
                done=len(self.done),
                accepted=status["accepted"],
                failed=sum(n for s, n in status.items() if s not in FINISHED),
                running=min(len(self.flying), self.threads),
                fresh=self.fresh,
                elapsed=time.monotonic() - self.began,
                workers=self.threads,
                dashboard=dashboard(client),
                last=self.last,
                words=self.words,
            )
        )


def _refused(case: Case) -> Record:
    return {
        "key": case.key,
        "status": "refused",
        "case": case.key,
        "values": case.values,
        "begun_at": "",
        "gait": "",
        "reason": case.refused,
    }


def _lost(client: Any) -> SweepError:
    return SweepError(
        "was lost",
        "what was done is kept: start the same sweep again",
        field="cluster",
        value=str(client.scheduler.address) if client.scheduler else None,
    )


def _task_name(key: str) -> str:
    return f"case-{key}-{time.monotonic_ns()}"
