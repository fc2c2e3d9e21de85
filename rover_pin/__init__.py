"""Rovers with suspensions URDF cannot describe: how they stand, what wheels carry, how near they tip.

Names load on first use, so that `import rover_pin` is quick.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rover_pin import analysis as analysis
    from rover_pin import control as control
    from rover_pin import errors as errors
    from rover_pin import kinematics as kinematics
    from rover_pin import simulation as simulation
    from rover_pin import viz as viz
    from rover_pin.description.catalogue import robots as robots
    from rover_pin.loader import load as load
    from rover_pin.rover import Rover as Rover
    from rover_pin.stability.report import stability as stability  # the room is callable
    from rover_pin.statics.bounds import load_bounds as load_bounds
    from rover_pin.statics.distribute import distribute as distribute
    from rover_pin.statics.settle import settle as settle
    from rover_pin.statics.stance import Stance as Stance
    from rover_pin.statics.stance import Status as Status
    from rover_pin.terrain import Terrain as Terrain

__version__ = "0.1.0"

_HOME = {
    "Rover": "rover",
    "Stance": "statics.stance",
    "Status": "statics.stance",
    "Terrain": "terrain",
    "distribute": "statics.distribute",
    "load": "loader",
    "load_bounds": "statics.bounds",
    "robots": "description.catalogue",
    "settle": "statics.settle",
}
_ROOMS = ("analysis", "control", "errors", "kinematics", "simulation", "stability", "viz")

__all__ = sorted([*_HOME, *_ROOMS])


def __getattr__(name: str) -> object:
    """Load the module that holds `name`."""
    if name in _HOME:
        value = getattr(importlib.import_module(f"rover_pin.{_HOME[name]}"), name)
        globals()[name] = value
        return value
    if name in _ROOMS:
        return importlib.import_module(f"rover_pin.{name}")
    raise AttributeError(f"module 'rover_pin' has no attribute {name!r}")


def __dir__() -> list[str]:
    """The public names."""
    return sorted(__all__)
