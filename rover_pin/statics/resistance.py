"""Motion resistance and the tractions against it: every loaded contact pulls with one share of its load.

A rover in slow steady motion along its heading h is held back by a force R at its centre of mass. Contact i
pulls with F_i = k N_i along the ground's tangent in its wheel's plane, k = R / sum N_i (t_i . h) (Ugenti,
Galati, Mantriota and Reina, Analysis of an all-terrain tracked robot, eqs. 8 to 10 as corrected).

Under a wheel of a track the ground pulls the cable: its tension rises by F_i past the contact, on the way to
the driven wheel. A roller without friction gets only what the spans and the ground leave at its centre; the
driven wheel, whose motor holds it, feels its spans where they touch. A wheel of no track is held by its
motor, so that its traction acts at the contact. Wheels marked `free` of no track, feet, and wheels that stand
clear of their cable's chord, where no track lies between them and the ground, pull nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

from rover_pin.contact import Wheel
from rover_pin.errors import InputError
from rover_pin.mechanism import Kinematics, Track
from rover_pin.mechanism.cable import OFF
from rover_pin.mechanism.track import Wrap
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.statics.problem import Integers


CLEAR = 1e-3
"""m: a wheel that is farther above its cable's chord does not press it to the ground."""


@dataclass(frozen=True)
class Span:
    """A straight piece of a track: unit pull along it on the circle it leaves, against it on the next."""

    leaves: int
    meets: int
    direction: Array


@dataclass(frozen=True)
class Resistance:
    """A motion resistance on a rover.

    Attributes:
        rover: what moves.
        force: N, against the heading.
        yaw: rad, the heading.
        ratio: k, tangential over vertical force of every contact that pulls.
    """

    rover: Rover
    force: float
    yaw: float
    ratio: float

    @property
    def heading(self) -> Array:
        """(3,) unit, world."""
        return np.array([np.cos(self.yaw), np.sin(self.yaw), 0.0])

    @property
    def sense(self) -> float:
        """1 where contacts push the rover on, -1 where they hold it back."""
        return 1.0 if self.force >= 0.0 else -1.0

    def drag(self, at: Kinematics) -> Array:
        """(nv,) generalised force of the resistance."""
        jacobian = pin.jacobianCenterOfMass(at.model, at.data, at.q)
        drag: Array = -self.force * (self.heading @ jacobian)
        return drag

    def tangents(self, at: Kinematics, owners: Integers, normals: Array) -> Array:
        """(c, 3) unit direction of each contact's traction, forwards; zero where it gives none."""
        found = np.zeros((len(owners), 3))
        for i, (owner, normal) in enumerate(zip(owners.tolist(), normals, strict=True)):
            shape = self.rover.shapes[owner]
            if not isinstance(shape, Wheel) or (shape.free and shape.name not in self._wrapped):
                continue
            if shape.name in self._wrapped and self._is_clear(at, shape.name):
                continue
            along = np.cross(at.rotation(shape.joint) @ shape.axis, normal)
            size = float(np.linalg.norm(along))
            if size > 1e-9:
                found[i] = along / size if along @ self.heading >= 0.0 else -along / size
        return found

    def _is_clear(self, at: Kinematics, wheel: str) -> bool:
        """Whether a wheel stands farther than `CLEAR` from the span of its cable that passes it."""
        track, circle = self._wrapped[wheel]
        wrap = track.wrap(at)
        if wrap.following[circle] != OFF:
            return False
        count = len(wrap.following)
        last = next(i for i in _round(circle, -1, count) if wrap.following[i] != OFF)
        away = (wrap.centers[circle] - wrap.centers[last]) @ wrap.plane[:, :2]
        u, v = wrap.spans[last, :2]
        over = float(u * away[1] - v * away[0] + wrap.rho[last] - wrap.rho[circle])
        return abs(over) > CLEAR

    def rows(self, at: Kinematics, owners: Integers, contacts: Array) -> Array:
        """(c, nv) generalised force of a unit traction at each contact, tracks' tensions included.

        Args:
            at: kinematics.
            owners: (c,) shape of each contact.
            contacts: (c, 7) gap, point, normal.
        """
        found = np.zeros((len(owners), at.model.nv))
        tangents = self.sense * self.tangents(at, owners, contacts[:, 4:7])
        for i, owner in enumerate(owners.tolist()):
            shape, tangent = self.rover.shapes[owner], tangents[i]
            if not tangent.any():
                continue
            wrapped = self._wrapped.get(shape.name)
            if wrapped is None:
                found[i] = tangent @ at.point_jacobian(shape.joint, contacts[i, 1:4])
                continue
            track, circle = wrapped
            center = at.point(shape.joint, track.circles[circle].center)
            found[i] = tangent @ at.point_jacobian(shape.joint, center)
            wrap = track.wrap(at)
            driven = self._driven[track.name]
            for span in tight_spans(wrap, circle, driven, tangent, contacts[i, 4:7]):
                for end, sign in ((span.leaves, 1.0), (span.meets, -1.0)):
                    joint = track.circles[end].joint
                    place = pulled_at(wrap, end, driven, span)
                    found[i] += sign * span.direction @ at.point_jacobian(joint, place)
        return found

    @cached_property
    def _wrapped(self) -> dict[str, tuple[Track, int]]:
        """The track and circle of each wheel that a track runs around."""
        return {
            circle.name: (track, i)
            for track in self.rover.tracks
            for i, circle in enumerate(track.circles)
            if circle.wheel
        }

    @cached_property
    def _driven(self) -> dict[str, int]:
        """The driven circle of each track.

        Raises:
            InputError: a track without one, or with several.
        """
        drives = {wheel.name: wheel.drive for wheel in self.rover.wheels}
        found = {}
        for track in self.rover.tracks:
            driven = [i for i, c in enumerate(track.circles) if drives.get(c.name) in self.rover.actuated]
            if len(driven) != 1:
                raise InputError(
                    f"a track overcomes a resistance by one driven wheel; this one has {len(driven)}",
                    file=self.rover.sidecar_path,
                    element=f"tracks.{track.name}",
                    value=", ".join(track.circles[i].name for i in driven) or "none",
                    cure="give one of its wheels a driven joint of its own",
                )
            found[track.name] = driven[0]
        return found

    def check(self) -> None:
        """Nothing where every track has its driven wheel.

        Raises:
            InputError: one that has none, or several.
        """
        _ = self._driven


