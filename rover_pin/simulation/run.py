"""What a run leaves behind: times, configurations, what was done, what was measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain


@dataclass(frozen=True)
class Run:
    """A motion as it was logged, n samples; nothing in it changes.

    Attributes:
        rover: what moved.
        terrain: on what.
        time: (n,) s.
        configuration: (n, nv) q; columns are named by `rover.dof_names`.
        rates: (n, nv) dq/dt that led on from there; zeros in the last row.
        actions: (n,) what was being done.
        lifted: (n,) names of the wheels held off the ground.
        indices: per motion constraint (n, parts): its index, 1 at its limit; NaN where it was not evaluated.
        values: the same in its own unit.
        loads: per wheel (n,) N; NaN where the rover does not stand.
        drift: (n, wheels) m: how far each wheel slid since the start, from places, not from rows.
        residual: (n,) largest residual of the statics; NaN where the rover does not stand.
        apart: (n,) largest difference [m or rad] between where the motion has the rover and where the statics
            set it down, drives aside; NaN where it does not stand.
        status: `done`, or why it ended before its end.
        reason: in words, where it did.
    """

    rover: Rover
    terrain: Terrain
    time: Array
    configuration: Array
    rates: Array
    actions: tuple[str, ...]
    lifted: tuple[tuple[str, ...], ...]
    indices: Mapping[str, Array] = field(default_factory=dict)
    values: Mapping[str, Array] = field(default_factory=dict)
    loads: Mapping[str, Array] = field(default_factory=dict)
    drift: Array | None = None
    residual: Array | None = None
    apart: Array | None = None
    status: str = "done"
    reason: str = ""
