"""Steps of people: the packaged table, and means between people."""

from __future__ import annotations

import hashlib
from importlib import resources

import numpy as np
import pytest

from ergowalk import Body
from ergowalk.errors import InputError
from ergowalk.study import steps_of_people
from ergowalk.study.people import FEWEST, leg_length, people

FOLDER = resources.files("ergowalk").joinpath("data/fukuchi2018")


def test_the_file_is_that_of_the_checksum_and_says_where_it_is_from() -> None:
    digest, name = FOLDER.joinpath("SHA256SUMS").read_text("utf-8").split()
    assert hashlib.sha256(FOLDER.joinpath(name).read_bytes()).hexdigest() == digest
    readme = FOLDER.joinpath("README.md").read_text("utf-8")
    assert "10.7717/peerj.4640" in readme
    assert "Permission is hereby granted, free of charge" in readme


def test_43_people_walked_at_six_speeds_each() -> None:
    assert len(people()) == 43
    for person in people():
        assert person.speed.shape == person.step_length.shape == (6,)
        assert (np.diff(person.speed) > 0).all()
        assert 0.3 < person.step_length.min() < person.step_length.max() < 0.9


def test_people_step_longer_and_faster_at_higher_speed() -> None:
    found = steps_of_people(np.linspace(0.6, 1.2, 13))
    assert (np.diff(found.step_length) > 0).all()
    assert (np.diff(found.cadence) > 0).all()
    # the mean of speed / step length is not the ratio of the means, but nearly (Jensen, < 1 %)
    assert found.cadence == pytest.approx(60 * found.speed / found.step_length, rel=0.01)


def test_the_mean_is_that_of_the_people_who_walked_both_slower_and_faster() -> None:
    found = steps_of_people([1.0, 1.4, 3.0])
    own = [
        np.interp(1.0, p.speed, p.step_length) for p in people() if p.speed[0] <= 1.0 <= p.speed[-1]
    ]
    assert found.people[0] == len(own)
    assert found.step_length[0] == pytest.approx(np.mean(own))
    assert found.step_length_sd[0] == pytest.approx(np.std(own, ddof=1))
    assert FEWEST <= found.people[1] < found.people[0]
    assert found.people[2] == 0
    assert np.isnan([found.step_length[2], found.step_length_sd[2], found.cadence[2]]).all()


def test_scaled_to_longer_legs_people_step_longer_and_less_often() -> None:
    legs = leg_length(Body())
    assert legs == pytest.approx(1.10, abs=0.005)  # 0.47 + 0.53 m and the height of the ankle
    plain, scaled = steps_of_people([1.2]), steps_of_people([1.2], legs)
    assert scaled.step_length > plain.step_length
    assert scaled.cadence < plain.cadence
    # a person of mean leg length, scaled: the spread due to leg length is smaller
    assert scaled.step_length_sd / scaled.step_length < plain.step_length_sd / plain.step_length


@pytest.mark.parametrize("speeds", [[0.0], [-1.0, 1.0], [float("nan")], [float("inf")]])
def test_a_speed_that_is_none_is_refused(speeds: list[float]) -> None:
    with pytest.raises(InputError, match="speeds = .*: must be positive; give speeds in m/s"):
        steps_of_people(speeds)


def test_a_leg_length_that_is_none_is_refused() -> None:
    with pytest.raises(InputError, match="leg_length = -1: must be positive; give a length in m"):
        steps_of_people([1.0], -1)
