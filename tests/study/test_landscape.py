"""The map of a sweep: surface, valley, people, figure, page, and the command that writes them."""

from __future__ import annotations

import base64
import gzip
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from ergowalk.cli import main
from ergowalk.errors import SweepError
from ergowalk.plots.maps import draw_map
from ergowalk.problem import preset
from ergowalk.study import Sweep
from ergowalk.study.cases import cases_of
from ergowalk.study.landscape import chosen, landscape, payload
from ergowalk.study.results import collect
from ergowalk.study.store import Store

from .standins import energy

LENGTHS = [round(0.45 + 0.05 * i, 3) for i in range(9)]
TIMES = [round(0.90 + 0.08 * i, 3) for i in range(9)]
GRID = {"step_length_m": LENGTHS, "stride_time_s": TIMES}


def stored(folder: Path, lost: Any = (), **given: Any) -> xr.Dataset:
    """A sweep whose records are made up: E is a function of L and T; ``lost`` cases have none."""
    sweep = Sweep(**{"base": preset("berbyuk2002"), "grid": GRID, **given})
    cases, store = cases_of(sweep), Store(folder)
    store.prepare(sweep, cases)
    for case in cases:
        assert case.problem is not None
        x, t = case.problem.step_length_m, case.problem.stride_time_s
        record: dict[str, Any] = {"key": case.key, "case": case.key, "values": case.values}
        record |= {"status": "crashed", "begun_at": "", "gait": ""}
        if (x, t) not in lost:
            record |= {"status": "accepted", "energy_per_metre": energy(x, t)}
        store.write_record(record)
    return collect(folder)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    """The grid with a gait everywhere."""
    return stored(tmp_path_factory.mktemp("whole") / "out")


def test_the_valley_is_where_e_along_a_line_of_constant_speed_is_least(whole: xr.Dataset) -> None:
    found = landscape(whole)
    speed, length, time, value, short, long = found.valley.T
    assert len(found.valley) > 20
    assert length == pytest.approx(2 * time * speed / 4)
    # a twelfth of the grid's step, worst at its edge
    assert length == pytest.approx(0.6 + 0.1 * (speed - 1.33), abs=0.004)
    assert value == pytest.approx(
        [energy(x, t) for x, t in zip(length, time, strict=True)], rel=1e-3
    )
    # 200 J/m per m2: half a per cent of 40 J/m is 32 mm away, where the map goes so far
    inside = (speed > 0.86) & (speed < 1.0)
    assert (length - short)[inside] == pytest.approx(0.032, abs=0.006)
    assert (long - length)[inside] == pytest.approx(0.032, abs=0.006)


def test_a_hole_in_the_map_is_no_ground(tmp_path: Path, whole: xr.Dataset) -> None:
    hole = [(LENGTHS[3], t) for t in TIMES[2:5]]
    found = landscape(stored(tmp_path / "out", lost=hole))
    assert found.accepted.sum() == 81 - 3
    assert found.accepted[found.triangles].all()
    assert len(landscape(whole).triangles) == 2 * 64
    assert len(found.triangles) < 2 * 64
    # the valley runs through the hole and is not drawn across it
    inside = (found.valley[:, 2] > TIMES[2]) & (found.valley[:, 2] < TIMES[4])
    assert not inside.any()
    assert len(found.valley) > 0


def test_people_are_beside_the_valley_as_they_are_and_scaled(whole: xr.Dataset) -> None:
    found = landscape(whole)
    assert found.plain_name == "the same people as they are (Fukuchi et al. 2018)"
    assert found.people_name == "people scaled to legs of 1.10 m ± SD"
    for rows, cadence in ((found.plain, 108), (found.people, 91)):  # 43 adults, legs of 0.87 m
        assert (np.diff(rows[:, 0]) > 0).all()
        assert np.interp(1.0, *rows.T[:2]) == pytest.approx(cadence, abs=3)
        assert (rows[:, 2] > 0).all()


def test_random_cases_make_a_map_too(tmp_path: Path) -> None:
    random = {
        "count": 60,
        "between": {"step_length_m": [0.45, 0.85], "stride_time_s": [0.9, 1.54]},
    }
    found = landscape(stored(tmp_path / "out", grid=None, random=random))
    speed, length = found.valley[:, 0], found.valley[:, 1]
    assert len(found.valley) > 10
    assert length == pytest.approx(0.6 + 0.1 * (speed - 1.33), abs=0.01)


def test_one_number_is_a_curve(tmp_path: Path) -> None:
    grid = {"corridors.width_sd": [1.0, 1.5, 2.0]}
    found = landscape(stored(tmp_path / "out", grid=grid))
    assert found.y is None
    assert found.x.tolist() == [1.0, 1.5, 2.0]
    assert draw_map(found).axes[0].get_xlabel() == "corridors.width_sd"


