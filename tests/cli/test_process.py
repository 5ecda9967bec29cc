"""The command as a process: streams that close, help, imports, the same bytes again, no IPOPT."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from types import SimpleNamespace

import pytest
import xarray as xr

import ergowalk
from ergowalk.cli.entry import COMMANDS, runner
from ergowalk.cli.parser import build_parser
from ergowalk.cli.streams import ProgressLine, emit

COMMAND = [sys.executable, "-m", "ergowalk"]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(Path(ergowalk.__file__).parents[1])}


def process(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
    options = {"capture_output": True, "text": True, "env": ENVIRONMENT, **options}
    return subprocess.run([*COMMAND, *arguments], check=False, timeout=60, **options)


def test_a_mistake_is_one_line_and_no_traceback(tmp_path):
    answer = process("solve", "none.toml", cwd=tmp_path)
    assert (answer.returncode, answer.stdout) == (2, "")
    assert answer.stderr.startswith("ergowalk: none.toml: cannot be read (No such file")
    assert answer.stderr.count("\n") == 1


@pytest.mark.parametrize("command", ["--help", "presets", "init"])
def test_light_commands_import_nothing_heavy(command):
    script = (
        "import sys; from ergowalk.cli import main; status = main(sys.argv[1:]);"
        "heavy = {'casadi', 'xarray', 'matplotlib', 'netCDF4', 'pandas'} & set(sys.modules);"
        "sys.exit(f'{status} {heavy}' if status or heavy else 0)"
    )
    answer = subprocess.run(
        [sys.executable, "-c", script, command],
        check=False, capture_output=True, text=True, env=ENVIRONMENT, timeout=60,
    )  # fmt: skip
    assert (answer.returncode, answer.stderr) == (0, "")


def test_every_command_has_what_runs_it():
    (choice,) = [a for a in build_parser()._actions if a.dest == "command"]
    assert list(choice.choices) == list(COMMANDS)
    assert all(callable(runner(command)) for command in COMMANDS)


def test_a_closed_pipe_is_no_error():
    reader, writer = os.pipe()
    os.close(reader)
    try:
        answer = process("init", capture_output=False, stdout=writer, stderr=subprocess.PIPE)
    finally:
        os.close(writer)
    assert (answer.returncode, answer.stderr) == (0, "")


CUT_SHORT = """
import sys
from functools import partial
from ergowalk.cli import main
from ergowalk.solving import stages
stages.Ipopt = partial(stages.Ipopt, max_iterations=30)
sys.exit(main(sys.argv[1:]))
"""
"""The command, with a solver that stops in the middle of its first stage with dynamics."""


def raw(variable: xr.DataArray) -> tuple[tuple[int, ...], bytes]:
    """Shape and bytes of a variable; labels by their text."""
    values = variable.to_numpy()
    text = values.dtype == object
    return values.shape, repr(values.tolist()).encode() if text else values.tobytes()


def test_the_same_problem_solved_twice_gives_the_same_bytes(tmp_path):
    """In processes of their own, whose sets have their members in different orders."""
    gaits = []
    for seed in ("1", "2"):
        arguments = ("solve", "--preset", "berbyuk2002-rhythm", "--no-figures", "--quiet")
        answer = subprocess.run(
            [sys.executable, "-c", CUT_SHORT, *arguments, "-o", seed],
            check=False, capture_output=True, text=True, timeout=120, cwd=tmp_path,
            env={**ENVIRONMENT, "PYTHONHASHSEED": seed},
        )  # fmt: skip
        assert (answer.returncode, answer.stderr) == (1, "")
        with xr.open_dataset(tmp_path / seed / "gait.nc", decode_cf=False) as stored:
            gaits.append(stored.load())
    one, two = gaits
    assert "ran out of iterations" in one.attrs["solver_status"]
    assert list(one.variables) == list(two.variables)
    for name in one.variables:
        assert raw(one[name]) == raw(two[name]), name
    clocks = ("build_time", "solve_time", "mesh_times")
    assert set(clocks) <= set(one.attrs)
    first, second = ({k: v for k, v in d.attrs.items() if k not in clocks} for d in gaits)
    assert first == second
    assert (tmp_path / "1/problem.toml").read_bytes() == (tmp_path / "2/problem.toml").read_bytes()


@pytest.fixture
def casadi_without_ipopt(tmp_path):
    """A folder with CasADi, all but its interface to IPOPT."""
    package = Path(find_spec("casadi").origin).parent
    folder = tmp_path / "site"
    (folder / "casadi").mkdir(parents=True)
    for path in package.iterdir():
        if "nlpsol_ipopt" not in path.name:
            (folder / "casadi" / path.name).symlink_to(path)
    return folder


@pytest.mark.skipif(sys.platform != "linux", reason="takes a package apart with symbolic links")
def test_without_ipopt_there_is_one_line_and_no_gait(casadi_without_ipopt, tmp_path):
    environment = {**ENVIRONMENT}
    environment["PYTHONPATH"] = os.pathsep.join(
        (str(casadi_without_ipopt), ENVIRONMENT["PYTHONPATH"])
    )
    arguments = ("--preset", "berbyuk2002-rhythm", "--no-figures", "--quiet", "-o", "out")
    answer = process("solve", *arguments, cwd=tmp_path, env=environment)
    assert (answer.returncode, answer.stdout) == (2, "")
    assert answer.stderr.startswith("ergowalk: solver = 'ipopt': ")
    assert "; " in answer.stderr  # rule and remedy
    assert answer.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is always full")
def test_a_full_disk_is_one_line():
    with open("/dev/full", "w") as full:
        answer = process("init", capture_output=False, stdout=full, stderr=subprocess.PIPE)
    assert answer.returncode == 2
    assert answer.stderr == (
        "ergowalk: standard output: cannot be written (No space left on device); "
        "send it elsewhere\n"
    )


def test_an_encoding_without_a_letter_gets_its_escape(monkeypatch):
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding="ascii"))
    emit("Gänge")
    assert raw.getvalue().decode("ascii") == "G\\xe4nge\n"


class Terminal:
    """Keeps what a terminal is sent."""

    encoding = "utf-8"

    def __init__(self) -> None:
        self.sent = ""

    def write(self, text: str) -> None:
        self.sent += text

    def flush(self) -> None:
        pass

    def isatty(self) -> bool:
        return True


def test_on_a_terminal_one_line_is_refreshed_and_the_last_state_stays(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr("ergowalk.cli.streams.REFRESH", 0.0)
    monkeypatch.setenv("COLUMNS", "80")
    with ProgressLine() as progress:
        for stage, energy in (("fit", None), ("fit", float("nan")), ("polish", 71.79)):
            progress(
                SimpleNamespace(
                    stage=stage, iteration=7, energy_per_metre=energy, violation=1e-3, elapsed=2.0
                )
            )
    assert terminal.sent.count("\n") == 2
    assert terminal.sent.endswith("\n")
    assert terminal.sent.startswith("\rfit: it 7, violation 1e-03, 2 s")
    assert "\rpolish: it 7, 71.79 J/m, violation 1e-03, 2 s" in terminal.sent


def test_a_long_stage_gives_way_to_its_figures(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("COLUMNS", "50")
    with ProgressLine() as progress:
        progress(
            SimpleNamespace(
                stage="s" * 50, iteration=123, energy_per_metre=71.79, violation=1e-3, elapsed=9.6
            )
        )
    line = terminal.sent.rstrip("\n").split("\r")[-1]
    assert line == "ssss...: it 123, 71.79 J/m, violation 1e-03, 10 s"
    assert len(line) == 49
