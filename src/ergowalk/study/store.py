"""The folder of a sweep: every result whole or not at all, whoever is killed when.

``cases/ab/KEY.nc`` is a gait and ``cases/ab/KEY.json`` its record, written after it: a case is
done when its record is there. ``sweeps/NAME-DIGEST.json`` says which cases a sweep has.
``index.parquet`` is a table of all records and can always be made again from them. Files are
written beside their targets and renamed, so several sweeps may work in one folder.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import secrets
import shutil
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ergowalk.errors import OutputError, SweepError
from ergowalk.study.cases import Case, Record, table_of
from ergowalk.study.definition import Sweep
from ergowalk.study.people import leg_length
from ergowalk.study.plan import is_number, places_of

INDEX = "index.parquet"

EFFORT = ("cpu_s", "wall_s", "peak_memory_mb", "worker", "finished")
"""Columns of the index that the same sweep run again may change."""

STALE_S = 3600.0
"""Age at which a draft that nobody renamed is swept away."""


@dataclass
class Store:
    """The folder of one or more sweeps."""

    folder: Path
    _known: dict[str, tuple[int, Record | None]] = field(default_factory=dict, repr=False)

    def gait(self, key: str) -> Path:
        """Where the gait of a case is."""
        return self.folder / "cases" / key[:2] / f"{key}.nc"

    def record_path(self, key: str) -> Path:
        """Where the record of a case is."""
        return self.gait(key).with_suffix(".json")

    def record(self, key: str) -> Record | None:
        """The record of a case that is done; None if it is not, or its files are damaged."""
        try:
            found: Record = json.loads(self.record_path(key).read_bytes())
        except (OSError, ValueError):
            return None
        whole = isinstance(found, dict) and found.get("key") == key
        if not whole or (found.get("gait") and not self.gait(key).exists()):
            return None
        return found

    def done(self, keys: Iterable[str]) -> dict[str, Record]:
        """The records of those cases that are done."""
        found = {}
        for key in keys:
            try:
                written = self.record_path(key).stat().st_mtime_ns
            except OSError:
                continue
            when, record = self._known.get(key, (0, None))
            if when != written:
                record = self.record(key)
                self._known[key] = written, record
            if record is not None:
                found[key] = record
        return found

    def write_record(self, record: Record) -> None:
        """Write the record of a case, which makes it done.

        Raises
        ------
        OutputError
            If that is not possible.
        """
        path = self.record_path(record["key"])
        write_whole(path, json.dumps(record, indent=1, allow_nan=False).encode())

    def prepare(self, sweep: Sweep, cases: Sequence[Case]) -> str:
        """Make the folder, with the definition of a sweep and the tables that its problems name.

        Returns the name of the definition.

        Raises
        ------
        OutputError
            If the folder cannot be made or written, or holds something else.
        """
        self._refuse_foreign()
        definition = _definition(sweep, cases)
        text = json.dumps(definition, indent=1).encode()
        name = f"{sweep.name}-{hashlib.sha256(text).hexdigest()[:8]}"
        try:
            for folder in ("cases", "sweeps"):
                (self.folder / folder).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise _unwritable(self.folder, error) from None
        self.make_room(case.key for case in cases)
        for case in cases:
            self._copy_table(case)
        write_whole(self.folder / "sweeps" / f"{name}.json", text)
        self._clear_drafts()
        return name

    def make_room(self, keys: Iterable[str]) -> None:
        """Make the folders of results.

        Raises
        ------
        OutputError
            If that is not possible.
        """
        try:
            for start in sorted({key[:2] for key in keys}):
                (self.folder / "cases" / start).mkdir(exist_ok=True)
        except OSError as error:
            raise _unwritable(self.folder, error) from None

    def keep_start(self, path: Path | None) -> Path | None:
        """A copy of the gait with which a sweep begins, where all workers see it.

        Raises
        ------
        OutputError
            If the copy cannot be written.
        """
        if path is None:
            return None
        content = path.read_bytes()
        target = self.folder / "starts" / f"{hashlib.sha256(content).hexdigest()[:16]}.nc"
        try:
            target.parent.mkdir(exist_ok=True)
        except OSError as error:
            raise _unwritable(target, error) from None
        if not target.exists():
            write_whole(target, content)
        return target

    def problem_text(self, case: Case) -> str:
        """The problem of a case as TOML that is understood beside its gait."""
        from ergowalk.problem.files import problem_to_toml

        assert case.problem is not None
        problem = case.problem
        if case.table:
            source = f"../../tables/{case.table[:16]}.csv"
            problem = problem.replace(corridors=problem.corridors.replace(source=source))
        return problem_to_toml(problem)

    def definitions(self) -> dict[str, Path]:
        """Names of the sweeps of this folder and their files, the latest last."""
        found = list((self.folder / "sweeps").glob("*.json"))
        return {path.stem: path for path in sorted(found, key=lambda p: p.stat().st_mtime)}

    def definition(self, name: str | None = None) -> dict[str, Any]:
        """What is swept, by the name of the sweep (with its digest or without); else the latest.

        Raises
        ------
        SweepError
            If there is no such sweep.
        """
        found = self.definitions()
        fitting = [n for n in found if name in (None, n, n.rpartition("-")[0])]
        if not fitting:
            raise SweepError(
                f"holds no sweep {name}" if found and name else "holds no sweep",
                f"choose one of {', '.join(found)}" if found else "run 'ergowalk sweep' first",
                file=str(self.folder),
            )
        try:
            loaded: dict[str, Any] = json.loads(found[fitting[-1]].read_bytes())
            return loaded | {"name": fitting[-1]}
        except (OSError, ValueError):
            raise SweepError(
                "cannot be read", "run 'ergowalk sweep' again", file=str(found[fitting[-1]])
            ) from None

    def write_index(self) -> Path:
        """Bring the table of all records up to date.

        A lock makes the last of several writers one that has seen all records.

        Raises
        ------
        OutputError
            If it cannot be written.
        """
        import pyarrow as pa
        from pyarrow import parquet

        with self._lock():
            every = sorted(p.stem for p in self.folder.glob("cases/*/*.json"))
            rows = _rows(list(self.done(every).values()))
            names = dict.fromkeys(name for row in rows for name in row) or {"key": None}
            table = pa.table({name: [row.get(name) for row in rows] for name in names})
            path = self.folder / INDEX
            with _replacing(path) as draft:
                parquet.write_table(table, draft)
        return path

    @contextlib.contextmanager
    def _lock(self) -> Iterator[None]:
        import fcntl

        try:
            handle = open(self.folder / ".lock", "w")  # noqa: SIM115 - closed below
        except OSError as error:
            raise _unwritable(self.folder, error) from None
        with handle:
            with contextlib.suppress(OSError):  # a file system without locks
                fcntl.flock(handle, fcntl.LOCK_EX)
            yield

    def _refuse_foreign(self) -> None:
        """A folder with files of somebody's own stays as it is."""
        try:
            names = {p.name for p in self.folder.iterdir()}
        except FileNotFoundError:
            return
        except OSError as error:
            raise _unwritable(self.folder, error) from None
        if names - {".lock"} and "sweeps" not in names:
            raise OutputError(
                "is not empty and not the folder of a sweep",
                "choose another folder with -o",
                file=str(self.folder),
            )

    def _copy_table(self, case: Case) -> None:
        if case.problem is None or not case.table:
            return
        target = self.folder / "tables" / f"{case.table[:16]}.csv"
        if not target.exists():
            with _replacing(target) as draft:
                target.parent.mkdir(exist_ok=True)
                shutil.copyfile(table_of(case.problem), draft)

    def _clear_drafts(self) -> None:
        """Remove what killed processes have left half written."""
        before = time.time() - STALE_S
        for path in (*self.folder.glob("cases/*/.*"), *self.folder.glob(".*.part")):
            with contextlib.suppress(OSError):
                if path.stat().st_mtime < before:
                    path.unlink()


