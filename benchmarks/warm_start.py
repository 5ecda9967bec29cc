"""A neighbour from the human means and from a gait: ``python benchmarks/warm_start.py``.

Solves ``berbyuk2002`` once, then the same walk with a step 1 % longer, from nothing and from that
gait, and prints iterations, CPU seconds (set-up, check and audit included) and their ratio.
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
    for name, gait in (("from the human means", None), ("from the gait beside it", start)):
        began = time.process_time()
        found = ergowalk.solve(longer, start=gait)
        taken.append(time.process_time() - began)
        first = found.mesh_history[0]
        print(
            f"{name:25s} E = {found.energy_per_metre:.2f} J/m, "
            f"{found.dataset.attrs['iterations']} iterations ({first['iterations']} on the first "
            f"of its last meshes), {taken[-1]:.1f} CPU s, acceptable: {found.acceptable}"
        )
    print(f"ratio of CPU time: {taken[0] / taken[1]:.1f}")


if __name__ == "__main__":
    main()
