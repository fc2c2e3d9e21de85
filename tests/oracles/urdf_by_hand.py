"""A robot whose joints all hold, from its URDF's XML in plain numpy: how it stands on a plane, what holds it.

Shares no code with the package. On the plane z = tan(slope) x the robot is one rigid body; its base is held
at x = y = 0 and a heading, so three contacts that do not lie in a line fix the rest.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.optimize import linprog
from tree_walk import Branch, _about_x, _about_y, _about_z, _branch, _moved, _numbers


@dataclass(frozen=True)
class Shape:
    """What touches: a ball (a point where the radius is 0), or a wheel's ring about `axis` in its link."""

    name: str
    link: str
    center: tuple[float, float, float]
    radius: float
    friction: float
    axis: tuple[float, float, float] | None = None


class Standing:
    """The URDF at a posture, on a plane.

    Attributes:
        points: (k, 3) m, contacts, world.
        com: (3,) m, world.
        weight: N.
        normal: (3,) of the plane.
    """

    def __init__(self, path: Path, posture, shapes: list[Shape], slope=0.0, yaw=0.0, gravity=9.81) -> None:
        top = ET.fromstring(Path(path).read_bytes())
        self.shapes, self.gravity = shapes, gravity
        self.branches = [_branch(e) for e in top.findall("joint")]
        self.effort = {
            e.get("name"): float(e.find("limit").get("effort"))
            for e in top.findall("joint")
            if e.find("limit") is not None and e.get("type") != "fixed"
        }
        self.masses = {}
        for link in top.findall("link"):
            if (inertial := link.find("inertial")) is not None:
                own = np.r_[_numbers(inertial.find("origin"), "xyz"), 1.0]
                self.masses[link.get("name")] = (float(inertial.find("mass").get("value")), own)
        self.weight = gravity * sum(m for m, _ in self.masses.values())
        self.normal = np.array([-math.sin(slope), 0.0, math.cos(slope)])
        self.links = self._walk(posture, np.eye(4))
        self._stand(posture, yaw)
        self.points = np.array([self._touching(shape) for shape in shapes])
        self.com = sum(m * self.links[n] @ own for n, (m, own) in self.masses.items())[:3]
        self.com = self.com * gravity / self.weight

    def _walk(self, posture, base) -> dict[str, np.ndarray]:
        below = {b.child for b in self.branches}
        root = next(b.parent for b in self.branches if b.parent not in below)
        self.above = {b.child: b for b in self.branches}
        links, open_ = {root: base}, [root]
        while open_:
            parent = open_.pop()
            for b in self.branches:
                if b.parent == parent:
                    turn = np.eye(4) if b.fixed else _moved(b, np.array([float(posture.get(b.name, 0.0))]))[0]
                    links[b.child] = links[parent] @ b.origin @ turn
                    open_.append(b.child)
        return links

    def _stand(self, posture, yaw) -> None:
        """Turn the base's z to the normal: here all contacts then lie in the plane."""
        heading = _about_z(np.array([yaw]))[0]
        across = heading.T @ self.normal  # (sin pitch cos roll, -sin roll, cos pitch cos roll)
        roll, pitch = -math.asin(across[1]), math.atan2(across[0], across[2])
        turned = heading @ _about_y(np.array([pitch]))[0] @ _about_x(np.array([roll]))[0]
        base = np.eye(4)
        base[:3, :3] = turned
        self.links = self._walk(posture, base)
        heights = np.array([self.normal @ self._touching(shape) for shape in self.shapes])
        assert np.ptp(heights) < 2e-6, "the contacts do not lie in a plane across the base's z"
        base[2, 3] = -heights.mean() / self.normal[2]
        self.rpy, self.links = (roll, pitch, yaw), self._walk(posture, base)

    def _touching(self, shape: Shape) -> np.ndarray:
        pose = self.links[shape.link]
        center = (pose @ np.r_[shape.center, 1.0])[:3]
        down = -self.normal
        if shape.axis is not None:  # a wheel across the plane: the lowest place of its ring
            axis = pose[:3, :3] @ np.array(shape.axis)
            assert abs(axis @ self.normal) < 1e-5
        return center + shape.radius * down

    @cached_property
    def loads(self) -> np.ndarray:
        """(k,) N: the least sum of squares of vertical forces >= 0 that balance the weight."""
        rows = np.vstack([np.ones(len(self.points)), self.points[:, :2].T - self.com[:2, None]])
        right = np.array([self.weight, 0.0, 0.0])
        carrying = np.ones(len(self.points), dtype=bool)
        for _ in range(20):  # loads = max(0, rows' y) with y from those that carry
            kept = rows[:, carrying]
            y = np.linalg.solve(kept @ kept.T, right)
            following = rows.T @ y > 0.0
            if np.array_equal(following, carrying):
                return np.maximum(rows.T @ y, 0.0)
            carrying = following
        raise AssertionError("no loads found")

    def reach(self, direction, edges, torques=False, inside=True) -> float:
        """How far the centre of mass may go [m], by a linear program; NaN where nowhere is allowed.

        Unknown are each contact's force (generators of a pyramid within the friction cone, or around it) and
        the horizontal move of the mass of the root link.
        """
        count = len(self.points)
        angles = 2 * math.pi * np.arange(edges) / edges
        first = np.cross(self.normal, [0.0, 1.0, 0.0])
        first /= np.linalg.norm(first)
        second = np.cross(self.normal, first)
        sideways = np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second)
        wider = 1.0 if inside else 1.0 / math.cos(math.pi / edges)
        rays = [self.normal + s.friction * wider * sideways for s in self.shapes]  # (edges, 3) each
        columns = [
            np.vstack([r.T, np.cross(p - self.com, r).T]) for p, r in zip(self.points, rays, strict=True)
        ]
        # the moved weight's moment about the centre of mass as it is: (mx, my, 0) x (0, 0, -W)
        moved = self.weight * np.array([[0, 0], [0, 0], [0, 0], [0, -1], [1, 0], [0, 0]], float)
        n = count * edges
        equal = np.hstack([*columns, moved]) / self.weight
        balance = np.r_[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
        less, most = self._torque_rows(rays) if torques else (np.zeros((0, n + 2)), np.zeros(0))
        found = linprog(
            np.r_[np.zeros(n), -np.asarray(direction)], A_ub=less, b_ub=most, A_eq=equal, b_eq=balance,
            bounds=[(0, None)] * n + [(None, None)] * 2, method="highs",
        )  # fmt: skip
        return -found.fun if found.status == 0 else math.nan

    def _torque_rows(self, rays) -> tuple[np.ndarray, np.ndarray]:
        """|torque of each joint| <= its effort, in the forces of `reach`."""
        forces, weights, limits = self._torques
        rows = np.concatenate([forces[:, i] @ r.T for i, r in enumerate(rays)], axis=1)
        rows = np.hstack([rows, np.zeros((len(rows), 2))])
        return np.vstack([rows, -rows]), np.r_[limits - weights, limits + weights]

    @cached_property
    def _torques(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of each moving joint: (j, k, 3) by forces at contacts, (j,) by the weight below, (j,) its limit."""
        forces, weights, limits = [], [], []
        for b in self.branches:
            if b.fixed:
                continue
            pose, below = self.links[b.child], self._below(b)
            origin, axis = pose[:3, 3], pose[:3, :3] @ b.axis

            def turn(place, b=b, origin=origin, axis=axis):
                """What a unit force at a place gives, along x, y and z."""
                return axis if b.sliding else np.cross(axis, place - origin)

            carried = zip(self.shapes, self.points, strict=True)
            forces.append([turn(p) if s.link in below else np.zeros(3) for s, p in carried])
            heavy = [(m, self.links[link] @ own) for link, (m, own) in self.masses.items() if link in below]
            weights.append(-self.gravity * sum(m * turn(place[:3])[2] for m, place in heavy))
            limits.append(self.effort[b.name])
        return np.array(forces), np.array(weights), np.array(limits)

    def _below(self, b: Branch) -> set[str]:
        """Links that move with a joint."""
        found = {b.child}
        for link in self.links:
            up, chain = link, []
            while up in self.above and up not in found:
                chain.append(up)
                up = self.above[up].parent
            if up in found:
                found.update(chain)
        return found
