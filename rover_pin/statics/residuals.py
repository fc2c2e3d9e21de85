"""Residuals of a stance, recomputed from the model by other means than the solver's.

Shared with the solver: Pinocchio, and the terrain's surface. Not shared: the contact search (here the
distance of a point to a circle, in closed form, and a dense look at the ring), the rows (frame Jacobians of
the wheels' links and the centre of mass), the reduction (all couplings are checked on q itself).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio as pin

from rover_pin.contact.place import SEGMENT
from rover_pin.mechanism import Bilateral, Kinematics
from rover_pin.numerics import Array, cross
from rover_pin.statics.resistance import Resistance
from rover_pin.statics.stance import Contact
from rover_pin.terrain.surface import LINEAR

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain

_TURNS = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
_MOST_PLACES = 40_000
_SHARES = np.linspace(-1.0, 1.0, len(_TURNS))
_LEVEL = 0.1  # height over the centre, as a share of the ring, up to which a ring is looked at
_AXES = np.eye(3)
_COSINES, _SINES = np.cos(_TURNS), np.sin(_TURNS)


def equilibrium(
    rover: Rover,
    at: Kinematics,
    free: Array,
    contacts: Sequence[Contact],
    internal: Array,
    gravity: float,
    resistance: Resistance | None = None,
) -> float:
    """Largest unbalanced generalised force: forces over weight, moments over weight times the wheels' span.

    Args:
        rover: the rover.
        at: kinematics at the stance.
        free: (nv, n) directions in which it may move.
        contacts: with their loads.
        internal: (nv,) generalised force of stops, tracks and loops.
        gravity: m/s2.
        resistance: that contacts pull against, or None.
    """
    model: Any = rover.model
    data, q = at.data, at.q
    weight = rover.mass * gravity
    total = -weight * pin.jacobianCenterOfMass(model, data, q)[2] + internal
    for contact in contacts:
        local = at.rotation(contact.joint).T @ (contact.point - at.origin(contact.joint))
        place = pin.SE3(np.eye(3), local)
        jacobian = pin.getFrameJacobian(model, data, contact.joint, place, pin.LOCAL_WORLD_ALIGNED)
        total = total + contact.load * jacobian[2]
    for spring in rover.springs:
        total = total + spring.force(at)
    if resistance is not None:
        total = total + _pulling(rover, at, contacts, resistance)
    unbalanced = free.T @ total
    turns = np.array(rover.turning)[np.argmax(np.abs(free), axis=0)]
    scale = weight * np.where(turns, max(rover.wheel_span, 1e-3), 1.0)
    return float(np.max(np.abs(unbalanced) / scale, initial=0.0))


def _pulling(rover: Rover, at: Kinematics, contacts: Sequence[Contact], resistance: Resistance) -> Array:
    """(nv,) of the resistance, the tractions and what they add to the tracks' tensions."""
    place = {shape.name: i for i, shape in enumerate(rover.shapes)}
    owners = np.array([place[contact.wheel] for contact in contacts], dtype=np.int64)
    touching = np.array([[contact.gap, *contact.point, *contact.normal] for contact in contacts])
    loads = np.array([contact.load for contact in contacts])
    total: Array = resistance.drag(at) + resistance.ratio * (loads @ resistance.rows(at, owners, touching))
    return total


def gap(rover: Rover, at: Kinematics, terrain: Terrain, contacts: Sequence[Contact]) -> float:
    """Largest violation of the contact conditions [m].

    Of every contact: its point's height over the surface and its distance to the wheel's skin (distance to
    the circle minus the tread, in closed form). Of every wheel: how deep 48 points of its skin lie below the
    surface, each where the tread's ball looks straight at the ground; on a bilinear map, whose nodes can
    stand up between those, also how deep its nodes and the places halfway between lie in the tread.
    """
    worst = 0.0
    centers = np.array([at.point(shape.joint, shape.center) for shape in rover.shapes])
    axes = np.array([at.rotation(shape.joint) @ shape.axis for shape in rover.shapes])
    place = {shape.name: i for i, shape in enumerate(rover.shapes)}
    points = np.array([contact.point for contact in contacts]).reshape(-1, 3)
    off_surface = np.abs(terrain.height(points[:, 0], points[:, 1]) - points[:, 2])
    for contact, on_surface in zip(contacts, off_surface.tolist(), strict=True):
        i = place[contact.wheel]
        shape = rover.shapes[i]
        apart = contact.point - centers[i]
        line = _to_segment if shape.form == SEGMENT else _to_ring
        skin = line(apart, axes[i], shape.ring) - shape.tread
        worst = max(worst, on_surface, abs(skin))
    worst = max(worst, _deepest(rover, centers, axes, terrain))
    if terrain.kind == LINEAR:
        worst = max(worst, _swallowed(rover, centers, axes, terrain))
    return worst


def closure(rover: Rover, at: Kinematics) -> float:
    """Largest violation of loops and couplings [m or rad]."""
    elements: list[Bilateral] = [*rover.loops, *rover.couplings]
    parts = [np.abs(element.residual(at)) for element in elements]
    return float(np.max(np.concatenate(parts))) if parts else 0.0