def pulled_at(wrap: Wrap, circle: int, driven: int, span: Span) -> Array:
    """(3,) m: where a span acts on a circle: at the centre of a roller, where it touches the driven one."""
    if circle != driven:
        center: Array = wrap.centers[circle]
        return center
    right = np.cross(span.direction, wrap.plane[:, 2])
    place: Array = wrap.centers[circle] + wrap.rho[circle] * right
    return place


def tight_spans(wrap: Wrap, circle: int, driven: int, tangent: Array, normal: Array) -> list[Span]:
    """Spans whose tension a unit traction at a circle's contact raises: from there to the driven wheel.

    A wheel that the taut cable passes without a turn still presses it to the ground: its span is cut there.

    Args:
        wrap: the taut way around.
        circle: at whose contact the ground pulls.
        driven: the driven circle.
        tangent: (3,) direction of the ground's force on the cable.
        normal: (3,) of the ground.
    """
    if circle == driven:
        return []
    way = np.cross(wrap.plane[:, 2], -normal)  # of the cable past the contact
    forwards = bool(way @ tangent < 0.0)  # the ground pulls against the way: what follows is tight
    after = {a: int(b) for a, b in enumerate(wrap.following) if b != OFF}
    before = {b: a for a, b in after.items()}
    directions = {a: wrap.spans[a] for a in after}
    if circle not in after:
        last = next(a for a in _round(circle, -1, len(wrap.following)) if a in after)
        after[circle], before[circle], directions[circle] = after[last], last, wrap.spans[last]
    spans = []
    here = circle
    for _ in range(len(wrap.following)):
        leaves, meets = (here, after[here]) if forwards else (before[here], here)
        u, v = directions[leaves][:2]
        spans.append(Span(leaves, meets, u * wrap.plane[:, 0] + v * wrap.plane[:, 1]))
        here = meets if forwards else leaves
        if here == driven:
            break
    return spans


def _round(start: int, step: int, count: int) -> Iterator[int]:
    """Circles from `start` on, once around."""
    for k in range(count):
        yield (start + step * k) % count
