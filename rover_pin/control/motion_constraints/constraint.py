"""What a motion constraint is: a value with a name, a unit and a gradient, part by part."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from rover_pin.control.stations import Stations
from rover_pin.errors import InputError
from rover_pin.numerics import Array, frozen

if TYPE_CHECKING:
    from rover_pin.control.now import Now

Kind = Literal["set", "posture", "velocity", "load"]


@dataclass(frozen=True)
class Options:
    """What motion constraints may be told beside the rover's sides.

    Attributes:
        most_lifted: wheels that may be off the ground at once.
        wheelbase_divisor: m, or None for the distance front to second wheel at home.
        speed_floor: m/s; a slower commanded speed counts as this one, against 0/0 at standstill.
        yaw_floor: rad/s; the same of commanded yaw rates.
        loads_at: gives N by wheel for q (nv,), for the gradients of loads; None where nobody asks for them.
        load_step: rad or m by which the rockers are moved for those gradients.

    Raises:
        InputError: a number that is not finite and above 0.
    """

    most_lifted: int = 2
    wheelbase_divisor: float | None = None
    speed_floor: float = 1e-3
    yaw_floor: float = 1e-3
    loads_at: Callable[[Array], Mapping[str, float]] | None = None
    load_step: float = 1e-4

    def __post_init__(self) -> None:
        for word in ("wheelbase_divisor", "speed_floor", "yaw_floor", "load_step"):
            value = getattr(self, word)
            if value is not None and not (math.isfinite(value) and value > 0.0):
                raise InputError("must be a finite number above 0", element=word, value=value)
        if isinstance(self.most_lifted, bool) or self.most_lifted not in (0, 1, 2):
            raise InputError(
                "must be 0, 1 or 2 wheels, one a side at most", element="most_lifted", value=self.most_lifted
            )


class MotionConstraint(ABC):
    """A quantity of a moving rover that is to stay small.

    Args:
        stations: the rover's sides, shared by all its motion constraints.
        options: what each of them may be told.

    Attributes:
        name: the idea.
        number: motion constraint 1 to 11 of `hit_mrii.txt`.
        unit: of the value.
        kind: `posture`: a function of q. `velocity`: gradient v + offset. `load`: of wheels' loads. `set`: of
            which wheels are lifted; it is broken or not and takes no threshold.
        by_side: whether it has a part a side.
        parts: names of its parts: the sides, or one empty name.
    """

    name: ClassVar[str]
    number: ClassVar[int]
    unit: ClassVar[str]
    kind: ClassVar[Kind]
    by_side: ClassVar[bool] = False

    def __init__(self, stations: Stations, options: Options | None = None) -> None:
        self.stations = stations
        self.options = options or Options()
        self.parts: tuple[str, ...] = stations.parts if self.by_side else ("",)
        self._nothing = frozen(np.zeros(len(self.parts)))

    @abstractmethod
    def value(self, now: Now) -> Array:
        """(parts,) in its unit, signed where it has a sign; NaN where it does not apply."""

    @abstractmethod
    def gradient(self, now: Now) -> Array:
        """(parts, nv) d value / dq; of a velocity constraint d value / dv. Zeros where it does not apply."""

    def offset(self, now: Now) -> Array:
        """(parts,) of a velocity constraint: value = gradient v + offset. Not to be written to."""
        return self._nothing

    def __repr__(self) -> str:
        """Name and number."""
        return f"{type(self).__name__}({self.name}, motion constraint {self.number})"
