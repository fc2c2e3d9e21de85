"""The least friction that equilibrium asks for, on exact cones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from rover_pin.numerics import Array
from rover_pin.statics.cone_program import ConeProgram
from rover_pin.statics.force_space import ForceSpace

STEP = 1e-8
"""How far past the root it is probed on either side; the bracket aimed for is at most four of these wide."""

WIDEST = 1e-6
"""Bracket beyond which the search counts as failed."""

SQUEEZE = 1000.0
"""Normal forces may add up to this many weights: bracing without bound is not counted as standing."""

_TRIES = 80
_HOPELESS = 1e4


@dataclass(frozen=True)
class LeastFriction:
    """The least e for which equilibrium holds with friction base_i + e at every contact.

    Attributes:
        outcome: `found`, `infeasible` (at any friction), `failed` (the solver did).
        excess: e, an upper end of the bracket: `forces` hold it.
        lower: the bracket's lower end, proven by the dual.
        forces: (3k + o,) in the force space's coordinates, units of the weight.
    """

    outcome: Literal["found", "infeasible", "failed"]
    excess: float
    lower: float
    forces: Array


def least_friction(space: ForceSpace, base: Array, start: float = 0.0) -> LeastFriction:
    """Least e with |tangential_i| <= (base_i + e) normal_i in equilibrium; base = 0 gives the least friction.

    For a given e, t(e) = min max_i |tangential_i| - (base_i + e) normal_i over all forces in equilibrium
    is a second-order cone program, and e is enough exactly where t(e) <= 0. t falls with e with slope
    -sum(multiplier_i normal_i), so a Newton iteration inside a bracket finds its root (the generalised
    Dinkelbach iteration, Crouzeix, Ferland and Schaible 1985). Forces and weight are scaled to normal
    forces of sum 1, which keeps the set compact where wheels can brace against each other. The bracket's
    upper end is held by forces, its lower end by a dual bound; both are recomputed, not taken from the
    solver.

    Args:
        space: the forces in equilibrium.
        base: (k,) friction that is there already.
        start: a guess of e.

    Cost: about 12 programs of 0.2 ms with six wheels.
    """
    nothing = np.full(space.particular.size, np.nan)
    if not space.consistent or space.contacts == 0:
        return LeastFriction("infeasible", np.inf, np.inf, nothing)
    search = _Search(space, base)
    floor = -float(np.min(base))
    lower, upper, best, step = floor, np.inf, nothing, STEP
    guess = max(start, floor) + step
    for attempt in range(_TRIES):
        probe = search.at(guess)
        if probe is None:
            return LeastFriction(search.outcome, np.inf, lower, nothing)
        if probe.worst <= 0.0:
            if guess < upper:
                upper, best = guess, probe.forces
        elif probe.proven > 0.0:
            lower = max(lower, guess)
        else:  # nearer the root than the solver has digits: probe further from it
            step *= 2.0
        if upper - lower <= 4.0 * step:
            return LeastFriction("found", upper, lower, best)
        if lower > _HOPELESS:
            return LeastFriction("infeasible", np.inf, lower, nothing)
        if step > WIDEST:
            break
        guess = _next(guess, probe, lower, upper, step, bisect=attempt % 8 == 7)
    return LeastFriction("failed", upper, lower, best)


def _next(guess: float, probe: _Probe, lower: float, upper: float, step: float, bisect: bool) -> float:
    """Newton's next guess, one step past the root it sees on the side that is still open."""
    root = guess + probe.worst / probe.slope if probe.slope > 1e-12 else np.inf
    guess = root - step if np.isfinite(upper) and upper - root <= 2.0 * step else root + step
    if not np.isfinite(upper):
        return float(min(max(guess, lower + step), 2.0 * abs(lower) + 2.0))
    if bisect:
        return 0.5 * (lower + upper)
    if guess <= lower:
        return lower + min(step, 0.5 * (upper - lower))
    return float(guess) if guess < upper else 0.5 * (lower + upper)


@dataclass(frozen=True)
class _Probe:
    """t(e) from above (`worst`, by `forces`) and from below (`proven`, by the dual), and its slope's size."""

    worst: float
    proven: float
    slope: float
    forces: Array


class _Search:
    """The program of t(e), set up once: x = (y, scale, t), forces u = scale particular + basis y."""

    def __init__(self, space: ForceSpace, base: Array) -> None:
        self._base = base
        self._space = space
        self.outcome: Literal["infeasible", "failed"] = "failed"
        k = space.contacts
        self._map = np.column_stack([space.basis, space.particular, np.zeros(space.particular.size)])
        n = self._map.shape[1]
        scale = np.zeros(n)
        scale[-2] = 1.0
        cost = np.zeros(n)
        cost[-1] = 1.0
        pushing = self._map[space.pushing()]
        self._cones = self._map[: 3 * k].reshape(k, 3, n).copy()
        self._cones[:, 0, -1] = 1.0
        self._program = ConeProgram(
            cost=cost,
            equal=self._map[space.normals()].sum(axis=0)[None, :],
            level=np.ones(1),
            at_least=np.vstack([pushing, scale]),
            base=np.append(np.zeros(len(pushing)), -1.0 / SQUEEZE),
            cones=self._cones,
        )

    def at(self, excess: float) -> _Probe | None:
        """Solve for one e; None where the solver has no answer, and then `outcome` says which."""
        k = self._space.contacts
        friction = self._base + excess
        cones = self._cones.copy()
        cones[:, 0] = friction[:, None] * self._map[0 : 3 * k : 3]
        cones[:, 0, -1] = 1.0
        self._program.set_cones(cones)
        answer = self._program.solve(accepted=1e-6)
        if answer.outcome != "solved":
            self.outcome = "infeasible" if answer.outcome == "infeasible" else "failed"
            return None
        scaled = self._map @ answer.x
        contacts = scaled[: 3 * k].reshape(k, 3)
        outside = np.hypot(contacts[:, 1], contacts[:, 2]) - friction * contacts[:, 0]
        worst = float(np.max(np.concatenate([outside, -scaled[3 * k :]])))
        slope = float(answer.cone_multipliers[:, 0] @ contacts[:, 0])
        return _Probe(worst, answer.bound, slope, scaled / answer.x[-2])
