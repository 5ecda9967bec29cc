"""A neighbour from the human means and from a gait: ``python benchmarks/warm_start.py``.

Solves ``berbyuk2002`` once, then the same walk with a step 1 % longer, from nothing and from that
gait with the check of its mesh taken over and solved anew, and prints iterations, CPU seconds
(set-up, check and audit included) and their ratio.
"""

from __future__ import annotations

import os
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")

import ergowalk


def main() -> None:
    """Solve three times, print the table."""
    start = ergowalk.solve(ergowalk.preset("berbyuk2002"))
    longer = start.problem.replace(step_length_m=1.01 * start.problem.step_length_m)
    taken = []
    for name, gait, recheck in (
        ("from the human means", None, False),
        ("from the gait beside it, checked anew", start, True),
        ("from the gait beside it", start, False),
    ):
        began = time.process_time()
        found = ergowalk.solve(longer, start=gait, recheck=recheck)
        taken.append(time.process_time() - began)
        first = found.mesh_history[0]
        print(
            f"{name:38s} E = {found.energy_per_metre:.2f} J/m, "
            f"{found.dataset.attrs['iterations']} iterations ({first['iterations']} on the first "
            f"of its last meshes), {taken[-1]:.1f} CPU s, acceptable: {found.acceptable}"
        )
    ratios = " and ".join(f"{taken[0] / t:.1f}" for t in taken[1:])
    print(f"ratios of CPU time: {ratios}")


if __name__ == "__main__":
    main()
