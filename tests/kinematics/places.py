"""Rovers on grounds, at rest: where rows are tested."""

from functools import cache
from pathlib import Path

import numpy as np

import rover_pin as rp
from rover_pin.kinematics.instant import Bodies

FIXTURES = Path(__file__).parents[1] / "fixtures"
GROUNDS = ("flat", "slope:8", "rough:3,0.04,0.8")
ROVERS = ("hit_mrii", "rocker_bogie", "polibot", "rigid4", "trailing4")


@cache
def rover(name):
    if (FIXTURES / name).is_dir():
        folder = FIXTURES / name
        return rp.load(next(iter(sorted([*folder.glob("*.xacro"), *folder.glob("*.urdf")]))))
    return rp.load(name)


@cache
def ground(word):
    return rp.Terrain.parse(word)


@cache
def resting(name, word):
    """An instant of a rover at rest, off the symmetric place."""
    terrain = ground(word)
    at = (0.3, 0.4, 0.7) if word.startswith("rough") else (0.2, -0.1, 0.7)
    stance = rp.settle(rover(name), terrain, x=at[0], y=at[1], yaw=at[2])
    assert stance.settled, (name, word, stance.reason)
    return Bodies(rover(name), terrain).at(np.array(stance.configuration))


def difference(function, at, step=1e-6):
    """(k, nv) central differences of function(instant) -> (k,) by q."""
    columns = []
    for c in range(len(at.q)):
        sides = []
        for sign in (1.0, -1.0):
            q = at.q.copy()
            q[c] += sign * step
            sides.append(np.atleast_1d(function(at.bodies.at(q))))
        columns.append((sides[0] - sides[1]) / (2.0 * step))
    return np.array(columns).T
