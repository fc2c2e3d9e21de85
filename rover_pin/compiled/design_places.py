"""Turns and places of many designs: products by the elements, so that each design's bits are its own.

A place is a rotation (n, 3, 3) and an origin (n, 3) m; n may be one where all designs are alike.
"""

from __future__ import annotations

import math

import numpy as np

from rover_pin.compiled.design_rows import Row, Sheet
from rover_pin.description.trace import Ref
from rover_pin.numerics import Array

Place = tuple[Array, Array]

HERE: Place = (np.eye(3)[None], np.zeros((1, 3)))
"""No turn, no way; that very array is known by whoever multiplies, as long as no parameter decides on it."""


def turned(rotation: Array, vector: Array) -> Array:
    """(n, 3) R v."""
    if rotation is HERE[0]:
        return vector
    result: Array = (
        rotation[:, :, 0] * vector[:, 0:1]
        + rotation[:, :, 1] * vector[:, 1:2]
        + rotation[:, :, 2] * vector[:, 2:3]
    )
    return result


def product(first: Array, second: Array) -> Array:
    """(n, 3, 3) R1 R2."""
    if first is HERE[0] or second is HERE[0]:
        return second if first is HERE[0] else first
    result: Array = (
        first[:, :, 0:1] * second[:, 0:1, :]
        + first[:, :, 1:2] * second[:, 1:2, :]
        + first[:, :, 2:3] * second[:, 2:3, :]
    )
    return result


def moved(place: Place, point: Array) -> Array:
    """(n, 3) m, R p + t."""
    result: Array = turned(place[0], point) + place[1]
    return result


def behind(place: Place, next_place: Place) -> Place:
    """A place given in another."""
    return product(place[0], next_place[0]), moved(place, next_place[1])


def origin_of(sheet: Sheet, xyz: Row, rpy: Row) -> Place:
    """The place of a URDF's `<origin>`, R = Rz(yaw) Ry(pitch) Rx(roll), by a quaternion as urdfdom goes."""
    if not any(isinstance(entry, Ref) or entry != 0.0 for entry in rpy):
        return HERE[0], sheet.row(xyz)
    return turn_of(sheet, sheet.row(rpy)), sheet.row(xyz)


def turn_of(sheet: Sheet, rpy: Array) -> Array:
    """(n, 3, 3) R = Rz(yaw) Ry(pitch) Rx(roll) of (n, 3) rad."""
    half = rpy / 2.0
    (sr, sp, sy), (cr, cp, cy) = (
        [sheet.each(function, half[:, i]) for i in range(3)] for function in (math.sin, math.cos)
    )
    return from_quaternion(
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


def about(sheet: Sheet, axis: Array, angle: Array) -> Array:
    """(n, 3, 3) turn by an angle (n,) about a unit axis (n, 3)."""
    sine, cosine = (sheet.each(function, angle / 2.0) for function in (math.sin, math.cos))
    return from_quaternion(cosine, sine * axis[:, 0], sine * axis[:, 1], sine * axis[:, 2])


def from_quaternion(w: Array, x: Array, y: Array, z: Array) -> Array:
    """(n, 3, 3) rotation of a quaternion near unit length, (n,) each."""
    length = np.sqrt(x * x + y * y + z * z + w * w)
    w, x, y, z = w / length, x / length, y / length, z / length
    tx, ty, tz = 2.0 * x, 2.0 * y, 2.0 * z
    rotation = np.empty((len(length), 3, 3))
    rotation[:, 0, 0] = 1.0 - (ty * y + tz * z)
    rotation[:, 0, 1] = ty * x - tz * w
    rotation[:, 0, 2] = tz * x + ty * w
    rotation[:, 1, 0] = ty * x + tz * w
    rotation[:, 1, 1] = 1.0 - (tx * x + tz * z)
    rotation[:, 1, 2] = tz * y - tx * w
    rotation[:, 2, 0] = tz * x - ty * w
    rotation[:, 2, 1] = tz * y + tx * w
    rotation[:, 2, 2] = 1.0 - (tx * x + ty * y)
    return rotation


def across(axis: Array) -> Array:
    """(n, 3, 3) columns: two unit vectors across unit axes (n, 3), and those axes, as in loops and tracks."""
    helper = np.eye(3)[np.argmin(np.abs(axis), axis=1)]
    first = np.cross(axis, helper)
    first = first / norm(first)[:, None]
    return np.stack([first, np.cross(axis, first), axis], axis=2)


def norm(vector: Array) -> Array:
    """(n,) length."""
    result: Array = np.sqrt(vector[:, 0] ** 2 + vector[:, 1] ** 2 + vector[:, 2] ** 2)
    return result


def cross_norm(a: Array, b: Array) -> Array:
    """(n,) length of a x b."""
    return norm(
        np.stack(
            np.broadcast_arrays(
                a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1],
                a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2],
                a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0],
            ),
            axis=1,
        )
    )
