"""The measures of a stance."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rover_pin.errors import InputError, nearest
from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing
from rover_pin.stability.registry import MEASURES
from rover_pin.statics.friction_problem import require_settled
from rover_pin.statics.stance import Stance

if TYPE_CHECKING:
    from rover_pin.rover import Rover


def stability(
    stance: Stance, measures: Iterable[str] | None = None, friction: float | None = None
) -> dict[str, Margin]:
    """Every measure of a settled stance, every edge of each, and the one that limits.

    A measure that the rover cannot have (clearance without belly points) is left out; `inapplicable` says
    which and why. A measure that has no answer is there and fails closed, with a note.

    Args:
        stance: a settled stance.
        measures: names; None takes all there are.
        friction: coefficient at every contact, for the measures that look at friction; None takes what each
            declares.

    Raises:
        InputError: the stance is not settled, a measure is unknown, or the friction is not above 0.
    """
    require_settled(stance)
    standing = Standing(stance, friction)
    return {m.name: m.evaluate(standing) for m in chosen(measures) if not m.missing(stance.rover)}


def chosen(measures: Iterable[str] | None = None) -> list[Measure]:
    """Measures by name; None takes all.

    Raises:
        InputError: there is no such measure.
    """
    if measures is None:
        return list(MEASURES.values())
    names = [measures] if isinstance(measures, str) else list(measures)
    for name in names:
        if name not in MEASURES:
            raise InputError(
                "no such measure", element="measures", value=name, cure=nearest(str(name), MEASURES)
            )
    return [MEASURES[name] for name in names]


def inapplicable(rover: Rover, measures: Iterable[str] | None = None) -> dict[str, str]:
    """The measures this rover cannot have, and why."""
    return {m.name: why for m in chosen(measures) if (why := m.missing(rover))}
