"""What the server of the app is told when it starts."""

from __future__ import annotations

import ipaddress
import os
from typing import Annotated

from pydantic import Field

from ergowalk.errors import InputError
from ergowalk.values import PositiveFloat, Value

Count = Annotated[int, Field(gt=0, strict=True)]

KIB = 1024


def _processors() -> int:
    return os.cpu_count() or 1


class Options(Value):
    """How the app is served, and the limits of what it does for a page.

    Raises
    ------
    InputError
        For a value out of range.
    """

    _error = InputError

    host: str = Field(
        default="127.0.0.1", min_length=1, description="a name or address of this machine"
    )
    port: int = Field(
        default=8765, ge=0, le=65535, strict=True, description="a port, 0 for any free one"
    )
    workers: Count = Field(
        default_factory=_processors, description="how many solves may run at once"
    )
    queue: Count = Field(default=8, description="how many more may wait")
    time_limit_s: PositiveFloat = Field(
        default=600.0, description="seconds after which a solve is ended"
    )
    upload_limit_kib: Count = Field(
        default=256, description="the size of the largest problem file, in KiB"
    )
    grace_s: PositiveFloat = Field(
        default=15.0, description="seconds that a solve goes on without a page that watches it"
    )

    @property
    def upload_limit(self) -> int:
        """Largest problem file in bytes."""
        return self.upload_limit_kib * KIB

    @property
    def loopback(self) -> bool:
        """Whether nobody but this machine reaches the server."""
        try:
            return ipaddress.ip_address(self.host).is_loopback
        except ValueError:
            return self.host == "localhost"

    def warning(self) -> str | None:
        """What to know before others can reach the server; None if they cannot."""
        if self.loopback:
            return None
        return (
            f"--host {self.host}: everyone who reaches this machine can start solves here, with "
            "neither password nor encryption; use it in a network that you trust"
        )
