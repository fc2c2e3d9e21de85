"""The tree of many designs: where links sit on their joints' bodies; places, axes, limits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rover_pin.compiled.design_places import HERE, Place, about, behind, moved, origin_of
from rover_pin.compiled.design_plan import Branch, Plan
from rover_pin.compiled.design_rows import Sheet
from rover_pin.compiled.machine import FIRST_JOINT
from rover_pin.description.limits import LOCK, NO_LIMIT
from rover_pin.numerics import Array

BASE = FIRST_JOINT - 1
"""Pinocchio's id of the base."""


@dataclass(frozen=True)
class Joint:
    """A moving joint: its place at zero in its carrier's frame, unit axis and limits, (n, ...) each."""

    name: str
    carrier: int
    place: Place
    axis: Array
    sliding: bool
    lower: Array
    upper: Array


@dataclass(frozen=True)
class Seat:
    """A frame fixed to a joint's body: the joint's id, and the place in its frame."""

    joint: int
    place: Place


@dataclass(frozen=True)
class Walked:
    """The tree of many designs.

    Attributes:
        joints: by Pinocchio's id, without universe and base.
        seats: of links.
        behind: joint -> the link behind it.
        held: (n,) where joints are that their limits lock.
    """

    joints: Mapping[int, Joint]
    seats: Mapping[str, Seat]
    behind: Mapping[str, str]
    held: Mapping[str, Array]

    def seat(self, name: str) -> Seat | None:
        """Of a link's or joint's frame; None where there is none of that name."""
        found = self.seats.get(name)
        return self.seats.get(self.behind.get(name, "")) if found is None else found


def walk_tree(plan: Plan, sheet: Sheet) -> Walked:
    """Every link's seat and every joint; left out are designs that the loader refuses or builds otherwise."""
    seats = {plan.root: Seat(BASE, HERE)}
    joints: dict[int, Joint] = {}
    held: dict[str, Array] = {}
    for branch in plan.branches:
        above = seats[branch.parent]
        place = behind(above.place, origin_of(sheet, branch.xyz, branch.rpy))
        if branch.axis is None:
            seats[branch.child] = Seat(above.joint, place)
            continue
        axis = unit(sheet, sheet.row(branch.axis))
        lower, upper = _limits(branch, sheet)
        sheet.require(lower <= upper)
        with np.errstate(invalid="ignore"):
            sheet.require((upper - lower < LOCK) == (branch.joint == 0))
        if branch.joint == 0:
            held[branch.name] = (lower + upper) / 2
            seats[branch.child] = Seat(above.joint, _shifted(sheet, branch, place, axis, held[branch.name]))
            continue
        joints[branch.joint] = Joint(branch.name, above.joint, place, axis, branch.sliding, lower, upper)
        seats[branch.child] = Seat(branch.joint, HERE)
    return Walked(joints, seats, {b.name: b.child for b in plan.branches}, held)


def unit(sheet: Sheet, vector: Array) -> Array:
    """(n, 3) unit vectors; designs where one has no direction are left out."""
    length = sheet.each(math.hypot, vector[:, 0], vector[:, 1], vector[:, 2])
    sheet.require(length >= 1e-9)
    with np.errstate(all="ignore"):
        result: Array = vector / length[:, None]
    return result


def _limits(branch: Branch, sheet: Sheet) -> tuple[Array, Array]:
    """(n,) each, as `read_limits` takes them."""
    if branch.stops is None:
        return np.array([-np.inf]), np.array([np.inf])
    lower, upper = sheet.row(branch.stops.lower)[:, 0], sheet.row(branch.stops.upper)[:, 0]
    return np.where(lower <= -NO_LIMIT, -np.inf, lower), np.where(upper >= NO_LIMIT, np.inf, upper)


def _shifted(sheet: Sheet, branch: Branch, place: Place, axis: Array, value: Array) -> Place:
    """A joint's frame where its limits hold it."""
    if branch.sliding:
        return place[0], moved(place, axis * value[:, None])
    return behind(place, (about(sheet, axis, value), np.zeros((1, 3))))
