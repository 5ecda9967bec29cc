"""The command ``ergowalk``: a thin translation of the library."""

from ergowalk.cli.entry import main

__all__ = ["main"]
