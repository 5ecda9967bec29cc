"""The cases of a sweep: their problems, and names made from the content of those."""

from __future__ import annotations

import hashlib
import itertools
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ergowalk.corridors import BUILT_IN
from ergowalk.errors import InputError, SweepError
from ergowalk.problem import GaitProblem
from ergowalk.study.definition import Sweep

Record = dict[str, Any]
"""What is kept of a search of a case: verdict, numbers, effort."""

KEY_LENGTH = 24
"""Hexadecimal digits of a key: 96 bits."""

DEFAULT_SOLVER = "ergowalk.study.solver:search"
"""What solves a case, as ``module:function``."""


@dataclass(frozen=True)
class Case:
    """One problem of a sweep.

    Attributes
    ----------
    index : int
        Its place in the sweep.
    values : dict
        The swept fields and their values.
    key : str
        Name of its result, from everything that the result depends on.
    problem : GaitProblem or None
        None where the values contradict each other.
    refused : str
        Why there is no problem.
    table : str
        Digest of the table of human data that the problem names; empty if it is built in or lost.
    """

    index: int
    values: dict[str, Any]
    key: str
    problem: GaitProblem | None
    refused: str = ""
    table: str = ""


def cases_of(sweep: Sweep, solver: str = DEFAULT_SOLVER) -> tuple[Case, ...]:
    """All cases of a sweep, in the order of its file; the last field of a grid runs fastest.

    A case whose values make no problem stays, with the reason.

    Raises
    ------
    SweepError
        If two cases are the same problem.
    InputError
        The reason of the first, if no case makes a problem.
    """
    found: dict[str, Case] = {}
    first_error: InputError | None = None
    for index, values in enumerate(_values(sweep)):
        problem, refused = None, ""
        try:
            problem = changed(sweep.base, values)
        except InputError as error:
            first_error, refused = first_error or error, str(error)
        key = _key(sweep, values, problem, solver)
        if key in found:
            raise SweepError(
                f"is the same problem as case {found[key].index + 1}",
                "leave it out",
                field=f"case {index + 1}",
                value=values,
            )
        table = "" if problem is None else digest_of_table(problem)
        found[key] = Case(index, values, key, problem, refused, table)
    if first_error is not None and all(case.problem is None for case in found.values()):
        raise first_error
    return tuple(found.values())


def changed(base: GaitProblem, values: dict[str, Any]) -> GaitProblem:
    """The problem with some fields replaced, named with dots.

    Raises
    ------
    InputError
        If that makes no problem.
    """
    data: dict[str, Any] = base.model_dump()
    for field, value in values.items():
        *tables, last = field.split(".")
        table = data
        for part in tables:
            table = table[part]
        table[last] = value
    return GaitProblem(**data, folder=base.folder)


def _values(sweep: Sweep) -> Iterator[dict[str, Any]]:
    if sweep.grid is not None:
        names = list(sweep.grid)
        for point in itertools.product(*sweep.grid.values()):
            yield dict(zip(names, point, strict=True))
    elif sweep.random is not None:
        yield from _hypercube(sweep)
    else:
        for case in sweep.cases or ():
            yield {f: case.get(f, sweep.value_in_base(f)) for f in sweep.fields}


def _hypercube(sweep: Sweep) -> Iterator[dict[str, float]]:
    """Every field falls once into each of ``count`` equal parts of its interval."""
    from scipy.stats import qmc

    assert sweep.random is not None
    names, ends = list(sweep.random.between), list(sweep.random.between.values())
    sampler = qmc.LatinHypercube(len(names), seed=sweep.random.seed)
    points = qmc.scale(
        sampler.random(sweep.random.count), [low for low, _ in ends], [high for _, high in ends]
    )
    for point in points:
        yield {n: float(f"{x:.12g}") for n, x in zip(names, point, strict=True)}


def _key(sweep: Sweep, values: dict[str, Any], problem: GaitProblem | None, solver: str) -> str:
    """Digest of the problem, of the table of human data that it names, and of how it is searched.

    The problem's own name is not part of it, nor are the limits of time and memory.
    """
    content: dict[str, Any] = {"values": values, "base": _content(sweep.base)}
    if problem is not None:
        content = {"problem": _content(problem)}
    options = sweep.solve
    content["search"] = [options.continuation, options.starts, options.starts > 1 and options.seed]
    if solver != DEFAULT_SOLVER:
        content["solver"] = solver
    text = json.dumps(content, sort_keys=True, default=str)
    return hashlib.sha256(text.encode("utf-8")).hexdigest()[:KEY_LENGTH]


def _content(problem: GaitProblem) -> dict[str, Any]:
    content = problem.model_dump(mode="json")
    del content["name"]
    if not problem.design:
        del content["design"]  # what is solved again must have changed
    content["corridors"]["source"] = digest_of_table(problem) or problem.corridors.source
    return content


def digest_of_table(problem: GaitProblem) -> str:
    """Digest of the table of human data that a problem names; empty if built in or not there."""
    if problem.corridors.source in BUILT_IN:
        return ""
    try:
        return hashlib.sha256(table_of(problem).read_bytes()).hexdigest()
    except OSError:
        return ""  # the case will say that it is missing


def table_of(problem: GaitProblem) -> Path:
    """Where the table of human data of a problem lies."""
    return (problem.folder or Path()) / problem.corridors.source
