"""Problem A with the printed rhythm by ``ergowalk.solve``, by either method."""

from __future__ import annotations

import argparse
import json
import time

import ergowalk


def main() -> None:
    """Solve and print one line of JSON."""
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--method", choices=("collocation", "spline"), default="collocation")
    chosen = arguments.parse_args()
    began = time.process_time()
    gait = ergowalk.solve(ergowalk.preset("berbyuk2002-rhythm"), method=chosen.method)
    solved = time.process_time()
    report = gait.audit()
    answer = {
        "solve_cpu_s": solved - began,
        "energy_j_per_m": gait.energy_per_metre,
        "acceptable": gait.acceptable,
        "accepted": report.accepted,
        "status": gait.status,
        "versions": f"ergowalk {ergowalk.__version__}",
    }
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
