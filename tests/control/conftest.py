import numpy as np
import pytest
from sides import HIT

import rover_pin as rp
from rover_pin.control.motion_constraints import Options, motion_constraints
from rover_pin.control.settled_loads import settled_loads
from rover_pin.kinematics.instant import Bodies


@pytest.fixture(scope="session")
def hit():
    return rp.load("hit_mrii")


@pytest.fixture(scope="session")
def level(hit):
    return Bodies(hit, rp.Terrain.flat())


@pytest.fixture(scope="session")
def raised(hit):
    """At a clearance of 480 mm."""
    return rp.settle(hit, rp.Terrain.flat(), posture={"clearance": 0.48})


@pytest.fixture(scope="session")
def constraints(hit):
    return motion_constraints(hit, HIT, options=Options(loads_at=settled_loads(hit, rp.Terrain.flat())))


@pytest.fixture
def still(hit):
    return np.zeros(hit.model.nv)
