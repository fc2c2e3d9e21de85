"""Tracks: a closed cable of constant length around wheels and pulleys that share a plane."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag

from rover_pin.errors import SidecarError, nearest
from rover_pin.mechanism.bending import bend_cable
from rover_pin.mechanism.cable import OFF, pulls, taut
from rover_pin.mechanism.columns import add_pulls
from rover_pin.mechanism.frames import find_frame
from rover_pin.mechanism.kinematics import BASE, FIRST_JOINT, Kinematics, column_of
from rover_pin.numerics import Array, frozen

Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Side = Literal["inside", "outside"]

PARALLEL = 1e-6
"""rad, or m: how far circles may lean out of the track's plane as the joints move."""

POINTS_PER_TURN = 48


class Round(Protocol):
    """What a track needs of a wheel: where it sits on its carrier, and its size."""

    @property
    def joint(self) -> int:
        """Pinocchio's id of the joint whose body carries it."""

    @property
    def center(self) -> Array:
        """(3,) m, in that joint's frame."""

    @property
    def axis(self) -> Array:
        """(3,) unit, in that joint's frame."""

    @property
    def radius(self) -> float:
        """m."""


class WrapSpec(BaseModel):
    """A wheel of the track with another working radius or side: `{wheel: sprocket, radius: 0.07}`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    wheel: str
    radius: Positive | None = None
    side: Side = "inside"


class PulleySpec(BaseModel):
    """A circle that never meets the ground: `{frame: tensioner, radius: 0.03, side: outside}`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    frame: str
    center: tuple[Finite, Finite, Finite] = (0.0, 0.0, 0.0)
    axis: tuple[Finite, Finite, Finite] = (0.0, 1.0, 0.0)
    radius: Positive
    side: Side = "inside"


def _entry_kind(value: object) -> str:
    if isinstance(value, dict):
        return "<frame>" if "frame" in value else "<wheel>"
    if isinstance(value, WrapSpec):
        return "<wheel>"
    return "<frame>" if isinstance(value, PulleySpec) else "<name>"


Entry = Annotated[
    Annotated[str, Tag("<name>")]
    | Annotated[WrapSpec, Tag("<wheel>")]
    | Annotated[PulleySpec, Tag("<frame>")],
    Discriminator(_entry_kind),
]


@dataclass(frozen=True, eq=False)
class Circle:
    """A circle of a track, in the frame of the joint that carries it.

    Attributes:
        name: of the wheel, or of the pulley's frame.
        joint: Pinocchio's id.
        center: (3,) m, moved along the axis into the track's plane.
        rho: m, the radius; negative where the circle presses from outside.
        wheel: whether it is a wheel.
    """

    name: str
    joint: int
    center: Array
    rho: float
    wheel: bool


