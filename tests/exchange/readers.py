"""Strict readers of the foreign formats, written from their descriptions, not from the writers."""

from __future__ import annotations

import csv
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Storage:
    """An OpenSim storage file: first line, keys of the header, columns by label."""

    name: str
    header: dict[str, str]
    columns: dict[str, Array]


def read_storage(text: str) -> Storage:
    """A .mot or .sto; every count of the header must be that of the data."""
    head, _, data = text.partition("\nendheader\n")
    name, *lines = head.split("\n")
    header = dict(line.split("=", 1) for line in lines if "=" in line)
    assert header["version"] == "1"
    labels, *rows = data.removesuffix("\n").split("\n")
    names = labels.split("\t")
    values = np.array([[float(cell) for cell in row.split("\t")] for row in rows])
    assert values.shape == (int(header["nRows"]), int(header["nColumns"]))
    assert len(names) == len(set(names)) == values.shape[1]
    assert names[0] == "time"
    assert np.all(np.isfinite(values))
    assert np.all(np.diff(values[:, 0]) > 0)
    return Storage(name, header, dict(zip(names, values.T, strict=True)))


@dataclass(frozen=True)
class Markers:
    """A TRC file: keys of the header, times [s], positions (n, 3) by marker."""

    header: dict[str, str]
    time: Array
    places: dict[str, Array]


def read_trc(text: str) -> Markers:
    """A .trc; counts, frames and labels must agree."""
    first, keys, values, names, axes, blank, *rows = text.removesuffix("\n").split("\n")
    assert first.split("\t")[:3] == ["PathFileType", "4", "(X/Y/Z)"]
    assert blank == ""
    header = dict(zip(keys.split("\t"), values.split("\t"), strict=True))
    frame, time, *labels = names.split("\t")
    assert (frame, time) == ("Frame#", "Time")
    markers = labels[::3]
    assert all(label == "" for i, label in enumerate(labels) if i % 3)
    assert len(markers) == int(header["NumMarkers"]) == len(set(markers))
    assert axes.split("\t")[2:] == [f"{a}{i + 1}" for i in range(len(markers)) for a in "XYZ"]
    data = np.array([[float(cell) for cell in row.split("\t")] for row in rows])
    assert data.shape == (int(header["NumFrames"]), 2 + 3 * len(markers))
    assert data[:, 0].tolist() == list(range(1, len(data) + 1))
    places = {m: data[:, 2 + 3 * i : 5 + 3 * i] for i, m in enumerate(markers)}
    return Markers(header, data[:, 1], places)


def read_csv(text: str) -> dict[str, list[str]]:
    """A CSV table with a line of names: cells by column."""
    names, *rows = csv.reader(text.splitlines())
    assert len(names) == len(set(names))
    return dict(zip(names, map(list, zip(*rows, strict=True)), strict=True))


def floats(cells: list[str]) -> Array:
    """Cells as numbers, empty ones as NaN."""
    return np.array([float(cell) if cell else np.nan for cell in cells])
