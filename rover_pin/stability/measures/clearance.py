"""Clearance: the belly's height over the terrain."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np

from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing

if TYPE_CHECKING:
    from rover_pin.rover import Rover

# making Pinocchio's data costs more than all the rest; every use of it starts with forward kinematics
_DATA: WeakKeyDictionary[Any, Any] = WeakKeyDictionary()


def evaluate(standing: Standing) -> Margin:
    """The least height of the belly's points over the terrain below them [m], negative in the ground.

    Edges are named by link, `body#2` for a link's further points.
    """
    import pinocchio as pin

    stance = standing.stance
    belly = stance.rover.belly
    if not belly:
        return MEASURE.closed(missing(stance.rover))
    model = stance.rover.model
    data = _DATA.get(model)
    if data is None:
        data = _DATA[model] = model.createData()
    pin.forwardKinematics(model, data, np.asarray(stance.configuration))
    places = np.array([data.oMi[b.joint].act(np.asarray(b.point)) for b in belly])
    heights = places[:, 2] - stance.terrain.height(places[:, 0], places[:, 1])
    seen: dict[str, int] = {}
    edges: dict[str, float] = {}
    for point, height in zip(belly, heights.tolist(), strict=True):
        seen[point.link] = count = seen.get(point.link, 0) + 1
        edges[point.link if count == 1 else f"{point.link}#{count}"] = height
    beyond = not bool(np.all(stance.terrain.covers(places[:, 0], places[:, 1])))
    return MEASURE.margin(
        edges, note="part of the belly is beyond the map, over its border's height" if beyond else ""
    )


def missing(rover: Rover) -> str:
    """What the rover lacks, or nothing."""
    return "" if rover.belly else f"{rover.name} declares no belly points"


MEASURE = Measure("clearance", "m", "high", 0.05, evaluate, missing)
