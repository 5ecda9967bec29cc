"""How the app is started: defaults of the command, ranges, the address, the warning."""

from __future__ import annotations

import socket
from argparse import Namespace

import pytest

from ergowalk.app import serving
from ergowalk.app.options import Options
from ergowalk.cli import app as command
from ergowalk.cli import main
from ergowalk.cli.parser import build_parser
from ergowalk.errors import InputError


def options_of(*arguments: str, monkeypatch: pytest.MonkeyPatch) -> Options:
    """What the command serves with."""
    asked: list[Options] = []
    monkeypatch.setattr(command, "serve", lambda options, announce: asked.append(options))
    chosen: Namespace = build_parser().parse_args(["app", *arguments])
    command.run_app(chosen)
    return asked[0]


def test_defaults_of_the_command_are_those_of_the_options(monkeypatch: pytest.MonkeyPatch) -> None:
    assert options_of(monkeypatch=monkeypatch) == Options()
    assert Options().loopback
    assert Options().host == "127.0.0.1"


def test_the_command_passes_every_option_on(monkeypatch: pytest.MonkeyPatch) -> None:
    line = "--host ::1 --port 0 --workers 3 --queue 2 --time-limit 5 --upload-limit 9 --grace 1"
    assert options_of(*line.split(), monkeypatch=monkeypatch) == Options(
        host="::1",
        port=0,
        workers=3,
        queue=2,
        time_limit_s=5.0,
        upload_limit_kib=9,
        grace_s=1.0,
    )


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"port": 70_000}, "^port = 70000: should be less than or equal to 65535; give a port"),
        ({"workers": 0}, "^workers = 0: should be greater than 0; give how many solves"),
        ({"queue": -1}, "^queue = -1: should be greater than 0"),
        ({"time_limit_s": float("nan")}, "^time_limit_s = nan: should be"),
        ({"grace_s": 0.0}, r"^grace_s = 0\.0: should be greater than 0"),
        ({"host": ""}, "^host = '': "),
    ],
)
def test_options_out_of_range_are_one_sentence(change: dict[str, object], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        Options(**change)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.2", "laptop.local"])
def test_a_server_that_others_reach_is_started_with_a_warning(
    host: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    options_of("--host", host, monkeypatch=monkeypatch)
    told = capsys.readouterr()
    assert told.out == ""
    assert f"--host {host}: everyone who reaches this machine can start solves" in told.err


@pytest.mark.parametrize("host", ["127.0.0.1", "127.8.8.8", "::1", "localhost"])
def test_a_server_of_this_machine_alone_is_not_warned_of(host: str) -> None:
    assert Options(host=host).warning() is None


@pytest.mark.parametrize(
    ("host", "address"),
    [
        ("127.0.0.1", "http://127.0.0.1:7/"),
        ("::1", "http://[::1]:7/"),
        ("0.0.0.0", "http://127.0.0.1:7/"),
        ("::", "http://[::1]:7/"),
    ],
)
def test_the_address_is_one_that_a_browser_can_open(host: str, address: str) -> None:
    assert serving.address(Options(host=host), 7) == address


def test_a_port_in_use_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert main(["app", "--port", str(port)]) == 2
    told = capsys.readouterr()
    assert (told.out, told.err.count("\n")) == ("", 1)
    assert f"port = {port}: cannot be used (Address already in use); choose another" in told.err


def test_a_host_that_is_not_here_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["app", "--host", "203.0.113.7", "--port", "0"]) == 2
    assert "cannot be used" in capsys.readouterr().err.splitlines()[-1]


def test_missing_packages_are_one_line_that_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(serving, "find_spec", lambda name: None)
    assert main(["app"]) == 2
    assert capsys.readouterr().err == (
        "ergowalk: the app needs starlette and uvicorn, which are not installed; run pip install "
        "'ergowalk[app]'\n"
    )
