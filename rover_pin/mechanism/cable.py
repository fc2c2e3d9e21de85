"""A taut cable around circles of a plane: which of them it touches, its spans, its length.

The cable runs around the circles in their order, counter-clockwise, with every inside circle on its left and
every outside circle on its right, as short as that allows. With signed radii rho (negative outside) a span
from circle a to b obeys c_b - c_a = s t + (rho_b - rho_a) n, t its direction, n left of t, s its length; the
arc on a circle is rho times the angle that the cable turns there. A circle at which the cable would turn the
wrong way does not touch it: a wheel above its neighbours' chord leaves the cable. It touches a circle once at
most: one that its way back would touch too is cut there.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array, formula

Integers = NDArray[np.int64]

OFF = -1
"""`following` of a circle that the cable does not touch."""


@formula
def taut(places: Array, rho: Array, following: Integers, spans: Array, turns: Array) -> float:
    """Wrap the cable.

    Args:
        places: (k, 2) m, centres.
        rho: (k,) m, signed radii: negative where the circle is outside the cable.
        following: (k,) receives the circle that a span leads to, `OFF` where the cable does not touch.
        spans: (k, 3) receives the direction [-] and the length [m] of the span that leaves a circle.
        turns: (k,) receives the angle that the cable turns at a circle [rad].

    Returns:
        The cable's length [m]; NaN where an inside and an outside circle overlap, or no loop is found.
    """
    count = rho.shape[0]
    for i in range(count):
        following[i] = (i + 1) % count
    for _ in range(6 * count + 6):
        blocked = _span_all(places, rho, following, spans)
        if blocked >= 0:
            if not _swallow(places, rho, following, blocked):
                return math.nan
            continue
        wrong = _turn_all(rho, following, spans, turns)
        if wrong >= 0:
            _leave(following, wrong)
            continue
        if not _rejoin(places, rho, following, spans):
            return _length(rho, following, spans, turns)
    return math.nan


@formula
def pulls(following: Integers, spans: Array, forces: Array) -> None:
    """Force of a unit tension on each circle's centre, in the plane: out of it along both spans.

    Minus the derivative of the length by the centres: the arcs' terms cancel.

    Args:
        following: (k,) as of `taut`.
        spans: (k, 3) as of `taut`.
        forces: (k, 2) receives the forces.
    """
    for i in range(following.shape[0]):
        forces[i, 0] = forces[i, 1] = 0.0
    for i in range(following.shape[0]):
        j = following[i]
        if j != OFF:
            forces[i, 0] += spans[i, 0]
            forces[i, 1] += spans[i, 1]
            forces[j, 0] -= spans[i, 0]
            forces[j, 1] -= spans[i, 1]


@formula
def _span_all(places: Array, rho: Array, following: Integers, spans: Array) -> int:
    """Spans between circles that follow each other; a circle whose span does not exist, else -1."""
    for i in range(rho.shape[0]):
        j = following[i]
        if j == OFF:
            continue
        dx, dy = places[j, 0] - places[i, 0], places[j, 1] - places[i, 1]
        off = rho[j] - rho[i]
        apart = dx * dx + dy * dy
        square = apart - off * off
        if not square > 0.0:
            return i
        s = math.sqrt(square)
        spans[i, 0] = (s * dx + off * dy) / apart
        spans[i, 1] = (s * dy - off * dx) / apart
        spans[i, 2] = s
    return -1


@formula
def _swallow(places: Array, rho: Array, following: Integers, i: int) -> bool:
    """Take the lesser of two circles, one inside the other, off the cable; False where there is no cable."""
    j = following[i]
    if rho[i] * rho[j] < 0.0 or j == i:
        return False
    lesser = i if abs(rho[i]) < abs(rho[j]) else j
    if _on(following) <= 2:
        return False
    _leave(following, lesser)
    return True


@formula
def _on(following: Integers) -> int:
    """How many circles the cable touches."""
    count = 0
    for i in range(following.shape[0]):
        if following[i] != OFF:
            count += 1
    return count


@formula
def _leave(following: Integers, i: int) -> None:
    """Take circle i off the cable."""
    for j in range(following.shape[0]):
        if following[j] == i:
            following[j] = following[i]
    following[i] = OFF


@formula
def _turn_all(rho: Array, following: Integers, spans: Array, turns: Array) -> int:
    """Angles turned at the circles, 2 pi in all; the circle that turns most against its sense, else -1.

    An angle is known up to 2 pi only. Where the sum falls short, the inside circle that seems to turn most
    the wrong way turns more than half round instead.
    """
    total = 0.0
    touching = 0
    for i in range(rho.shape[0]):
        j = following[i]
        if j == OFF:
            turns[i] = 0.0
            continue
        touching += 1
    for i in range(rho.shape[0]):
        j = following[i]
        if j != OFF:
            across = spans[i, 0] * spans[j, 1] - spans[i, 1] * spans[j, 0]
            along = spans[i, 0] * spans[j, 0] + spans[i, 1] * spans[j, 1]
            turns[j] = math.atan2(across, along)
            total += turns[j]
    while total < math.pi:
        least = -1
        for i in range(rho.shape[0]):
            if following[i] != OFF and rho[i] > 0.0 and (least < 0 or turns[i] < turns[least]):
                least = i
        if least < 0:
            break
        turns[least] += 2.0 * math.pi
        total += 2.0 * math.pi
    wrong = -1
    if touching > 2:
        worst = 0.0
        for i in range(rho.shape[0]):
            if following[i] != OFF:
                against = turns[i] if rho[i] >= 0.0 else -turns[i]
                if against < worst:
                    wrong, worst = i, against
    return wrong


@formula
def _rejoin(places: Array, rho: Array, following: Integers, spans: Array) -> bool:
    """Put the circle that a span cuts deepest back on the cable; whether there was one."""
    deepest, before = -1, -1
    worst = 1e-12
    count = rho.shape[0]
    for i in range(count):
        if following[i] != OFF:
            continue
        a = (i - 1) % count
        while following[a] == OFF:
            a = (a - 1) % count
        dx, dy = places[i, 0] - places[a, 0], places[i, 1] - places[a, 1]
        along = spans[a, 0] * dx + spans[a, 1] * dy
        if not 0.0 < along < spans[a, 2]:
            continue
        over = spans[a, 0] * dy - spans[a, 1] * dx + rho[a] - rho[i]
        deep = -over if rho[i] >= 0.0 else over
        if deep > worst:
            deepest, before, worst = i, a, deep
    if deepest < 0:
        return False
    following[deepest] = following[before]
    following[before] = deepest
    return True


@formula
def _length(rho: Array, following: Integers, spans: Array, turns: Array) -> float:
    """Spans and arcs."""
    total = 0.0
    for i in range(rho.shape[0]):
        if following[i] != OFF:
            total += spans[i, 2] + rho[i] * turns[i]
    return total
