"""Samples of a motion as they come, and the Run that they make."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.control.motion_constraints import MotionConstraint
from rover_pin.control.now import Now
from rover_pin.numerics import Array, frozen
from rover_pin.simulation.run import Run

if TYPE_CHECKING:
    from rover_pin.control.actions import Grip
    from rover_pin.control.controller import Cycle
    from rover_pin.kinematics.advance import Sliding
    from rover_pin.kinematics.instant import Instant
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance
    from rover_pin.terrain import Terrain


class Log:
    """Grows by samples.

    Args:
        rover: what moves.
        terrain: on what.
        constraints: motion constraints that are read, by name.
    """

    def __init__(self, rover: Rover, terrain: Terrain, constraints: Mapping[str, MotionConstraint]) -> None:
        self.rover, self.terrain = rover, terrain
        self._constraints = dict(constraints)
        self._parts = {name: len(constraint.parts) for name, constraint in constraints.items()}
        self._time: list[float] = []
        self._q: list[Array] = []
        self._v: list[Array] = []
        self._actions: list[str] = []
        self._lifted: list[tuple[str, ...]] = []
        self._indices: dict[str, list[Array]] = {name: [] for name in constraints}
        self._values: dict[str, list[Array]] = {name: [] for name in constraints}
        self._loads: list[list[float]] = []
        self._drift: list[Array] = []
        self._residual: list[float] = []
        self._apart: list[float] = []

    def add(
        self,
        time: float,
        at: Instant,
        action: str,
        grip: Grip,
        stance: Stance,
        cycle: Cycle | None,
        sliding: Sliding,
    ) -> None:
        """One sample: where the motion is, what is done, where the statics set the rover down."""
        nv, wheels = self.rover.model.nv, [wheel.name for wheel in self.rover.wheels]
        readings = {} if cycle is None else cycle.readings
        loads = dict(stance.loads) if stance.settled else None
        still = np.zeros(nv)
        now = Now(at, still, still, grip.lifted, loads, tuple(grip.clutches))

        def unwatched(name: str) -> Array:
            """A posture's or loads' value that no threshold asks for, so that its history is whole."""
            constraint = self._constraints[name]
            known = constraint.kind in ("posture", "set") or (constraint.kind == "load" and loads is not None)
            return constraint.value(now) if known else np.full(self._parts[name], np.nan)

        self._time.append(time)
        self._q.append(np.array(at.q))
        self._v.append(np.zeros(nv) if cycle is None else np.array(cycle.velocity))
        self._actions.append(action)
        self._lifted.append(grip.lifted)
        for name, parts in self._parts.items():
            reading = readings.get(name)
            unknown = np.full(parts, np.nan)
            self._indices[name].append(unknown if reading is None else np.array(reading.index))
            self._values[name].append(unwatched(name) if reading is None else np.array(reading.value))
        self._loads.append([stance.loads[name] if stance.settled else np.nan for name in wheels])
        self._drift.append(np.linalg.norm(sliding.slid[: len(wheels)], axis=1))
        self._residual.append(max(stance.residuals.values()) if stance.settled else np.nan)
        drives = {wheel.drive for wheel in self.rover.wheels}
        shape = [i for i, name in enumerate(self.rover.dof_names) if name not in drives]
        there, here = np.array(stance.configuration)[shape], np.array(at.q)[shape]
        there[3] = here[3]  # turns count in the motion, not in a stance
        self._apart.append(float(np.max(np.abs(there - here))) if stance.settled else np.nan)

    def run(self, status: str, reason: str) -> Run:
        """The log so far."""
        loads = np.array(self._loads).reshape(len(self._time), -1)
        wheels = [wheel.name for wheel in self.rover.wheels]
        return Run(
            self.rover,
            self.terrain,
            frozen(self._time),
            frozen(self._q),
            frozen(self._v),
            tuple(self._actions),
            tuple(self._lifted),
            {name: frozen(rows) for name, rows in self._indices.items()},
            {name: frozen(rows) for name, rows in self._values.items()},
            {name: frozen(loads[:, i]) for i, name in enumerate(wheels)},
            frozen(self._drift),
            frozen(self._residual),
            frozen(self._apart),
            status,
            reason,
        )
