"""Make the environments of the peers, each with nothing but what that peer needs.

``python environments.py FOLDER [--only opty moco ours]``. The environment in which ``run.py`` runs
serves for ergowalk and for plain CasADi if ``ours`` is not made. opty's solver is compiled here: it
needs a C compiler, pkg-config, and the headers of IPOPT, BLAS and LAPACK (Debian:
``coinor-libipopt-dev pkg-config gcc libblas-dev liblapack-dev``).
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = {
    "opty": ("opty", "cyipopt"),
    "moco": ("opensim",),
    "ours": (str(ROOT),),
}
"""What ``pip install`` is asked for in each environment."""


def interpreter(folder: Path, name: str) -> Path:
    """The Python of an environment."""
    return folder / name / "bin" / "python"


def make(folder: Path, name: str) -> bool:
    """Make one environment unless it is there; whether that worked."""
    python = interpreter(folder, name)
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", str(folder / name)], check=True)
    command = [str(python), "-m", "pip", "install", "--quiet", *PACKAGES[name]]
    return subprocess.run(command, check=False).returncode == 0


def main() -> None:
    """Make those asked for; one that fails does not stop the others."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--only", nargs="+", choices=tuple(PACKAGES), default=("opty", "moco"))
    chosen = arguments.parse_args()
    chosen.folder.mkdir(parents=True, exist_ok=True)
    for name in chosen.only:
        done = make(chosen.folder, name)
        print(f"{name}: {'ready' if done else 'could not be installed, see above'}")


if __name__ == "__main__":
    main()
