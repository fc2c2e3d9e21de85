"""From place to place, closer where something changes at once: edges, ends of stances, where it stops."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from rover_pin.analysis.traverse.follow import Follower
from rover_pin.analysis.traverse.leap import checked
from rover_pin.analysis.traverse.path import Place
from rover_pin.analysis.traverse.step import Step, ask
from rover_pin.statics.stance import Status

Progress = Callable[[int, int], None]
"""Called with the number of places passed and of all."""

TURNED = 0.2
"""rad: a contact's normal that turns further between two places is looked at more closely."""

JUMPED = 0.01
"""Of a wheel's radius: ground further from where the normals before and after lead has jumped between."""

DEPTH = 12
"""Halvings of a step where something changes at once."""

NOT_FOUND = str(Status.NO_CONVERGENCE)

MIDDLES = (0.5, 0.35)
"""Where to look between two places, one after the other until there is a stance."""

ASIDE = (0.1, 0.3)
"""Where else to ask if a place has no answer, as shares of the way back to the one before."""


def driven(
    follower: Follower, along: list[Place], friction: float | None, progress: Progress | None = None
) -> Iterator[Step]:
    """Steps along places, closer where something changes at once."""
    last: Step | None = None
    for done, place in enumerate(along):
        if progress is not None:
            progress(done, len(along))
        if last is None:
            steps = iter([ask(follower.at(place, None), friction)])
        else:
            steps = _onto(follower, last, place, friction)
        for one in steps:
            last = one if last is None else checked(last, one)
            yield last
    if progress is not None:
        progress(len(along), len(along))


def _onto(follower: Follower, last: Step, place: Place, friction: float | None) -> Iterator[Step]:
    """From one place of the path to the next, and what lies between where the two differ much."""
    there = ask(follower.at(place, last.stood), friction)
    if there.limit == NOT_FOUND:
        there = _beside(follower, last, there, friction)
    between = list(_between(follower, last, there, friction, DEPTH))
    yield from between
    if between:  # by small steps it may come there otherwise than at once
        again = ask(follower.at(there.stood.place, between[-1].stood), friction)
        there = there if again.limit == NOT_FOUND else again
    yield there


def _between(follower: Follower, a: Step, b: Step, friction: float | None, depth: int) -> Iterator[Step]:
    """Halves of halves where something changes at once, as far as there are stances between."""
    if not depth or NOT_FOUND in (a.limit, b.limit) or not _differ(a, b):
        return
    middle = _middle(follower, a, b, friction)
    if middle is None:
        return
    yield from _between(follower, a, middle, friction, depth - 1)
    yield middle
    yield from _between(follower, middle, b, friction, depth - 1)


def _middle(follower: Follower, a: Step, b: Step, friction: float | None) -> Step | None:
    """Between two places, followed from the first, else from the other; None if it is found from neither."""
    for share in MIDDLES:
        place = b.stood.place.towards(a.stood.place, share)
        for start in (a, b):
            if start is b and b.stood.footing is None:
                continue
            middle = ask(follower.at(place, start.stood), friction)
            if middle.limit != NOT_FOUND:
                return middle
    return None


def _beside(follower: Follower, last: Step, failed: Step, friction: float | None) -> Step:
    """A place a little before one that has no answer, where that has one."""
    for share in ASIDE:
        place = failed.stood.place.towards(last.stood.place, share)
        there = ask(follower.at(place, last.stood), friction)
        if there.limit != NOT_FOUND:
            return there
    return failed


def _differ(a: Step, b: Step) -> bool:
    """Whether something changed at once: a contact, the stance's existence, or from passing to what stops it.

    Where it has stopped by friction or torque and passes again nothing but contacts counts.
    """
    one, other = _contacts(a), _contacts(b)
    if a.limit != b.limit and (a.passes or not (one and other)):
        return True
    if not one or not other:
        return False
    return any(
        _apart(one.get(shape.name), other.get(shape.name), shape) for shape in a.stood.stance.rover.shapes
    )


def _contacts(step: Step) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    for contact in step.stood.stance.contacts:
        found.setdefault(contact.wheel, []).append(contact)
    return found


def _apart(one: list[Any] | None, other: list[Any] | None, shape: Any) -> bool:
    """Whether a wheel lifts or lands, a normal has none near it on the other side, or the ground jumps."""
    if one is None or other is None:
        return one is not other
    before, after = (np.array([contact.normal for contact in side]) for side in (one, other))
    cosines = before @ after.T
    if min(cosines.max(axis=0).min(), cosines.max(axis=1).min()) < math.cos(TURNED):
        return True
    if len(one) > 1 or len(other) > 1:
        return False
    chord = np.asarray(other[0].point) - np.asarray(one[0].point)
    # along any arc, the ground's or the wheel's, the chord is square to the mean normal
    return abs(0.5 * float(chord @ (before[0] + after[0]))) > JUMPED * float(shape.ring + shape.tread)


def unresolved(steps: Sequence[Step], length: float) -> float:
    """The longest way [m] over which something changes at once and no stance was found between; 0 where none.

    Friction or torque may be higher there than at both its ends.
    """
    finest = 1.01 * length / 2**DEPTH
    gaps = [b.stood.place.way - a.stood.place.way for a, b in pairwise(steps) if _differ(a, b)]
    return max((gap for gap in gaps if gap > finest), default=0.0)
