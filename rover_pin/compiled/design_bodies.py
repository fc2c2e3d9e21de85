"""Masses, first moments and outlines of many designs."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from rover_pin.compiled.design_places import behind, moved, origin_of
from rover_pin.compiled.design_plan import Plan
from rover_pin.compiled.design_rows import Sheet
from rover_pin.compiled.design_tree import Walked
from rover_pin.compiled.machine import Integers, integers, outline_of
from rover_pin.description.geometry import corners_around
from rover_pin.description.recipe import Payload, seat
from rover_pin.numerics import Array


def weigh(
    plan: Plan, walked: Walked, payload: Sequence[Payload], root: str, joints: int, sheet: Sheet
) -> tuple[Array, Array]:
    """(n, j) kg and (n, j, 3) kg m of what is fixed to each joint.

    Args:
        plan: the tree's links.
        walked: where they sit.
        payload: masses at places in the frame of `root`, or at the origins of links.
        root: the URDF's root link.
        joints: j.
        sheet: told of designs that the loader would refuse for their masses.
    """
    masses = np.zeros((sheet.values.count, joints))
    moments = np.zeros((sheet.values.count, joints, 3))
    total = np.zeros(1)
    for name, link in plan.links.items():
        mass, under = sheet.row(link.mass), walked.seats[name]
        sheet.require(mass[:, 0] >= 0.0)
        total = total + mass[:, 0]
        masses[:, under.joint] += mass[:, 0]
        moments[:, under.joint] += mass * moved(under.place, sheet.row(link.center))
    sheet.require(total > 0.0)
    for kg, place in payload:
        carrier, point = seat(place, root)
        under = walked.seats[carrier]
        masses[:, under.joint] += kg
        moments[:, under.joint] += kg * moved(under.place, np.array([point]))
    return masses, moments


def outline(
    plan: Plan,
    walked: Walked,
    without: Collection[str],
    belly: tuple[Integers, Array],
    sheet: Sheet,
) -> tuple[Integers, Array]:
    """(o,) joints and (n, o, 3) corners of the boxes around belly points and collision shapes.

    Args:
        plan: the tree's links.
        walked: where they sit.
        without: links whose shapes are wheels.
        belly: joints (b,) and points (n, b, 3).
        sheet: fills in.
    """
    joints: list[int] = []
    points: list[Array] = []
    for name, link in plan.links.items():
        if name in without:
            continue
        for shape in link.shapes:
            seat = walked.seats[name]
            place = behind(seat.place, origin_of(sheet, shape.xyz, shape.rpy))
            corners = corners_around(shape.kind, sheet.row(shape.size))
            joints += [seat.joint] * corners.shape[1]
            points += [moved(place, corners[:, i]) for i in range(corners.shape[1])]
    own, around = belly[1], sheet.stack(points, 3)
    return outline_of(np.concatenate([belly[0], integers(joints)]), np.concatenate([own, around], axis=1))
