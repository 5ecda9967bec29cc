"""Gaits that the audit must accept: one led by hand, one that the package solved."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest
import xarray as xr

from ergowalk.audit import AuditReport, audit

from .synthetic import synthetic_gait


@dataclass(frozen=True)
class Gait:
    """A gait and the folder of its corridor table."""

    dataset: xr.Dataset
    folder: Path

    def audited(self) -> AuditReport:
        """What the audit says of it."""
        return audit(self.dataset, self.folder)

    def copy(self) -> Gait:
        """A gait to tamper with."""
        return Gait(self.dataset.copy(deep=True), self.folder)


@pytest.fixture(scope="session")
def marionette(tmp_path_factory: pytest.TempPathFactory) -> Gait:
    """A walk led by hand, without any solver."""
    folder = tmp_path_factory.mktemp("marionette")
    return Gait(synthetic_gait(folder), folder)


@pytest.fixture(scope="session", params=["marionette", "solved"])
def good(request: pytest.FixtureRequest) -> Gait:
    """Each good gait; tests must copy it before they tamper with it."""
    if request.param == "marionette":
        gait: Gait = request.getfixturevalue("marionette")
        return gait
    return Gait(request.getfixturevalue("paper_gait"), Path())
