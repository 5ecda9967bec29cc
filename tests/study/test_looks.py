"""Second looks spread a cheaper branch over the map, and depend on what is on disk alone."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import Any

import pytest

from ergowalk.study.looks import GAIN, Look, Looks

SIDE = 8


class Map:
    """A grid whose gaits have two branches: continuation began on the dear one.

    From the human means the cheap one is found where ``cold`` says so; a gait begun at another
    stays on its branch.
    """

    def __init__(self, cheaper: float = 0.03, rough: float = 0.0, **solve: int) -> None:
        self.cheaper, self.rough = cheaper, rough
        self.cells = list(itertools.product(range(SIDE), range(SIDE)))
        self.definition: dict[str, Any] = {
            "probes": 0,
            "second_looks": 0,
            "cases": [{"key": self.key(c), "place": [float(x) for x in c]} for c in self.cells],
            **solve,
        }
        self.records: dict[str, dict[str, Any]] = {}
        for cell in self.cells:
            start = self.key((max(cell[0] - 1, 0), cell[1])) if cell != (0, 0) else ""
            self.store(self.key(cell), cell, start, cheap=False)

    @staticmethod
    def key(cell: tuple[int, int]) -> str:
        return f"{cell[0]}-{cell[1]}"

    def energy(self, cell: tuple[int, int], cheap: bool) -> float:
        x, y = cell
        ripple = self.rough * (-1) ** (x + y)
        return (40 + x + 0.3 * (y - 4) ** 2) * (1 - self.cheaper * cheap + ripple)

    def store(self, key: str, cell: tuple[int, int], start: str, cheap: bool) -> None:
        self.records[key] = {
            "key": key,
            "status": "accepted",
            "begun_at": start,
            "gait": "x.nc",
            "energy_per_metre": self.energy(cell, cheap),
            "cheap": cheap,
            "cpu_s": 2.0,
        }

    def known(self, keys: Iterable[str]) -> dict[str, dict[str, Any]]:
        return {key: self.records[key] for key in keys if key in self.records}

    def search(self, look: Look) -> None:
        cell = self.cells[[self.key(c) for c in self.cells].index(look.case)]
        cheap = self.records[look.start]["cheap"] if look.start else cell[0] >= SIDE - 2
        self.store(look.key, cell, look.start, cheap)

    def run(self, most: int = 10_000) -> tuple[Looks, list[int]]:
        """All rounds, or so many searches of them."""
        looks, counts = Looks(self.definition, self.known), []
        for those in looks.each_round():
            counts.append(len(those))
            for look in those:
                if look.key not in self.records and most > 0:
                    self.search(look)
                    most -= 1
        return looks, counts


def test_a_cheaper_branch_that_a_probe_finds_spreads_over_the_map() -> None:
    there = Map(probes=3, second_looks=20)
    looks, counts = there.run()
    assert counts[0] == 3
    for cell in there.cells:
        if cell[0] > 0:  # at the far edge the trend has nothing beyond it to go by
            best = looks.best[there.key(cell)]["energy_per_metre"]
            assert best == there.energy(cell, cheap=True)
    assert sum(looks.searches.values()) == len(there.records)
    assert sum(looks.cpu_s.values()) == 2.0 * len(there.records)


def test_the_rounds_end_where_they_are_told_to() -> None:
    looks, counts = Map(probes=3, second_looks=2).run()
    assert len(counts) == 3
    assert not all(record["cheap"] for record in looks.best.values())


def test_without_probes_or_looks_nothing_is_searched_again() -> None:
    looks, counts = Map().run()
    assert counts == [0]
    assert set(looks.searches.values()) == {1}


def test_a_smooth_map_promises_nothing() -> None:
    """Nor does one that is rough by less than a mesh decides."""
    for rough in (0.0, 0.3 * GAIN):
        _, counts = Map(rough=rough, second_looks=5).run()
        assert counts == [0]


def test_a_gait_that_stands_out_is_searched_again_from_its_neighbours() -> None:
    there = Map(second_looks=5)
    there.records["4-4"]["energy_per_metre"] *= 1.03
    looks, _ = there.run()
    again = [key for key, count in looks.searches.items() if count > 1]
    assert "4-4" in again
    assert looks.best["4-4"]["energy_per_metre"] == there.energy((4, 4), cheap=False)
    assert len(again) <= 9  # itself, and neighbours that its bump has lifted the trend of


def test_a_case_without_an_accepted_gait_is_searched_from_every_neighbour_that_has_one() -> None:
    there = Map(second_looks=20)
    there.records["4-4"] |= {"status": "out of time", "gait": "", "energy_per_metre": None}
    looks, _ = there.run()
    assert looks.best["4-4"]["status"] == "accepted"
    hopeless = Map(second_looks=20)
    hopeless.records["4-4"] |= {"status": "rejected"}
    hopeless.store = lambda key, *_, **__: hopeless.records.setdefault(  # type: ignore[method-assign]
        key, hopeless.records["4-4"] | {"key": key}
    )
    looks, counts = hopeless.run()
    # from (3, 4) it had begun; the seven others were tried, one a round, and then no more
    assert counts == [0, *[1] * 7]
    assert looks.best["4-4"]["status"] == "rejected"


@pytest.mark.parametrize("after", [0, 2, 5, 17])
def test_looks_that_were_interrupted_go_on_where_they_were(after: int) -> None:
    whole, broken = Map(probes=3, second_looks=20), Map(probes=3, second_looks=20)
    whole.run()
    broken.run(most=after)
    assert broken.records != whole.records
    looks = Looks(broken.definition, broken.known).finished()
    assert set(looks.best) == set(map(broken.key, broken.cells))
    broken.run()
    assert broken.records == whole.records


def test_probes_lie_apart_and_where_no_case_was_begun_at_the_human_means() -> None:
    there = Map(probes=3)
    (probes,) = list(Looks(there.definition, there.known).each_round())
    assert [look.case for look in probes] == ["7-7", "0-7", "7-0"]
    assert {look.start for look in probes} == {""}


def test_a_case_that_was_never_searched_stops_all_looks() -> None:
    there = Map(probes=3, second_looks=5)
    del there.records["2-2"]
    assert list(Looks(there.definition, there.known).each_round()) == []
