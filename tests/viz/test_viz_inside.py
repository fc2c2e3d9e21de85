"""Tracks and springs in the picture: where the model has them."""

import numpy as np
import pytest
from tracked_rover import tracked

import rover_pin as rp
from rover_pin.mechanism import Kinematics
from rover_pin.viz.inside import BELT, struts, tracks


def test_a_drawn_track_lies_on_its_taut_way():
    rover = tracked()
    stance = rp.settle(rover, rp.Terrain.flat())
    at = Kinematics(rover.model, rover.model.createData(), np.array(stance.configuration))
    path = rover.tracks[0].path(at)
    drawn = tracks(rover, stance.configuration, 1.0)
    away = np.linalg.norm(drawn.vertices[:, None] - path[None], axis=2).min(axis=1)
    assert away.max() <= BELT + 1e-9
    assert drawn.vertices[:, 2].min() == pytest.approx(-BELT, abs=2e-3)


def test_a_drawn_strut_goes_from_end_to_end():
    rover = rp.load("polibot_half")
    stance = rp.settle(rover, rp.Terrain.flat())
    drawn = struts(rover, stance.configuration, 1.0)
    at = Kinematics(rover.model, rover.model.createData(), np.array(stance.configuration))
    ends = np.array([end.origin(at) for s in rover.springs for end in (s.first, s.second)])
    low, high = ends.min(axis=0), ends.max(axis=0)
    assert np.all(drawn.vertices >= low - 0.01)
    assert np.all(drawn.vertices <= high + 0.01)
    assert not len(struts(rp.load("rocker_bogie"), rp.load("rocker_bogie").neutral, 1.0).faces)
