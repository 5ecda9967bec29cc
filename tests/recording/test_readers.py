"""Readers: what stands in a file is what is read, and hostile files are one sentence."""

from __future__ import annotations

import importlib.util
import struct
from pathlib import Path

import numpy as np
import pytest

import fuzz_recordings
from ergowalk.errors import RecordingError
from ergowalk.recording import Recording, read_recording
from made_up_walk import c3d_bytes, csv_text, mot_text, recording, trc_text, walker

KNOWN = walker(duration=2.0, rate=50.0)
WHOLE = recording(KNOWN, unit="mm")

needs_ezc3d = pytest.mark.skipif(
    importlib.util.find_spec("ezc3d") is None, reason="ezc3d is an extra"
)


def written(folder: Path, name: str, content: str | bytes) -> Path:
    """A file with this content."""
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def assert_same_markers(found: Recording, tolerance: float) -> None:
    """All markers of the made-up walk, to ``tolerance`` mm."""
    assert set(found.markers) == set(WHOLE.markers)
    for name, values in WHOLE.markers.items():
        np.testing.assert_allclose(found.markers[name], values, atol=tolerance)


def assert_same_plates(found: Recording, tolerance: float) -> None:
    """Both plates of the made-up walk: forces to ``tolerance`` N, moments to 1e-3 N m."""
    known = WHOLE.in_metres("mm")
    for plate, original in zip(found.in_metres("mm").plates, known.plates, strict=True):
        np.testing.assert_allclose(plate.force, original.force, atol=tolerance)
        moment = original.moment_about_origin()
        np.testing.assert_allclose(plate.moment_about_origin(), moment, atol=1e-3)


def test_trc_gives_its_markers(tmp_path: Path) -> None:
    found = read_recording([written(tmp_path, "walk.trc", trc_text(WHOLE))])
    assert found.unit == "mm"
    assert found.rate == pytest.approx(50.0)
    assert_same_markers(found, 1e-5)  # five decimals


def test_mot_gives_its_plates_beside_the_markers(tmp_path: Path) -> None:
    files = [("walk.trc", trc_text(WHOLE)), ("grf.mot", mot_text(WHOLE))]
    found = read_recording([written(tmp_path, *file) for file in files])
    assert len(found.plates) == 2
    assert_same_plates(found, 1e-6)


@needs_ezc3d
def test_c3d_gives_markers_and_plates(tmp_path: Path) -> None:
    """The file is written byte by byte after the format, without ezc3d."""
    found = read_recording([written(tmp_path, "walk.c3d", c3d_bytes(WHOLE))])
    assert found.unit == "mm"
    assert_same_markers(found, 1e-3)  # single precision
    assert_same_plates(found, 1e-3)  # single precision


@needs_ezc3d
def test_c3d_without_forces_is_markers_alone(tmp_path: Path) -> None:
    bare = Recording("bare", WHOLE.time, WHOLE.markers, "mm")
    found = read_recording([written(tmp_path, "walk.c3d", c3d_bytes(bare))])
    assert found.plates == ()
    assert_same_markers(found, 1e-3)


def test_table_gives_markers_and_plate(tmp_path: Path) -> None:
    found = read_recording([written(tmp_path, "walk.csv", csv_text(KNOWN))])
    assert found.planar
    assert found.unit == "m"
    np.testing.assert_allclose(
        found.markers["mt5"][:, :2], KNOWN.points["right"]["metatarsal"], atol=1e-6
    )
    (plate,) = found.plates
    np.testing.assert_allclose(plate.force[:, :2], KNOWN.force["right"], atol=1e-6)


@pytest.mark.parametrize(
    ("header", "marker", "unit"),
    [
        ("time_s,heel_x_m,heel_y_m", "heel", "m"),
        ("% TimeStamp\tRHEE.PosX\tRHEE.PosY", "RHEE", None),
        ("Time\tCAx\tCAy\tCAz", "CA", None),
        ("time (s);heel x (mm);heel y (mm)", "heel", "mm"),
    ],
)
def test_tables_name_their_columns_in_many_ways(
    tmp_path: Path, header: str, marker: str, unit: str | None
) -> None:
    mark = max("\t;,", key=header.count)
    width = header.count(mark)
    rows = [mark.join([f"{0.01 * i:.2f}", *["1.5"] * width]) for i in range(20)]
    found = read_recording([written(tmp_path, "walk.txt", "\n".join([header, *rows]))])
    assert list(found.markers) == [marker]
    assert found.unit == unit


def test_a_marker_that_was_not_seen_is_not_a_number(tmp_path: Path) -> None:
    gap = {name: values.copy() for name, values in WHOLE.markers.items()}
    gap["C7"][5:8] = np.nan
    text = trc_text(Recording("gap", WHOLE.time, gap, "mm"))
    found = read_recording([written(tmp_path, "walk.trc", text)])
    assert np.flatnonzero(np.isnan(found.markers["C7"]).any(axis=1)).tolist() == [5, 6, 7]


GOOD_TRC, GOOD_MOT, GOOD_CSV = trc_text(WHOLE), mot_text(WHOLE), csv_text(KNOWN)


