"""A stance checked again by the oracles' own kinematics and their own look at the ground."""

from __future__ import annotations

import numpy as np
from complementarity import Oracle, Rest
from ring_distance import Ground
from tree_walk import BASE, STEP, machine


def residuals(stance, read=None) -> tuple[float, float]:
    """Unbalanced force over weight (moments over weight times span) and worst gap [m] of a settled stance.

    Couplings' multipliers are those of least squares: whatever they cannot take up is unbalanced. The gap is
    that of touching wheels in size, and of the others where they are in the ground.
    """
    read = read or machine(stance.rover)
    x, y, _ = stance.position
    fixed = dict(stance.joints)
    oracle = Oracle(read, stance.terrain, (x, y, stance.rpy[2]), fixed, stance.locked, stance.gravity)
    base = dict(zip(BASE, (stance.position[2], stance.rpy[1], stance.rpy[0]), strict=True))
    q = np.array([base.get(name, fixed.get(name, 0.0)) for name in oracle.names])
    poses = oracle.walk(q[None])
    links = {d.name: d.link for d in read.discs}
    spots = []
    for contact in stance.contacts:
        pose = poses[links[contact.wheel]][0]
        spots.append((links[contact.wheel], (pose[:3, :3].T @ (contact.point - pose[:3, 3]))[None]))
    dV, motion, _, closing = oracle.gradients(q[None], spots)
    loads = np.array([contact.load for contact in stance.contacts])
    weigh = oracle.unit / (oracle.weight * oracle.span)
    force = (dV[0] - loads @ motion[0, :, :, 2]) * weigh
    ties = (np.vstack([oracle.rows, closing[0], *_stops(oracle, stance, q)]) * oracle.unit).T
    if ties.size:
        force = force - ties @ np.linalg.lstsq(ties, force, rcond=None)[0]
    worst = float(np.max(np.abs(oracle.rows @ q - oracle.right), initial=0.0))
    for disc, touches in zip(read.discs, oracle.look(Ground(stance.terrain), q, keep=1e-4), strict=True):
        loaded = stance.loads[disc.name] > 0.0
        worst = max(worst, abs(touches[0].gap) if loaded else -touches[0].gap)
    return float(np.max(np.abs(force))), worst


def _stops(oracle, stance, q):
    """Rows of the joints and of the springs between frames that stand on a stop."""
    for stop in stance.stops:
        if stop in oracle.names:
            yield np.array([[1.0 if name == stop else 0.0 for name in oracle.names]])
        for spring in oracle.machine.springs:
            if spring["name"] == stop:
                poses = oracle.walk(q.astype(complex) + 1j * STEP * np.eye(oracle.n))
                yield oracle.machine.length(poses, spring).imag[None] / STEP


def retry(rover, terrain, cases, steps=(4, 16, 64)) -> list[Rest]:
    """What the complementarity oracle finds for cases (x, y, yaw), with ever more steps from level ground.

    Where its residual is below 1e-10 and its loads are not negative, there is a stance.
    """
    read = machine(rover)
    found = []
    for place in cases:
        tries = []
        for count in steps:
            tries.append(Oracle(read, terrain, place, rover.home).settle(count))
            if tries[-1].residual < 1e-10:
                break
        found.append(min(tries, key=lambda rest: rest.residual))
    return found
