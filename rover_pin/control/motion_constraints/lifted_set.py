"""Which wheels may be off the ground together."""

from __future__ import annotations

from collections.abc import Collection
from itertools import product

import numpy as np

from rover_pin.control.layout import Layout
from rover_pin.control.motion_constraints.constraint import MotionConstraint
from rover_pin.control.now import Now
from rover_pin.errors import InputError
from rover_pin.numerics import Array

RULES = ("too many wheels", "a front with a rear wheel", "two wheels of one side")


def broken_rules(layout: Layout, lifted: Collection[str], most: int = 2) -> tuple[str, ...]:
    """Which of `RULES` a set of lifted wheels breaks, in words.

    At most `most` wheels, no front with a rear wheel, at most one a side: the three rules of motion
    constraint 1 of `hit_mrii.txt`. The first wheel of a side is its front, the last one its rear wheel.

    Raises:
        InputError: a wheel that the layout does not have.
    """
    away = set(lifted)
    rows = [layout.row_of(wheel) for wheel in away]
    last = len(layout.left.wheels) - 1
    broken = (
        len(away) > most,
        0 in rows and last in rows,
        any(len(away & set(side.wheels)) > 1 for side in layout.sides),
    )
    return tuple(rule for rule, is_broken in zip(RULES, broken, strict=True) if is_broken)


def admissible_sets(layout: Layout, most: int = 2) -> tuple[frozenset[str], ...]:
    """Every set of wheels that may be lifted, the empty one first, then single wheels, then pairs.

    Three wheels a side have 14: none, 6 singles, 3 symmetric and 4 asymmetric pairs; two a side have 7.
    """
    choices = product((None, *layout.left.wheels), (None, *layout.right.wheels))
    sets = [frozenset(wheel for wheel in pair if wheel is not None) for pair in choices]
    return tuple(sorted((s for s in sets if not broken_rules(layout, s, most)), key=len))


class LiftedSet(MotionConstraint):
    """How many rules the lifted wheels break (motion constraint 1): 0 where their set is admissible."""

    name = "lifted_set"
    number = 1
    unit = "1"
    kind = "set"

    def value(self, now: Now) -> Array:
        """(1,) rules broken.

        Raises:
            InputError: a lifted wheel that the layout does not have.
        """
        broken = broken_rules(self.stations.layout, now.lifted, self.options.most_lifted)
        return np.array([float(len(broken))])

    def gradient(self, now: Now) -> Array:
        """(1, nv) zeros: lifting is decided, not moved through."""
        return np.zeros((1, self.stations.rover.model.nv))

    def require(self, lifted: Collection[str]) -> None:
        """Refuse a set that is not admissible.

        Raises:
            InputError: the rules it breaks.
        """
        broken = broken_rules(self.stations.layout, lifted, self.options.most_lifted)
        if broken:
            raise InputError(
                f"may not be lifted together: {', '.join(broken)}",
                element="lifted wheels",
                value=", ".join(sorted(lifted)),
                cure=f"lift at most {self.options.most_lifted}, one a side, no front with a rear wheel",
            )


CONSTRAINT = LiftedSet
