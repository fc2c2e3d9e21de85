"""The table of motion constraints: every module here that holds a `CONSTRAINT`."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from rover_pin.control.layout import Layout
from rover_pin.control.motion_constraints.constraint import MotionConstraint, Options
from rover_pin.control.stations import Stations
from rover_pin.errors import InputError, nearest

if TYPE_CHECKING:
    from rover_pin.rover import Rover


def _found() -> Mapping[str, type[MotionConstraint]]:
    package = __name__.rpartition(".")[0]
    modules = (
        importlib.import_module(f"{package}.{info.name}")
        for info in pkgutil.iter_modules([str(Path(__file__).parent)])
        if f"{package}.{info.name}" != __name__
    )
    kinds = sorted((m.CONSTRAINT for m in modules if hasattr(m, "CONSTRAINT")), key=lambda kind: kind.number)
    return MappingProxyType({kind.name: kind for kind in kinds})


CONSTRAINTS: Mapping[str, type[MotionConstraint]] = _found()
"""Motion constraints by name, in the order of their numbers."""


def motion_constraints(
    rover: Rover, layout: Layout, names: Iterable[str] | None = None, options: Options | None = None
) -> dict[str, MotionConstraint]:
    """Motion constraints of a rover, by name; they share what they work out at an instant.

    Args:
        rover: whose.
        layout: its sides.
        names: which; all where silent.
        options: floors, divisors and the statics; the defaults where silent.

    Raises:
        InputError: an unknown motion constraint, or a layout that is not the rover's.
    """
    wanted = tuple(CONSTRAINTS) if names is None else tuple(names)
    for name in wanted:
        if name not in CONSTRAINTS:
            raise InputError("no motion constraint of that name", element=name, cure=nearest(name, CONSTRAINTS))
    stations = Stations(rover, layout)
    return {name: CONSTRAINTS[name](stations, options) for name in wanted}