class TrackSpec(BaseModel):
    """`{name: left, wheels: [sprocket, idler, {wheel: w3, radius: 0.06}], length: 2.026}`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str
    wheels: Annotated[tuple[Entry, ...], Field(min_length=2)]
    length: Positive

    def resolve(self, at: Kinematics, wheels: Mapping[str, Round], *, file: object = None) -> Track:
        """The track around the model's wheels, as they stand at home.

        Args:
            at: kinematics at home.
            wheels: the rover's wheels by name.
            file: the sidecar.

        Raises:
            SidecarError: a wheel or frame that the model does not have; wheels that share no plane, are not
                in order around the loop, or of which one lies inside another.
        """
        element = f"tracks.{self.name}"
        found = [
            _find(spec, at, wheels, file, f"{element}.wheels[{i}]") for i, spec in enumerate(self.wheels)
        ]
        names = [circle.name for circle, _ in found]
        for name in names:
            if names.count(name) > 1:
                raise SidecarError("the wheel stands twice", file=file, element=element, value=name,
                                   cure="name every wheel once, in order around the loop")  # fmt: skip
        first, axis = found[0]
        axes = _plane(axis)
        plane = at.rotation(first.joint) @ axes
        circles = [_into_plane(at, circle, own, first, plane, file, element) for circle, own in found]
        places = np.array([at.point(circle.joint, circle.center) for circle in circles]) @ plane[:, :2]
        if _area(places) < 0.0:
            circles.reverse()
            axes = axes[:, [1, 0, 2]] * np.array([1.0, 1.0, -1.0])
        track = Track(self.name, tuple(circles), first.joint, frozen(axes), self.length)
        track._check(at, file, element)
        return track


@dataclass(frozen=True, eq=False)
class Track:
    """A cable of constant length: slack = length - shortest way around its circles >= 0, tension >= 0.

    The shortest way is `rover_pin.mechanism.cable.taut` in the track's plane; its derivative by a circle's
    centre is t_in - t_out, the arcs' terms cancel. The cable slides around its circles without friction.

    Attributes:
        name: as in the sidecar.
        circles: in counter-clockwise order as seen against the plane's axis.
        joint: Pinocchio's id of the joint whose body carries the plane.
        axes: (3, 3) columns u, v and the plane's axis in that joint's frame.
        length: m.
    """

    name: str
    circles: tuple[Circle, ...]
    joint: int
    axes: Array
    length: float

    @cached_property
    def _carriers(self) -> NDArray[np.int64]:
        return np.array([circle.joint for circle in self.circles])

    @cached_property
    def _ends(self) -> NDArray[np.int64]:
        return np.array([column_of(circle.joint) for circle in self.circles])

    @cached_property
    def _places(self) -> Array:
        return np.array([circle.center for circle in self.circles])

    @cached_property
    def _rho(self) -> Array:
        return np.array([circle.rho for circle in self.circles])

    def wrap(self, at: Kinematics) -> Wrap:
        """The taut way around the circles."""
        return at.once(self, lambda: self._wrap(at))

    def _wrap(self, at: Kinematics) -> Wrap:
        count = len(self.circles)
        rotations, origins = (found[self._carriers] for found in at.placements)
        centers = (rotations @ self._places[:, :, None])[:, :, 0] + origins
        plane = at.rotation(self.joint) @ self.axes
        rho = self._rho
        following, spans, turns = np.empty(count, dtype=np.int64), np.zeros((count, 3)), np.zeros(count)
        length = taut(centers @ plane[:, :2], rho, following, spans, turns)
        return Wrap(length, centers, plane, rho, following, spans, turns)

    @property
    def kind(self) -> str:
        """`tracks`."""
        return "tracks"

    @property
    def impossible(self) -> tuple[str, str]:
        """Shorter than its wrap, wherever the joints go."""
        return (
            "the track is shorter than its way around its wheels wherever the joints go",
            "give a longer track, or smaller or nearer wheels",
        )

    def slack(self, at: Kinematics) -> float:
        """Length less the shortest way around [m]; NaN where circles overlap so that there is none."""
        return self.length - self.wrap(at).length

    def slack_gradient(self, at: Kinematics) -> Array:
        """(nv,) its derivative: also the generalised force of a unit tension."""
        wrap, tree = self.wrap(at), at.columns
        total = np.zeros(at.model.nv)
        forces = np.zeros((len(self.circles), 2))
        pulls(wrap.following, wrap.spans, forces)
        add_pulls(
            tree.parent, tree.turn, tree.move, tree.ref, self._ends, wrap.centers,
            forces @ wrap.plane[:, :2].T, total,
        )  # fmt: skip
        return total

    def bend_slack(self, at: Kinematics, multiplier: float, out: Array) -> None:
        """Take multiplier times the second derivative of `slack` off `out` (nv, nv)."""
        wrap = self.wrap(at)
        tree = at.columns
        bend_cable(
            tree.parent, tree.turn, tree.move, tree.ref, self._ends, wrap.centers, wrap.plane, wrap.following,
            wrap.spans, multiplier, tree.scratch, out,
        )  # fmt: skip

    def path(self, at: Kinematics) -> Array:
        """(p, 3) m, world: the taut way around as a closed polygon, for drawing."""
        return self.wrap(at).path()

    def _check(self, at: Kinematics, file: object, element: str) -> None:
        """Refuse wheels that the cable cannot run around in this order.

        Raises:
            SidecarError: as `TrackSpec.resolve`.
        """
        wrap = self.wrap(at)
        for a, one in enumerate(self.circles):
            for b, other in enumerate(self.circles):
                apart = float(np.linalg.norm(wrap.centers[a] - wrap.centers[b]))
                same = one.rho * other.rho > 0.0
                if a != b and same and apart + abs(one.rho) <= abs(other.rho):
                    raise SidecarError(f"{one.name} is swallowed by {other.name}: it lies inside its circle",
                                       file=file, element=element, value=f"{apart:.4g} m apart",
                                       cure="check both radii and where they sit")  # fmt: skip
                if a < b and not same and apart <= abs(one.rho) + abs(other.rho):
                    raise SidecarError(f"{one.name} and {other.name} overlap, with the cable between them",
                                       file=file, element=element, value=f"{apart:.4g} m apart",
                                       cure="check both radii, and `side`")  # fmt: skip
        if not np.isfinite(wrap.length) or _crosses(wrap.centers @ wrap.plane[:, :2]):
            raise SidecarError("its wheels are not in order around the loop", file=file, element=element,
                               value=", ".join(c.name for c in self.circles),
                               cure="list them one after the other along the cable")  # fmt: skip


@dataclass(frozen=True, eq=False)
class Wrap:
    """The taut way around a track's circles.

    Attributes:
        length: m.
        centers: (k, 3) m, world.
        plane: (3, 3) columns u, v and the plane's axis, world.
        rho: (k,) m, signed radii.
        following: (k,) the circle that a span leads to, `cable.OFF` where the cable does not touch.
        spans: (k, 3) direction in the plane and length [m] of the span that leaves a circle.
        turns: (k,) rad, turned at a circle.
    """

    length: float
    centers: Array
    plane: Array
    rho: Array
    following: NDArray[np.int64]
    spans: Array
    turns: Array

    def path(self) -> Array:
        """(p, 3) m, world: a closed polygon."""
        start = int(np.flatnonzero(self.following != OFF)[0])
        points = []
        i = start
        while True:
            j = int(self.following[i])
            out = np.arctan2(self.spans[j, 1], self.spans[j, 0])
            steps = 2 + int(abs(self.turns[j]) / (2.0 * np.pi) * POINTS_PER_TURN)
            angles = np.linspace(out - self.turns[j], out, steps)
            right = np.column_stack([np.sin(angles), -np.cos(angles)])
            points.append(self.centers[j] + self.rho[j] * right @ self.plane[:, :2].T)
            i = j
            if i == start:
                break
        closed = np.vstack([*points, points[0][:1]])
        return frozen(closed)


def _find(
    spec: str | WrapSpec | PulleySpec, at: Kinematics, wheels: Mapping[str, Round], file: object, element: str
) -> tuple[Circle, Array]:
    """A circle as stated, and its axis in its joint's frame."""
    if isinstance(spec, PulleySpec):
        frame = find_frame(at.model, spec.frame, file=file, element=element)
        size = float(np.linalg.norm(spec.axis))
        if size < 1e-9:
            raise SidecarError("`axis` is zero", file=file, element=element, cure="give the pulley's axis")
        center = frozen(frame.placement.act(np.array(spec.center)))
        axis = frame.placement.rotation @ np.array(spec.axis) / size
        return Circle(
            spec.frame, int(frame.parentJoint), center, _signed(spec.radius, spec.side), False
        ), axis
    stated = WrapSpec(wheel=spec) if isinstance(spec, str) else spec
    if stated.wheel not in wheels:
        raise SidecarError("no wheel of that name", file=file, element=element, value=stated.wheel,
                           cure=nearest(stated.wheel, wheels))  # fmt: skip
    wheel = wheels[stated.wheel]
    rho = _signed(stated.radius or wheel.radius, stated.side)
    return Circle(stated.wheel, wheel.joint, wheel.center, rho, True), wheel.axis


