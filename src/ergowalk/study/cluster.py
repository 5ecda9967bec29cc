"""A Dask cluster: one of this machine's own for the while, or any that exists."""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

from ergowalk import __version__
from ergowalk.errors import OutputError, SweepError
from ergowalk.study.event_loop import event_loop
from ergowalk.study.worker import THREADS, greet

CONNECT_S = 20.0
"""How long a scheduler may take to answer."""


@contextmanager
def cluster_client(workers: int | None, scheduler: str | None, most: int) -> Iterator[Any]:
    """A client of the cluster at an address; without one, of a cluster of worker processes here.

    The latter has ``workers`` processes (by default one for each processor), and never more than
    ``most``, of one thread each.

    Raises
    ------
    SweepError
        If Dask is not installed, there is no scheduler, or no cluster can be started.
    """
    distributed = needed()
    with event_loop() as loop:
        if scheduler is not None:
            with _connected(distributed, scheduler, loop) as client:
                yield client
        else:
            with _started(distributed, min(most, workers or _processors()), loop) as client:
                yield client


@contextmanager
def _started(distributed: Any, count: int, loop: Any) -> Iterator[Any]:
    import dask

    quiet = {
        "distributed.scheduler.allowed-failures": 3,
        # each case has a process and a memory limit of its own
        "distributed.worker.memory.terminate": False,
        "distributed.worker.multiprocessing-method": "spawn",
    }
    with dask.config.set(quiet), ExitStack() as stack:
        try:
            cluster = distributed.LocalCluster(
                n_workers=count,
                threads_per_worker=1,
                memory_limit=0,
                dashboard_address="127.0.0.1:0",
                silence_logs=logging.CRITICAL,
                env=dict.fromkeys(THREADS, "1"),
                loop=loop,
            )
            stack.enter_context(cluster)
            client = stack.enter_context(distributed.Client(cluster, loop=loop))
        except Exception as error:
            raise SweepError(
                f"cannot be started ({_words(error)})",
                "try again with fewer, or when the machine has less to do",
                field="workers",
                value=count,
            ) from None
        yield client


@contextmanager
def _connected(distributed: Any, scheduler: str, loop: Any) -> Iterator[Any]:
    logger = logging.getLogger("distributed")
    level = logger.level
    logger.setLevel(logging.CRITICAL)  # what goes wrong is told in one line
    # held before it is made: one that found no scheduler must be closed too, or does it at exit
    client = distributed.Client.__new__(distributed.Client)
    try:
        client.__init__(scheduler, timeout=CONNECT_S, set_as_default=False, loop=loop)
    except (OSError, ValueError, TypeError, ImportError) as error:
        raise SweepError(
            f"there is no scheduler ({_words(error)})",
            "give the address that 'dask scheduler' prints, as tcp://host:8786",
            field="scheduler",
            value=scheduler,
        ) from None
    else:
        yield client
    finally:
        with suppress(Exception):  # a cluster that was lost cannot be left
            client.close(timeout=2)
        logger.setLevel(level)


def greeted(client: Any, folder: Path, mark: str) -> None:
    """Check that the workers have this ergowalk and see the folder.

    Raises
    ------
    SweepError, OutputError
        Naming the first worker that does not.
    """
    try:
        answers = client.run(greet, str(folder), mark)
    except Exception as error:
        words = " ".join(str(error).split())[:200]
        raise SweepError(
            f"cannot run ergowalk ({type(error).__name__}: {words})",
            "install ergowalk[sweep] on all workers",
            field="workers",
        ) from None
    for worker, answer in answers.items():
        if answer["version"] != __version__:
            raise SweepError(
                f"has ergowalk {answer['version']}",
                f"install {__version__}, as here",
                field="worker",
                value=worker,
            )
        if not answer["sees"]:
            raise OutputError(
                f"is not seen by worker {worker}",
                "give a folder that all workers of the cluster share",
                file=str(folder),
            )


def slots(client: Any) -> int:
    """Threads of the cluster: cases that can run at once; 0 of a cluster that is lost."""
    with suppress(Exception):
        return sum(client.nthreads().values())
    return 0


def dashboard(client: Any) -> str:
    """Address of the cluster's dashboard; empty if it has none."""
    with suppress(Exception):  # of a cluster that is being lost
        return str(client.dashboard_link or "")
    return ""


def needed() -> Any:
    """Dask's distributed scheduler, with all that a sweep needs beside it.

    Raises
    ------
    SweepError
        If that is not installed.
    """
    try:
        import distributed
        import pyarrow  # noqa: F401 - for the index
    except ImportError as error:
        raise SweepError(
            f"a sweep needs {error.name}", "pip install 'ergowalk[sweep]'", field="sweep"
        ) from None
    return distributed


def _words(error: Exception) -> str:
    return " ".join(str(error).split())[:200] or type(error).__name__


def _processors() -> int:
    with suppress(AttributeError):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