def write_whole(path: Path, content: bytes) -> None:
    """Write a file beside its target, to the disk, and rename it.

    Raises
    ------
    OutputError
        If that is not possible; an old file is then still whole.
    """
    with _replacing(path) as draft, open(draft, "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


@contextlib.contextmanager
def _replacing(path: Path) -> Iterator[Path]:
    """A file beside its target, which takes its place once it is written; errors as above."""
    draft = path.with_name(f".{path.name}.{secrets.token_hex(6)}.part")
    try:
        yield draft
        os.replace(draft, path)
    except OSError as error:
        raise _unwritable(path, error) from None
    finally:
        with contextlib.suppress(OSError):
            draft.unlink()


def _definition(sweep: Sweep, cases: Sequence[Case]) -> dict[str, Any]:
    grid = None if sweep.grid is None else {f: list(v) for f, v in sweep.grid.items()}
    return {
        "title": sweep.name,
        "fields": list(sweep.fields),
        "leg_length_m": leg_length(sweep.base.body),
        "grid": grid,
        "probes": sweep.solve.probes,
        "second_looks": sweep.solve.second_looks,
        "cases": [
            {"key": c.key, "values": c.values, "refused": c.refused, "place": place}
            for c, place in zip(cases, places_of(sweep, cases), strict=True)
        ],
    }


def _rows(records: Sequence[Record]) -> list[Record]:
    """Records as rows of a table: a column for each field, as JSON where it is not a number."""
    values: list[dict[str, Any]] = [record.get("values", {}) for record in records]
    words = {f for case in values for f, value in case.items() if not is_number(value)}
    return [
        {name: value for name, value in record.items() if name != "values"}
        | {f: json.dumps(v) if f in words else float(v) for f, v in case.items()}
        for record, case in zip(records, values, strict=True)
    ]


def _unwritable(path: Path, error: OSError) -> OutputError:
    return OutputError(
        f"cannot be written ({error.strerror or error})",
        "make room or choose another folder with -o, then start the same sweep again",
        file=str(path),
    )