@pytest.mark.parametrize(
    ("name", "content", "match"),
    [
        ("a.trc", "", "is empty; give a recorded walk"),
        ("a.c3d", b"", "is empty; give a recorded walk"),
        ("a.csv", "\n\n", "is empty"),
        ("a.mot", b"\0" * 600, "is empty"),
        ("a.trc", "hello", "must begin with PathFileType"),
        ("a.trc", b"PathFileType\0", "is no text file"),
        ("a.trc", GOOD_TRC[: len(GOOD_TRC) // 2], "NumFrames = 101: the file has .* truncated"),
        ("a.trc", GOOD_TRC.replace("\tmm\t", "\tfurlong\t"), "Units = 'furlong': must be one of"),
        ("a.trc", GOOD_TRC.replace("\t101\t", "\t99999999999\t"), "NumFrames = 99999999999"),
        ("a.trc", GOOD_TRC.replace("\n20\t", "\n20\tx"), "line 25, column 2 = 'x0.*is no number"),
        ("a.mot", GOOD_MOT.replace("endheader", ""), "line endheader"),
        ("a.mot", GOOD_MOT[: len(GOOD_MOT) // 2], "nRows = 101: the file has .* truncated"),
        ("a.mot", GOOD_MOT.replace("ground", "air"), "has no ground reactions; name the columns"),
        ("a.csv", "a,b,c\n1,2,3", "has no header line with a time column"),
        ("a.csv", "time_s,a,b\n" + "0,1,2\n" * 20, "time_s: must be finite and run forward"),
        ("a.csv", GOOD_CSV.replace("_y_m,knee", "_y_mm,knee"), "lengths stand in m and mm"),
        ("a.csv", GOOD_CSV.replace("\n0.5", "\n7.5", 1), "must run in equal steps"),
        ("a.c3d", b"\2\x51" + b"1" * 2000, "is no C3D file"),
        ("a.zip", "x", "is of no kind that is known by its name"),
    ],
)
def test_hostile_files_are_one_sentence(
    tmp_path: Path, name: str, content: str | bytes, match: str
) -> None:
    with pytest.raises(RecordingError, match=match) as raised:
        read_recording([written(tmp_path, name, content)])
    assert str(raised.value).startswith(str(tmp_path / name))
    assert "\n" not in str(raised.value)


def test_a_missing_file_and_a_folder_are_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="cannot be read"):
        read_recording([tmp_path / "none.trc"])
    (tmp_path / "folder.trc").mkdir()
    with pytest.raises(RecordingError, match="is no file"):
        read_recording([tmp_path / "folder.trc"])


def test_a_truncated_c3d_says_how_much_is_missing(tmp_path: Path) -> None:
    whole = c3d_bytes(WHOLE)
    path = written(tmp_path, "walk.c3d", whole[: len(whole) // 2])
    with pytest.raises(RecordingError, match=r"is truncated: its header claims \d+ bytes, it has"):
        read_recording([path])


def test_a_claim_of_gigabytes_is_refused_before_anything_is_read(tmp_path: Path) -> None:
    claim = bytearray(c3d_bytes(WHOLE))
    claim[2:10] = struct.pack("<4H", 0xFFFE, 0xFFFE, 1, 0xFFFE)
    with pytest.raises(RecordingError, match="claims more than 50000000 numbers"):
        read_recording([written(tmp_path, "walk.c3d", bytes(claim))])


def test_c3d_without_its_package_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(RecordingError, match=r"pip install 'ergowalk\[c3d\]'"):
        read_recording([written(tmp_path, "walk.c3d", c3d_bytes(WHOLE))])


def test_a_reader_that_dies_is_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As compiled code may on a damaged file."""
    monkeypatch.setattr("sys.executable", "/bin/false")
    monkeypatch.setattr("importlib.util.find_spec", lambda name: True)
    with pytest.raises(RecordingError, match="is damaged.*reader stopped with status 1"):
        read_recording([written(tmp_path, "walk.c3d", c3d_bytes(WHOLE))])


def test_two_files_with_markers_are_refused(tmp_path: Path) -> None:
    paths = [written(tmp_path, name, trc_text(WHOLE)) for name in ("a.trc", "b.trc")]
    with pytest.raises(RecordingError, match="has markers, and .*a.trc has"):
        read_recording(paths)


def test_forces_alone_are_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="no file has markers"):
        read_recording([written(tmp_path, "grf.mot", mot_text(WHOLE))])


@pytest.mark.parametrize("kind", [k for k in fuzz_recordings.READERS if k != "c3d"])
def test_damaged_files_are_a_walk_or_one_sentence(kind: str) -> None:
    """The script does this with ten thousand files of each kind."""
    found = fuzz_recordings.fuzz(kind, 120, seed=7)
    assert [outcome for outcome in found if outcome.startswith("WRONG")] == []
    assert found["refused"] > 20
    assert found["read"] > 5


@needs_ezc3d
@pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="asks in forks")
def test_damaged_c3d_files_are_a_walk_or_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ergowalk.recording.c3d._asked", fuzz_recordings.asked_by_fork)
    found = fuzz_recordings.fuzz("c3d", 60, seed=7)
    assert [outcome for outcome in found if outcome.startswith("WRONG")] == []
    assert found["refused"] > 10
    assert found["read"] > 3