def test_a_third_number_must_be_chosen(tmp_path: Path) -> None:
    grid = {"corridors.width_sd": [1.0, 2.0], **GRID, "double_support": ["optimal"]}
    dataset = stored(tmp_path / "out", grid=grid)
    with pytest.raises(
        SweepError, match=r"a map shows one or two .* --at corridors.width_sd=VALUE"
    ):
        landscape(dataset)
    found = landscape(chosen(dataset, {"corridors.width_sd": "2"}))
    assert found.x.shape == (81,)
    assert found.x_name == "stride time T [s]"
    assert found.y_name == "step length L [m]"
    page = payload(found, chosen(dataset, {"corridors.width_sd": "2"}))
    assert page["cases"][1]["key"] == dataset["key"].to_numpy()[1, 0, 1, 0]
    assert page["energy"][1] == pytest.approx(energy(LENGTHS[0], TIMES[1]), rel=1e-5)
    with pytest.raises(
        SweepError, match=r"corridors.width_sd = '3': has no such value; choose one"
    ):
        chosen(dataset, {"corridors.width_sd": "3"})
    with pytest.raises(SweepError, match=r"at = 'mass': was not swept; choose one of corridors"):
        chosen(dataset, {"mass": "3"})


def test_words_must_be_chosen(tmp_path: Path) -> None:
    grid = {"double_support": ["optimal", "linear"], "step_length_m": LENGTHS}
    dataset = stored(tmp_path / "out", grid=grid)
    with pytest.raises(SweepError, match="--at double_support=VALUE"):
        landscape(dataset)
    assert landscape(chosen(dataset, {"double_support": "linear"})).y is None


def test_a_map_without_a_gait_is_refused(tmp_path: Path) -> None:
    lost = [(x, t) for x in LENGTHS for t in TIMES]
    with pytest.raises(SweepError, match="sweep: has no accepted gait; see the reasons in index"):
        landscape(stored(tmp_path / "out", lost=lost))


def test_the_figure_has_both_maps_the_valley_and_the_lines_of_speed(whole: xr.Dataset) -> None:
    found = landscape(whole)
    left, right, _ = draw_map(found, "title").axes
    assert {text.get_text() for text in left.texts} >= {"1 m/s", "1.2 m/s", "1.4 m/s"}
    assert right.get_xlabel() == "walking speed [m/s]"
    labels = right.get_legend_handles_labels()[1]
    assert labels == [
        "people scaled to legs of 1.10 m ± SD",
        "the same people as they are (Fukuchi et al. 2018)",
        "cheapest at each speed; within 0.5 % of it",
    ]
    for speed in (1.0, 1.2):
        (line,) = [
            x
            for x in left.lines
            if len(x.get_xdata()) == 2
            and x.get_ydata()[0] == pytest.approx(speed * x.get_xdata()[0] / 2)
        ]
        assert line.get_ydata()[1] == pytest.approx(speed * line.get_xdata()[1] / 2)


# --- the command --------------------------------------------------------------------------------


def test_map_writes_figures_and_a_page_with_its_gaits(
    tmp_path: Path, paper_gait_file: Path, capsys: Any
) -> None:
    folder = tmp_path / "out"
    keys = stored(folder)["key"].to_numpy().ravel()
    store = Store(folder)
    for key in keys[:2]:
        store.gait(key).symlink_to(paper_gait_file)
    assert main(["map", str(folder)]) == 0
    out, err = capsys.readouterr()
    assert "sweep: 81 of 81 cases" in out
    assert "1.00 m/s         0.567 m      1.1" in out
    assert err == "ergowalk: 79 gaits cannot be read, and are not in the page\n"
    for name in ("map.png", "map.svg"):
        assert (folder / name).stat().st_size > 10_000
    page = (folder / "map.html").read_text("utf-8")
    assert "http://" not in page.replace("http://www.w3.org/2000/svg", "")
    assert "https://" not in page
    start = page.index('id="gaits">') + 11
    gaits = json.loads(page[start : page.index("</script>", start)])
    assert set(gaits) == set(keys[:2])
    gait = json.loads(gzip.decompress(base64.b64decode(gaits[keys[0]])))
    assert gait["label"].startswith("L = 0.76 m, T = 1.14 s, E = ")
    assert len(gait["hip"]) == 301


def test_map_as_json_names_the_valley(tmp_path: Path, capsys: Any) -> None:
    stored(tmp_path / "out", lost=[(0.45, 0.9)])
    assert main(["map", str(tmp_path / "out"), "--json", "--no-page", "-o", str(tmp_path)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["accepted"] == 80
    first = told["valley"][0]
    assert first["step_length_m"] == pytest.approx(first["speed_m_s"] * first["stride_time_s"] / 2)
    assert told["files"] == [str(tmp_path / "map.png"), str(tmp_path / "map.svg")]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["none"], "none: holds no sweep; run 'ergowalk sweep' first"),
        (["out", "--sweep", "moon"], "out: holds no sweep moon; choose one of sweep-"),
        (["out", "--at", "L"], "out: --at = 'L': names no field and value; write FIELD=VALUE"),
        (["out", "--at", "sun=1"], "out: at = 'sun': was not swept; choose one of step_length_m"),
        ([], "DIR"),
    ],
)
def test_what_is_no_map_is_one_line(
    tmp_path: Path, arguments: list[str], words: str, capsys: Any, monkeypatch: Any
) -> None:
    stored(tmp_path / "out", grid={"step_length_m": LENGTHS})
    monkeypatch.chdir(tmp_path)
    assert main(["map", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert words in err
