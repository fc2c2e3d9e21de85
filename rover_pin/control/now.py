"""What a motion constraint looks at: a rover at an instant, its velocity, what stands, what wheels carry."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.finite import not_finite
from rover_pin.kinematics.instant import Instant
from rover_pin.numerics import Array


@dataclass(frozen=True, eq=False)
class Now:
    """A rover in motion.

    Attributes:
        at: where it is.
        v: (nv,) dq/dt looked at; columns are named by `rover.dof_names`.
        nominal: (nv,) dq/dt commanded, before rockers move.
        lifted: wheels held off the ground.
        loads: N by wheel, or None where they are not known.
        locked: passive joints that an engaged clutch holds.

    Raises:
        InputError: a velocity of another shape, or a number that is not finite, named.
    """

    at: Instant
    v: Array
    nominal: Array
    lifted: tuple[str, ...] = ()
    loads: Mapping[str, float] | None = None
    locked: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        names = self.at.rover.dof_names
        for word in ("v", "nominal"):
            rates = np.asarray(getattr(self, word), dtype=np.float64)
            if rates.shape != (len(names),):
                raise InputError(
                    "a velocity has one entry a degree of freedom",
                    element=word,
                    value=rates.shape,
                    cure=f"give shape ({len(names)},)",
                )
            bad = not_finite(rates)
            if bad is not None:
                raise InputError(
                    "is no finite number", element=f"{word} of {names[bad]}", value=float(rates[bad])
                )
            object.__setattr__(self, word, rates)
        for wheel, load in (self.loads or {}).items():
            if not math.isfinite(load):
                raise InputError("is no finite number", element=f"load of {wheel}", value=load)
        object.__setattr__(self, "lifted", tuple(self.lifted))
        object.__setattr__(self, "locked", tuple(self.locked))
