"""MuJoCo's way to a stance: the rover dropped on the same surface and left to come to rest."""

from __future__ import annotations

import importlib
import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.benchmarks.clock import Spent, spent
from rover_pin.analysis.benchmarks.mujoco_model import ROOT, mjcf
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain

FINER = 2
"""Samples of the height field for each spacing of the map."""

REST = 1e-4  # m/s and rad/s
BETWEEN_LOOKS = 10  # steps
LOOKS = 2  # in a row below REST
LONGEST_S = 6.0
SINK = np.array([20.0, 20.0, 20.0, 5.0, 5.0, 5.0])
"""Damping of the base over the rover's mass, N s / (m kg): it sinks at about half a metre a second."""


def version() -> str | None:
    """Of MuJoCo; None where it is not installed."""
    try:
        found: Any = importlib.import_module("mujoco")
    except ImportError:
        return None
    return str(found.__version__)


@dataclass(frozen=True)
class Rest:
    """Where it came to rest.

    Attributes:
        resting: whether every speed was below `REST` twice, 40 ms apart.
        position: (3,) of the base, m.
        rotation: (3, 3) of the base.
        spent: time of the drop, from the lift to the last step.
    """

    resting: bool
    position: Array
    rotation: Array
    spent: Spent

    @property
    def yaw(self) -> float:
        """rad."""
        return math.atan2(self.rotation[1, 0], self.rotation[0, 0])


class Dropper:
    """One rover over one map, its model compiled once; only drops are timed."""

    def __init__(self, rover: Rover, terrain: Terrain) -> None:
        self.rover, self.terrain = rover, terrain
        self._mujoco: Any = importlib.import_module("mujoco")

    @cached_property
    def model(self) -> Any:
        """MuJoCo's model, the height field sampled from the surface."""
        xmin, xmax, ymin, ymax = self.terrain.extent
        columns, rows = (
            round((b - a) / self.terrain.spacing) * FINER + 1 for a, b in ((xmin, xmax), (ymin, ymax))
        )
        x, y = np.linspace(xmin, xmax, columns), np.linspace(ymin, ymax, rows)
        heights = np.concatenate([self.terrain.height(x, row)[None, :] for row in y])
        low, rise = float(heights.min()), max(float(np.ptp(heights)), 1e-3)
        size = ((xmax - xmin) / 2, (ymax - ymin) / 2, rise, 0.5)
        middle = np.array([(xmin + xmax) / 2, (ymin + ymax) / 2, low])
        text = mjcf(self.rover, self.rover.home, (rows, columns), size, middle)
        model = self._mujoco.MjModel.from_xml_string(text)
        model.hfield_data[:] = ((heights - low) / rise).ravel()
        model.dof_damping[:6] = SINK * self.rover.mass
        return model

    def drop(self, x: float, y: float, yaw: float) -> Rest:
        """Lower the level rover at a place and wait."""
        model, data = self.model, self._mujoco.MjData(self.model)
        timer = spent()
        with timer as time:
            data.qpos[:7] = x, y, 0.0, math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)
            self._mujoco.mj_forward(model, data)
            data.qpos[2] = self._lift(data)
            quiet = 0
            for _ in range(int(LONGEST_S / model.opt.timestep / BETWEEN_LOOKS)):
                self._mujoco.mj_step(model, data, nstep=BETWEEN_LOOKS)
                quiet = quiet + 1 if np.max(np.abs(data.qvel)) < REST else 0
                if quiet == LOOKS:
                    break
        body = data.body(ROOT)
        return Rest(quiet == LOOKS, body.xpos.copy(), body.xmat.reshape(3, 3).copy(), time.spent)

    def _lift(self, data: Any) -> float:
        """Height of the base at which every wheel is a millimetre above the highest ground under it."""
        needed = []
        for shape in self.rover.shapes:
            body = data.body(f"body_{shape.joint}") if shape.joint > 1 else data.body(ROOT)
            center = body.xpos + body.xmat.reshape(3, 3) @ np.asarray(shape.center)
            reach = shape.ring + shape.tread
            offsets = np.linspace(-reach, reach, 24)
            px, py = np.meshgrid(center[0] + offsets, center[1] + offsets)
            needed.append(float(np.max(self.terrain.height(px, py))) + reach - float(center[2]))
        return max(needed) + 1e-3
