"""``python -m ergowalk``: the same as the command ``ergowalk``."""

from __future__ import annotations

import sys

from ergowalk.cli import main

if __name__ == "__main__":
    sys.exit(main())
