"""hit_mrii at random places of the measured Mars-yard map: every settled row checked again, none lost."""

import dataclasses
import math
import os
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from recheck import residuals, retry
from tree_walk import machine

import rover_pin as rp

DATA = Path(os.environ.get("ROVER_PIN_DATA", Path(__file__).parents[3] / "shared" / "data")) / "terrain"
MAP = DATA / "marsyard2021.tif"
CASES = 4000
RECHECKED = 1200


@pytest.mark.slow  # four thousand stances, twelve hundred of them checked again in numpy
def test_random_places_of_the_mars_yard():
    if not MAP.exists():
        pytest.skip(f"{MAP} is not here")
    terrain = rp.Terrain.from_file(MAP, 0.094)
    rover = rp.load("hit_mrii")
    read = machine(rover)
    xmin, xmax, ymin, ymax = terrain.extent
    rng = np.random.default_rng(7)
    statuses, lost = Counter(), []
    for _ in range(CASES):
        place = (rng.uniform(xmin, xmax), rng.uniform(ymin, ymax), rng.uniform(-math.pi, math.pi))
        stance = rp.settle(rover, terrain, x=place[0], y=place[1], yaw=place[2])
        statuses[str(stance.status)] += 1
        if str(stance.status) == "no_convergence":
            lost.append(place)
        if not stance.settled:
            assert not stance.loads
            continue
        assert stance.residuals["equilibrium"] <= 1e-6, place
        assert stance.residuals["gap_m"] <= 1e-6, place
        assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)
        if statuses["settled"] <= RECHECKED:
            unbalanced, gap = residuals(stance, read)
            assert unbalanced <= 1e-6, place
            assert gap <= 1e-6, place
    told = [(place, rest.residual) for place, rest in zip(lost, retry(rover, terrain, lost), strict=True)]
    assert statuses["settled"] > CASES / 3, statuses
    assert len(lost) <= CASES / 1000, f"{statuses}; the oracle's residuals: {told}"


def test_the_check_sees_what_is_wrong():
    """A millimetre too high, a wheel's load off by a newton, a bogie turned by a milliradian."""
    stance = rp.settle(rp.load("hit_mrii"), rp.Terrain.rough(3, 0.1, 0.8), x=1.0, y=0.5, yaw=0.2)
    unbalanced, gap = residuals(stance)
    assert unbalanced < 1e-12
    assert gap < 1e-12
    high = dataclasses.replace(stance, position=stance.position + np.array([0.0, 0.0, 1e-3]))
    assert residuals(high)[1] == pytest.approx(1e-3, rel=0.1)
    first = dataclasses.replace(stance.contacts[0], load=stance.contacts[0].load + 1.0)
    heavy = dataclasses.replace(stance, contacts=(first, *stance.contacts[1:]))
    assert residuals(heavy)[0] > 1e-4
    turned = dataclasses.replace(stance, joints={**stance.joints, "L_bogie": stance.joints["L_bogie"] + 1e-3})
    assert residuals(turned)[1] > 1e-4
