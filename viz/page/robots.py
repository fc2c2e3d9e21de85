"""The robot as a study's page poses it: its recorded looks, its tree of joints, its wheels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.viz.page.inside import inside
from rover_pin.viz.record import recording
from rover_pin.viz.scene import draw_robot, span_of
from rover_pin.viz.tree import joint_nodes

if TYPE_CHECKING:
    from rover_pin.rover import Rover


def robot(rover: Rover, index: int = 0) -> tuple[dict[str, Any], bytes]:
    """What the page poses, and Meshcat's commands that draw it.

    The page poses `nodes`, `wheels`, `springs`, `tracks`; `span` and `outline` say how large the robot is.

    The commands write under `robot<index>`, so that a page can hold several.
    """
    visualizer, recorder = recording()
    draw_robot(visualizer[f"robot{index}"], rover)
    nodes = joint_nodes(rover.model)
    order = {node.joint: i for i, node in enumerate(nodes)}
    about = {
        "root": np.asarray(rover.model.jointPlacements[1].homogeneous).T.ravel(),  # column-major, as three.js
        "nodes": [
            {
                "name": node.name,
                "path": f"robot{index}/{node.path}",
                "axis": node.axis,
                "slides": node.slides,
                "mass": node.mass,
                "lever": node.lever,
            }
            for node in nodes
        ],
        "wheels": [
            {
                "name": shape.name,
                "node": order[shape.joint],
                "center": shape.center,
                "axis": shape.axis,
                "ring": shape.ring if shape.form == 0 else 0.0,
                "tread": shape.tread,
            }
            for shape in rover.shapes
        ],
        **inside(rover, nodes),
        "span": span_of(rover),
        "outline": _outline(rover),
    }
    return about, recorder.stream()


def _outline(rover: Rover) -> list[float]:
    """(xmin, xmax, ymin, ymax) m of the wheels about the base at zero, their rings' size included."""
    import pinocchio as pin

    data = rover.model.createData()
    pin.forwardKinematics(rover.model, data, pin.neutral(rover.model))
    base = data.oMi[1].inverse()
    places, reach = [], []
    for shape in rover.shapes:
        places.append((base * data.oMi[shape.joint]).act(np.asarray(shape.center, dtype=np.float64)))
        reach.append([shape.ring + shape.tread, shape.tread])
    if not places:
        return [-0.5, 0.5, -0.5, 0.5]
    at, size = np.array(places)[:, :2], np.array(reach)
    low, high = (at - size).min(axis=0), (at + size).max(axis=0)
    return [float(low[0]), float(high[0]), float(low[1]), float(high[1])]
