"""How a rover stands, as one complementarity problem handed to scipy's least squares.

Unknown are every free coordinate (couplings are not eliminated), the loads of all places that may touch,
the forces of joints' stops, and the multipliers of couplings and ball loops. Complementary pairs become
Fischer-Burmeister residuals sqrt(a^2 + b^2) - a - b. Kinematics is `tree_walk`, contacts are
`ring_distance`; forces are complex-step derivatives of the energy and of the heights of contact points.
Nothing of the package's solver is used: no Pinocchio, no contact search, no reduction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from ring_distance import Ground, Touch, look, refine, touch
from scipy.optimize import least_squares
from tree_walk import BASE, STEP, Machine

NEAR_STOP = 0.05


@dataclass
class Rest:
    """What was found: coordinates by name, load per wheel [N], least gap per wheel [m], largest residual."""

    q: dict[str, float]
    loads: dict[str, float]
    gaps: dict[str, float]
    residual: float
    touches: list[tuple[str, Touch, float]]


class Oracle:
    """One machine at one place.

    Args:
        machine: what stands.
        terrain: the package's terrain, for heights and gradients only.
        place: x, y, yaw of the base.
        fixed: joint values by name; for free ones, where they start.
        held: passive joints that do not move.
        gravity: m/s2.
    """

    def __init__(self, machine: Machine, terrain, place, fixed=None, held=(), gravity=9.81) -> None:
        self.machine, self.terrain, self.place = machine, terrain, place
        self.fixed = dict(fixed or {})
        self.names = machine.free(held)
        self.n = len(self.names)
        self.gravity = gravity
        self.weight = machine.mass * gravity
        self.rows, self.right = machine.coupling_rows(self.names, self.fixed)
        sliding = {b.name for b in machine.branches if b.sliding} | {"base_z"}
        poses = self.walk(self.level()[None])
        centers = np.array([_center(poses, d)[0] for d in machine.discs])
        self.span = float(np.max(np.linalg.norm(centers[:, None] - centers[None], axis=2)))
        self.unit = np.array([self.span if name in sliding else 1.0 for name in self.names])
        self.limits = {b.name: b.limits for b in machine.branches}

    def level(self) -> np.ndarray:
        return np.array([0.0 if name in BASE else self.fixed.get(name, 0.0) for name in self.names])

    def walk(self, q):
        return self.machine.walk(self.place, self.names, q, self.fixed)

    # --- what touches

    def wheels(self, q) -> list[tuple[np.ndarray, np.ndarray]]:
        """Center and axis of every wheel, world."""
        poses = self.walk(q[None])
        return [(_center(poses, d)[0], (poses[d.link][0, :3, :3] @ d.axis)) for d in self.machine.discs]

    def look(self, ground, q, keep=0.01) -> list[list[Touch]]:
        return [
            look(ground, c, a, d.ring, d.tread, keep=keep)
            for d, (c, a) in zip(self.machine.discs, self.wheels(q), strict=True)
        ]

    def cleared(self, ground, q) -> np.ndarray:
        """q lifted until every circle is a third of its tread above the ground."""
        turns = np.linspace(0.0, 2 * np.pi, 90, endpoint=False)
        lift = 0.0
        for d, (c, a) in zip(self.machine.discs, self.wheels(q), strict=True):
            first = np.cross(a, [0.0, 0.0, 1.0])
            first /= np.linalg.norm(first)
            second = np.cross(a, first)
            ring = c + d.ring * (np.cos(turns)[:, None] * first + np.sin(turns)[:, None] * second)
            low = float(np.min(ring[:, 2] - ground.height(ring[:, 0], ring[:, 1])))
            lift = max(lift, d.tread / 3 - low)
        return np.concatenate([[q[0] + lift], q[1:]])

    # --- the equations

    def gradients(self, q, spots, joints_too=True):
        """Complex-step derivatives at real rows q (B, n), with one list of body points (wheel, local) a row.

        Returns:
            dV (B, n); motion (B, m, n, 3) of the points; loops' residual (B, k) and Jacobian (B, k, n).
        """
        rows, n = q.shape
        steps = np.repeat(q.astype(complex), n, axis=0) + 1j * STEP * np.tile(np.eye(n), (rows, 1))
        poses = self.walk(steps)
        energy = self.machine.potential(poses, self.names, steps, self.gravity)
        motion = np.zeros((rows, len(spots), n, 3))
        for i, (link, local) in enumerate(spots):
            pose = poses[link].reshape(rows, n, 4, 4)
            moved = np.einsum("bnij,bj->bni", pose[..., :3, :3], local) + pose[..., :3, 3]
            motion[:, i] = moved.imag / STEP
        balls = self.machine.ball_gaps(poses).reshape(rows, n, -1)
        return (
            energy.imag.reshape(rows, n) / STEP, motion,
            balls.real[:, 0], np.swapaxes(balls.imag, 1, 2) / STEP,
        )  # fmt: skip

    def at(self, ground, q, slots, derivative):
        """Everything at q; with `derivative`, at q and at q moved along each coordinate."""
        grid = np.tile(q, (1 + self.n * derivative, 1))
        if derivative:
            grid[1:] += 1e-7 * np.diag(self.unit)
        poses = self.walk(grid)
        found, spots = [], []
        for wheel, offset in slots:
            d = self.machine.discs[wheel]
            pose = poses[d.link]
            centers = _center(poses, d)
            axes = pose[:, :3, :3] @ d.axis
            each = []
            for c, a in zip(centers, axes, strict=True):
                got = refine(ground, c, a, d.ring, d.tread, c[:2] + offset)
                each.append(got or touch(ground, c, a, d.ring, d.tread, *(c[:2] + offset)))
            found.append(each)
            for key in ("ground", "circle"):
                world = np.array([getattr(t, key) for t in each])
                local = np.einsum("bji,bj->bi", pose[:, :3, :3], world - pose[:, :3, 3])
                spots.append((d.link, local))
        return found, self.gradients(grid, spots)

    def solve_at(self, ground, q, slots, stops, start):
        """Least squares on the residuals with these places and stops that may carry."""
        n, m, t = self.n, len(slots), len(stops)
        k, balls = len(self.rows), 3 * len(self.machine.balls)
        weigh = self.unit / self.span
        stop_rows = np.zeros((t, n))
        stop_at = np.zeros(t)
        for i, (name, sign, limit) in enumerate(stops):
            stop_rows[i, self.names.index(name)] = -sign
            stop_at[i] = sign * limit
        kept = {}

        def unpack(u):
            return u[:n] * self.unit, *np.split(u[n:], np.cumsum([m, t, k]))

        def known(u, derivative):
            key = (u.tobytes(), derivative)
            if key not in kept:
                kept[key] = self.at(ground, unpack(u)[0], slots, derivative)
            return kept[key]

        def unbalanced(u, grads, row):
            _, loads, held, pulls, ties = unpack(u)
            dV, motion, _, closing = (g[row] for g in grads)
            force = dV / self.weight - loads @ motion[0::2, :, 2] - closing.T @ ties
            return (force - self.rows.T @ pulls - stop_rows.T @ held) * weigh

        def pairs(u, found):
            q, loads, held, _, _ = unpack(u)
            gap = np.array([each[0].gap for each in found]) / self.span
            slack = stop_at + stop_rows @ q
            return np.concatenate([gap, slack]), np.concatenate([loads, held])

        def residual(u):
            found, grads = known(u, False)
            a, b = pairs(u, found)
            closed = self.rows @ unpack(u)[0] - self.right
            return np.concatenate(
                [unbalanced(u, grads, 0), closed, grads[2][0] / self.span, np.sqrt(a * a + b * b) - a - b]
            )

        def jacobian(u):
            found, grads = known(u, True)
            a, b = pairs(u, found)
            size = np.maximum(np.hypot(a, b), 1e-200)
            da, db = a / size - 1.0, b / size - 1.0
            da[size < 1e-199] = db[size < 1e-199] = -1.0 + 0.5**0.5
            out = np.zeros((n + k + balls + m + t, len(u)))
            base = unbalanced(u, grads, 0)
            for j in range(n):
                out[:n, j] = (unbalanced(u, grads, j + 1) - base) / 1e-7
            _, motion, _, closing = (g[0] for g in grads)
            out[:n, n : n + m] = -(motion[0::2, :, 2] * weigh).T
            out[:n, n + m : n + m + t] = -(stop_rows * weigh).T
            out[:n, n + m + t : n + m + t + k] = -(self.rows * weigh).T
            out[:n, n + m + t + k :] = -(closing * weigh).T
            out[n : n + k, :n] = self.rows * self.unit
            out[n + k : n + k + balls, :n] = closing * self.unit / self.span
            normals = np.array([each[0].normal for each in found])
            gaps = np.einsum("mni,mi->mn", motion[1::2], normals) / self.span
            slack = np.vstack([gaps, stop_rows]) * self.unit
            out[n + k + balls :, :n] = da[:, None] * slack
            out[n + k + balls :, n : n + m + t] = np.diag(db)
            return out

        first = np.concatenate([q / self.unit, start, np.zeros(t + k + balls)])
        got = least_squares(
            residual, first, jac=jacobian, method="lm", ftol=1e-15, xtol=1e-15, gtol=1e-15, max_nfev=200
        )
        q, loads, *_ = unpack(got.x)
        return q, loads, float(np.max(np.abs(got.fun))), known(got.x, False)[0]

    def settle_on(self, ground, q) -> tuple[np.ndarray, float, list[tuple[int, Touch, float]]]:
        """Solve, look at the whole footprint again, and solve again until no new place comes up."""
        q = self.cleared(ground, q)
        slots, loads, stops = [], np.zeros(0), []
        for _ in range(10):
            seen = self.look(ground, q)
            fresh = [
                (i, t.ground[:2] - c[:2], t)
                for i, (ts, (c, _)) in enumerate(zip(seen, self.wheels(q), strict=True))
                for t in ts
            ]
            deep = min((t.gap for *_, t in fresh), default=0.0)
            beyond = [s for s in self.near_stops(q) if s not in stops]
            if slots and deep > -1e-9 and not beyond:
                break
            slots = [(i, offset) for i, offset, _ in fresh]
            stops = self.near_stops(q)
            start = np.full(len(slots), 1.0 / max(len(slots), 1))
            q, loads, worst, found = self.solve_at(ground, self.cleared(ground, q), slots, stops, start)
        touches = [(i, each[0], float(load)) for (i, _), each, load in zip(slots, found, loads, strict=True)]
        return q, worst, touches

    def near_stops(self, q) -> list[tuple[str, float, float]]:
        out = []
        for name, value in zip(self.names, q, strict=True):
            low, high = self.limits.get(name, (-np.inf, np.inf))
            if value - low < NEAR_STOP:
                out.append((name, -1.0, low))
            if high - value < NEAR_STOP:
                out.append((name, 1.0, high))
        return out

    def settle(self, steps: int = 4, start: dict[str, float] | None = None) -> Rest:
        """From level ground at the base's height to the terrain in `steps` equal rises.

        With `start`, coordinates by name, the nearest solution to that.
        """
        if start is not None:
            return self.rest(
                *self.settle_on(Ground(self.terrain), np.array([start[name] for name in self.names]))
            )
        level = float(self.terrain.height(*self.place[:2]))
        q = self.level()
        q[0] = level + self.span
        flat = self.look(Ground(self.terrain, level, 0.0), q)
        q[0] -= min(ts[0].gap for ts in flat)
        for s in np.linspace(0.0, 1.0, steps + 1):
            q, worst, touches = self.settle_on(Ground(self.terrain, level, float(s)), q)
        return self.rest(q, worst, touches)

    def rest(self, q, worst, touches) -> Rest:
        """The answer by names."""
        names = [d.name for d in self.machine.discs]
        loads = dict.fromkeys(names, 0.0)
        for i, _, load in touches:
            loads[names[i]] += load * self.weight
        seen = self.look(Ground(self.terrain), q)
        gaps = {name: ts[0].gap for name, ts in zip(names, seen, strict=True)}
        carried = [(names[i], t, load * self.weight) for i, t, load in touches]
        return Rest(dict(zip(self.names, q.tolist(), strict=True)), loads, gaps, worst, carried)


def _center(poses, disc) -> np.ndarray:
    pose = poses[disc.link]
    return pose[:, :3, :3] @ disc.center + pose[:, :3, 3]