def _signed(radius: float, side: Side) -> float:
    return radius if side == "inside" else -radius


def _plane(axis: Array) -> Array:
    """(3, 3) columns: two unit vectors across `axis`, counter-clockwise, and `axis`."""
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(axis, helper)
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(axis, first), axis])


def _into_plane(
    at: Kinematics, circle: Circle, axis: Array, first: Circle, plane: Array, file: object, element: str
) -> Circle:
    """The circle moved along its axis into the plane of the first one.

    Raises:
        SidecarError: the axes are not parallel, or the joints between turn or slide it out of the plane.
    """
    normal = plane[:, 2]
    world = at.rotation(circle.joint) @ axis
    if np.linalg.norm(np.cross(world, normal)) > PARALLEL:
        raise SidecarError(f"{circle.name} does not lie in the plane of {first.name}",
                           file=file, element=element,
                           value=f"axes {np.round(world, 4).tolist()} and {np.round(normal, 4).tolist()}",
                           cure="a track needs wheels with parallel axes")  # fmt: skip
    mover = _mover_out_of_plane(at, circle, first, normal)
    if mover is not None:
        raise SidecarError(f"a joint moves {circle.name} out of the plane of {first.name}", file=file,
                           element=element, value=mover,
                           cure="joints between a track's wheels must move in its plane")  # fmt: skip
    away = normal @ (at.point(circle.joint, circle.center) - at.point(first.joint, first.center))
    local = circle.center - away * (at.rotation(circle.joint).T @ normal)
    return Circle(circle.name, circle.joint, frozen(local), circle.rho, circle.wheel)


def _mover_out_of_plane(at: Kinematics, circle: Circle, first: Circle, normal: Array) -> str | None:
    """A joint that moves one of two circles, not both, and not in the plane; or None."""
    for column in range(BASE, at.model.nv):
        moved = [c for c in (circle, first) if at.joint_jacobian(c.joint)[:, column].any()]
        if len(moved) != 1:
            continue
        turning = at.joint_jacobian(moved[0].joint)[3:, column]
        sliding = at.point_jacobian(moved[0].joint, at.point(moved[0].joint, moved[0].center))[:, column]
        if np.linalg.norm(np.cross(turning, normal)) > PARALLEL or abs(sliding @ normal) > PARALLEL:
            return str(at.model.names[FIRST_JOINT + column - BASE])
    return None


def _crosses(places: Array) -> bool:
    """Whether two sides of a closed polygon cross each other."""
    following = np.roll(places, -1, axis=0)
    count = len(places)
    for i in range(count):
        for j in range(i + 2, count - (i == 0)):
            ends = [places[i], following[i], places[j], following[j]]
            if all(
                _area(np.array([*side, a])) * _area(np.array([*side, b])) < 0.0
                for side, a, b in ((ends[:2], *ends[2:]), (ends[2:], *ends[:2]))
            ):
                return True
    return False


def _area(places: Array) -> float:
    """Signed area of a polygon, positive counter-clockwise."""
    x, y = places.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
