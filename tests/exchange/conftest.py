"""Texts of an export of the solved gait."""

from __future__ import annotations

from functools import cache

import pytest
import xarray as xr

from ergowalk.io import FORMATS


class Export:
    """What each format makes of the solved gait, written once."""

    def __init__(self, gait: xr.Dataset) -> None:
        self.gait = gait
        self.text = cache(self._text)

    def _text(self, name: str, rate: float = 200.0, strides: int = 1) -> str:
        return FORMATS[name].text(self.gait, rate, strides)


@pytest.fixture(scope="package")
def export(paper_gait: xr.Dataset) -> Export:
    return Export(paper_gait)
