"""A worker that solves nothing and starts at once: the name of its problem says how it behaves.

``python stand_in.py [FOLDER]``: what it "finds" is a copy of the files of FOLDER, in which
``said.json`` is what a worker says of them.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from ergowalk.app.worker import Tell, work
from ergowalk.errors import ProblemError

SAID = {
    "label": "a label",
    "acceptable": True,
    "status": "converged",
    "energy": 48.0,
    "viewable": False,
    "why": "it stands in for a gait",
    "rows": [["E", "48.00 J/m"]],
    "film": "film.mp4",
    "files": ["gait.nc", "report.html", "problem.toml"],
}


def solve(order: dict[str, Any], tell: Tell) -> dict[str, Any]:
    name = re.findall(r'^name = "(.*)"', order["problem"], re.M)[0]
    tell({"progress": {"stage": "begun", "pid": os.getpid(), "iteration": 1, "energy": 50.0}})
    BEHAVIOURS.get(name.split(" ")[0], lambda: None)()
    folder = Path(order["folder"])
    if len(sys.argv) > 1:
        shutil.copytree(sys.argv[1], folder, dirs_exist_ok=True)
        said = json.loads((folder / "said.json").read_text("utf-8"))
        label = f"{order['number']}: {said['label'].split(': ', 1)[-1]}"
        payload = json.loads((folder / "payload.json").read_text("utf-8")) | {"label": label}
        (folder / "payload.json").write_text(json.dumps(payload), "utf-8")
        return {**said, "label": label}
    for file in SAID["files"]:
        (folder / file).write_text(f"{file} of {name}", "utf-8")
    return SAID | {"label": f"{order['number']}: {name}"}


def film(order: dict[str, Any], tell: Tell) -> dict[str, Any]:
    folder = Path(order["folder"])
    if folder.joinpath("problem.toml").read_text("utf-8").endswith("of long film"):
        (folder / "film.pid").write_text(str(os.getpid()), "utf-8")
        forever()
    (folder / order["name"]).write_bytes(b"moving pictures")
    return {}


def forever() -> None:
    time.sleep(600)


def with_child() -> None:
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
    print("what a library prints disturbs nobody", flush=True)
    (Path(os.environ["STAND_IN_NOTES"]) / "child").write_text(str(child.pid))
    forever()


def refuse() -> None:
    raise ProblemError("cannot be solved by a stand-in", "ask somebody else", field="name")


def stumble() -> None:
    raise KeyError("a bug\nof two lines")


def run_out_of_memory() -> None:
    raise MemoryError


BEHAVIOURS = {
    "endless": forever,
    "parent": with_child,
    "short": lambda: time.sleep(0.5),
    "killed": lambda: os.kill(os.getpid(), signal.SIGKILL),
    "quits": lambda: os._exit(3),
    "refuses": refuse,
    "stumbles": stumble,
    "hungry": run_out_of_memory,
}

if __name__ == "__main__":
    work({"solve": solve, "film": film})
