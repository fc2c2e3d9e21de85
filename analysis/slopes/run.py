"""slopes: the slope at tip and at slip, heading by heading."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.slopes.result import as_dataset
from rover_pin.analysis.slopes.tilt_table import TiltTable
from rover_pin.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.rover import Rover

Progress = Callable[[int, int], None]
"""Called with the number of headings finished and of all."""

MOST = 3600
"""The most headings."""


def slopes(
    rover: Rover,
    headings: int = 24,
    *,
    friction: float | None = None,
    posture: str | Mapping[str, float] | None = None,
    joints: Mapping[str, float] | None = None,
    locks: Iterable[str] = (),
    gravity: float = 9.81,
    progress: Progress | None = None,
) -> xr.Dataset:
    """The slope at which a rover on a plane tips, and at which it slips, against its heading.

    A board is tilted under the rover, wheels braked; the heading is counted in the board from straight
    uphill, counterclockwise from above. It tips at the least slope without a stance (`rover_pin.settle`), so
    suspensions, stops and the belly count. It slips at the least slope at which no forces within friction
    hold it (`slack` below 0, exact cones), free wheels and passive joints counted. Slopes are looked at in
    steps of 4 deg: a gap between stances narrower than that may be passed over.

    Args:
        rover: what stands.
        headings: how many, evenly over the circle, the first straight uphill.
        friction: coefficient at every contact; None takes what each shape declares.
        posture: as for `rover_pin.settle`.
        joints: likewise.
        locks: likewise.
        gravity: m/s2.
        progress: called with finished and all headings.

    Returns:
        Dimension heading_rad; `tip_rad`, `slip_rad`, `stands_to_rad` (the lesser), `tip_limiting` (wheel,
        joint or link), `tip_status`, `slip_limiting` (contact). `slip_rad` is NaN where the rover tips first;
        all are where it does not stand on level ground. `tip_open_rad` and `slip_open_rad` say
        how much steeper it might be: 1e-8, more where the solver found neither a stance nor its end.

    Raises:
        InputError: a number, posture, joint or lock that cannot be used.

    Cost: 0.4 to 2.5 s a heading, about 45 stances; half a minute for a rover on tracks.
    """
    if isinstance(headings, bool) or not isinstance(headings, int | np.integer) or not 1 <= headings <= MOST:
        raise InputError(f"must be a whole number from 1 to {MOST}", element="headings", value=headings)
    _check_friction(friction)
    how: dict[str, Any] = {"posture": posture, "joints": joints, "locks": tuple(locks), "gravity": gravity}
    found = []
    if progress is not None:
        progress(0, headings)
    for k in range(headings):
        found.append(TiltTable(rover, math.tau * k / headings, friction, how).limits())
        if progress is not None:
            progress(k + 1, headings)
    return as_dataset(rover, found, friction, how)


def _check_friction(friction: object) -> None:
    number = isinstance(friction, int | float | np.floating | np.integer) and not isinstance(friction, bool)
    if friction is not None and not (number and math.isfinite(friction) and friction > 0):  # type: ignore[arg-type, operator]
        cure = "give a number above 0, like 0.6"
        raise InputError("not a coefficient of friction", element="friction", value=friction, cure=cure)