def complementarity(
    contacts: Sequence[Contact], gaps: Mapping[str, float], slack: Array, multipliers: Array, weight: float
) -> float:
    """Largest multiplier times slack over the weight [m or rad], negative load over it, or open penetration.

    Args:
        contacts: with their loads.
        gaps: per wheel, m.
        slack: (m,) of all one-sided rows: contacts, stops, springs' stops, tracks.
        multipliers: (m,) their loads, forces and torques.
        weight: N.
    """
    products = [abs(contact.load * contact.gap) / weight for contact in contacts]
    negative = [max(-contact.load, 0.0) / weight for contact in contacts]
    open_gaps = [max(-gap, 0.0) for gap in gaps.values()]
    rows = np.max(np.abs(slack * multipliers) / weight, initial=0.0)
    return float(max([0.0, float(rows), *products, *negative, *open_gaps]))


def _deepest(rover: Rover, centers: Array, axes: Array, terrain: Terrain) -> float:
    """How deep the skin of the shapes' lower halves lies in the ground at worst [m], 0 where nowhere."""
    forms = np.array([shape.form for shape in rover.shapes])[:, None, None]
    sizes = np.array([shape.ring for shape in rover.shapes])[:, None, None]
    along = np.where(forms == SEGMENT, _SHARES[:, None] * axes[:, None, :], _circles(axes))
    lower = (forms[:, :, 0] == SEGMENT) | (along[..., 2] < _LEVEL)
    balls = (centers[:, None, :] + sizes * along)[lower]
    treads = np.repeat([shape.tread for shape in rover.shapes], np.count_nonzero(lower, axis=1))
    slope = terrain.gradient(balls[:, 0], balls[:, 1])
    steep = np.sqrt(1.0 + np.sum(slope**2, axis=1))
    x, y = (balls[:, :2] + slope * (treads / steep)[:, None]).T
    z = balls[:, 2] - treads / steep
    deep = (terrain.height(x, y) - z) / steep
    return float(np.max(deep, initial=0.0))


def _swallowed(rover: Rover, centers: Array, axes: Array, terrain: Terrain) -> float:
    """How deep nodes of a bilinear map, and places halfway between, lie in a tread [m]; 0 where none does."""
    forms = np.array([shape.form for shape in rover.shapes])
    sizes = np.array([shape.ring for shape in rover.shapes])
    treads = np.array([shape.tread for shape in rover.shapes])
    pitch, origin = 0.5 * terrain.spacing, terrain.params[2:4]
    level = axes[:, :2]
    share = np.where(forms[:, None] == SEGMENT, np.abs(level), np.sqrt(np.maximum(1.0 - level**2, 0.0)))
    reach = sizes[:, None] * share + treads[:, None]
    first = np.ceil((centers[:, :2] - reach - origin) / pitch)
    counts = np.max(np.floor((centers[:, :2] + reach - origin) / pitch) - first, axis=0) + 1.0
    if np.prod(counts) > _MOST_PLACES:
        return 0.0
    x, y = (origin[k] + pitch * (first[:, k, None] + np.arange(counts[k])) for k in (0, 1))
    places = np.empty((len(centers), y.shape[1], x.shape[1], 3))
    places[..., 0], places[..., 1] = x[:, None, :], y[:, :, None]
    places[..., 2] = terrain.height(places[..., 0], places[..., 1])
    away = places - centers[:, None, None, :]
    along = np.einsum("sijk,sk->sij", away, axes)
    across = np.sqrt(np.maximum(np.einsum("sijk,sijk->sij", away, away) - along**2, 0.0))
    forms, sizes, treads = forms[:, None, None], sizes[:, None, None], treads[:, None, None]
    to_ring = np.hypot(along, across - sizes)
    to_segment = np.hypot(along - np.clip(along, -sizes, sizes), across)
    return float(np.max(treads - np.where(forms == SEGMENT, to_segment, to_ring), initial=0.0))


def _to_ring(away: Array, axis: Array, ring: float) -> float:
    """Distance of a point to a circle about the origin."""
    along = float(away @ axis)
    across = float(np.linalg.norm(away - along * axis))
    return float(np.hypot(along, across - ring))


def _to_segment(away: Array, axis: Array, half: float) -> float:
    """Distance of a point to a segment about the origin."""
    along = float(np.clip(away @ axis, -half, half))
    return float(np.linalg.norm(away - along * axis))


def _circles(axes: Array) -> Array:
    """(s, 48, 3) points of unit circles about the origin, across axes (s, 3)."""
    helpers = _AXES[np.argmin(np.abs(axes), axis=1)]
    first = cross(axes, helpers)
    first /= np.sqrt(np.sum(first * first, axis=1, keepdims=True))
    second = cross(axes, first)
    points: Array = _COSINES[:, None] * first[:, None, :] + _SINES[:, None] * second[:, None, :]
    return points
