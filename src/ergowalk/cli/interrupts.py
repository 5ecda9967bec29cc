"""Ctrl-C that is not lost inside compiled code."""

from __future__ import annotations

import signal
import threading
from typing import Self


class Interrupts:
    """While entered, Ctrl-C is remembered until :meth:`check`; a second one raises at once.

    KeyboardInterrupt that surfaces inside a compiled library vanishes there, or ends it with a
    status of its own. Outside the main thread, and where a program handles the signal itself,
    nothing is changed.
    """

    def __init__(self) -> None:
        self._noted = self._ours = False

    def check(self) -> None:
        """Raise KeyboardInterrupt if Ctrl-C was pressed."""
        if self._noted:
            raise KeyboardInterrupt

    def __enter__(self) -> Self:
        self._ours = (
            threading.current_thread() is threading.main_thread()
            and signal.getsignal(signal.SIGINT) is signal.default_int_handler
        )
        if self._ours:
            signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, *_: object) -> None:
        if self._ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)

    def _note(self, number: int, frame: object) -> None:
        self.check()
        self._noted = True
