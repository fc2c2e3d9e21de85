"""A rover at rest on level ground: where every settle starts from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import nnls

from rover_pin.numerics import Array
from rover_pin.statics.adapt import NOT_NEGATIVE, adapted, stands
from rover_pin.statics.loads import STOPPED, Loads, share_loads
from rover_pin.statics.newton import Landing, independent_rows, land
from rover_pin.statics.problem import THOROUGH, Integers, Problem, State
from rover_pin.statics.relax import FAR, Rest, relax
from rover_pin.statics.stance import Status
from rover_pin.statics.start import level_start
from rover_pin.statics.verdict import free_motions, steadiness, way_out

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain

OUT_OF_HAND = 2.0
"""Shares of the span, or rad: a joint that moves further on level ground is held by nothing."""

RESTS = (1e-4, 3e-5, 1e-5, 1e-7)
"""Shares of the span, or rad: steps small enough to try Newton's last step, one after the other."""

PUSH = 1e-3
"""Share of the span, or rad: the nudge that tells a stance that stays from one that only balances."""

FALLING = 1.0
"""Rad of tilt beyond which a rover that lost a support, and that no support can hold any more, falls over."""

PAUSE = 25
"""Steps of a sprung rover's fall after which it is tried whether Newton can finish."""


@dataclass(frozen=True)
class Footing:
    """A pose that stands, or the reason why none was found.

    Attributes:
        z: (n,) free coordinates.
        status: `settled` where it stands.
        limiting: wheel or joint that names the reason.
        reason: for people.
        active: supports that carry, as rows of a state with one contact a shape.
        loops: independent loop rows.
        sign: of the determinant of supports and loops.
    """

    z: Array
    status: Status
    limiting: str | None
    reason: str
    active: Integers
    loops: Integers
    sign: float


def failed(z: Array, status: Status, limiting: str | None, reason: str) -> Footing:
    """A footing that does not stand."""
    nothing = np.zeros(0, dtype=np.int64)
    return Footing(z, status, limiting, reason, nothing, nothing, 0.0)


def off_map(z: Array, wheel: str) -> Footing:
    """A wheel has points that are not over the map."""
    return failed(z, Status.OFF_MAP, wheel, f"{wheel} reaches beyond the map")


def settle_on_level(problem: Problem, posture: Mapping[str, float], ground: Terrain) -> Footing:
    """Lower the level rover onto level ground and let go.

    Raises:
        MechanismError: a loop that cannot close with the values that are held.
    """
    z = level_start(problem, posture, ground)
    held_up = share_loads(problem, problem.state(z, ground, window=1e-5))
    lost = heaviest_loser(problem, held_up, problem.state(z, ground, 1e-5))
    footing = let_go(problem, z, ground, 1e-5, lost, OUT_OF_HAND)
    if footing.status is Status.SETTLED:
        loose = _fell_to_its_stop(problem, z, footing)
        if loose is not None:
            reason = f"passive joint {loose} falls to its stop before any wheel beyond it bears"
            return failed(footing.z, Status.LOOSE, loose, reason)
    return footing


def let_go(
    problem: Problem, z: Array, terrain: Terrain, window: float, lost: str | None, far: float = FAR
) -> Footing:
    """Let the rover fall from z; from a rest on which it only balances it is pushed off.

    Args:
        problem: the rover.
        z: (n,) start.
        terrain: what it falls on.
        window: m, of the contacts looked at.
        lost: the support that gave way, or None.
        far: shares of the span, or rad; a joint that moves further is lost.
    """
    footing = _come_to_rest(problem, z, terrain, window, lost, far)
    if footing.status is not Status.SETTLED:
        return footing
    state = problem.state(footing.z, terrain, window=1e-5)
    loads = share_loads(problem, state)
    motions = free_motions(state, loads, problem)
    if not motions.shape[1]:
        return footing
    out = way_out(problem, motions, steadiness(problem, state, loads, terrain, motions))
    if out is None:
        return footing
    return _come_to_rest(problem, footing.z + PUSH * out, terrain, window, lost, far)


def _come_to_rest(
    problem: Problem, z: Array, terrain: Terrain, window: float, lost: str | None, far: float
) -> Footing:
    """Relax until Newton can finish."""
    if problem.elastics:
        rest = relax(problem, z, terrain, window=window, steps=PAUSE, resting=RESTS[0], far=far)
        caught = _caught(problem, rest, terrain) if rest.end in ("rest", "lost") else None
        if caught is not None:
            return caught
    for resting in RESTS:
        rest = relax(problem, z, terrain, window=window, resting=resting, far=far)
        footing = footing_of(problem, rest, terrain, lost)
        z = rest.state.z
        if rest.end != "rest" or footing.status is Status.SETTLED:
            break
    return footing


def _caught(problem: Problem, rest: Rest, terrain: Terrain) -> Footing | None:
    """Newton from a sprung rover's fall that need not have ended, on the supports that turn out to carry."""
    loops = independent_rows(rest.state.closing)
    active = np.unique(plain_rows(problem, rest.state)[rest.multipliers > 0.0])
    landing = land(problem, rest.state.z, terrain, active, loops, window=THOROUGH, reach=0.2)
    if landing is not None and not stands(problem, landing, landing.sign):
        found = adapted(problem, rest.state.z, terrain, active, loops, landing)
        landing, active = (None, active) if found is None else found
    if landing is None:
        return None
    return Footing(landing.z, Status.SETTLED, None, "", active, loops, landing.sign)


def footing_of(problem: Problem, rest: Rest, terrain: Terrain, lost: str | None) -> Footing:
    """What the end of a damped motion means; a rest is polished by Newton and its loads checked."""
    z = rest.state.z
    if rest.end == "over":
        return tipped(problem, z, lost)
    if rest.end == "away":
        column = problem.reduction.columns[rest.column]
        joint = problem.rover.dof_names[column]
        return failed(z, Status.LOOSE, joint, f"passive joint {joint} falls without bound")
    if rest.end == "lost" and lost is not None and problem.tilt(z) > FALLING:
        return tipped(problem, z, lost)
    if rest.end == "lost":
        return failed(z, Status.NO_CONVERGENCE, None, "no stance was found within the steps allowed")
    active = carrying(problem, rest)
    loops = independent_rows(rest.state.closing)
    landing = polish(problem, rest, terrain, active, loops)
    if landing is None:
        return failed(z, Status.NO_CONVERGENCE, None, "the last step did not converge")
    return Footing(landing.z, Status.SETTLED, None, "", active, loops, landing.sign)


def polish(
    problem: Problem, rest: Rest, terrain: Terrain, active: Integers, loops: Integers
) -> Landing | None:
    """Newton from a rest; with several contacts a wheel where one contact a wheel is not enough."""
    landing = land(problem, rest.state.z, terrain, active, loops, window=THOROUGH, reach=0.05)
    if landing is not None:
        return landing
    rows = np.flatnonzero(rest.multipliers > -NOT_NEGATIVE * problem.weight)
    rows = rows[independent_rows(rest.state.motion[rows])]
    return land(problem, rest.state.z, terrain, rows, loops, window=1e-3, reach=0.05)


def carrying(problem: Problem, rest: Rest) -> Integers:
    """Supports that can carry alone at a rest, as rows of a state with one contact a shape."""
    near = np.flatnonzero(rest.multipliers > -NOT_NEGATIVE * problem.weight)
    return supports(problem, rest.state, near, plain_rows(problem, rest.state))


def plain_rows(problem: Problem, state: State) -> Integers:
    """(m,) each row's number in a state with one contact a shape."""
    contacts, shapes = len(state.owners), len(problem.rover.shapes)
    plain: Integers = np.arange(len(state.slack)) - contacts + shapes
    plain[:contacts] = state.owners
    return plain


def supports(problem: Problem, state: State, near: Integers, plain: Integers) -> Integers:
    """As many of the rows `near` as are needed to carry the load, none with a negative one.

    A basic solution of non-negative least squares, whose support is independent where supports are redundant;
    then those that touch without load (a load right over a diagonal), as far as they hold the rover steady.

    Args:
        problem: the rover.
        state: the equations.
        near: rows that may carry.
        plain: (m,) each row's number in a state with one contact a shape.
    """
    weigh = problem.unit / problem.span
    sides = state.force[near].T * weigh[:, None]
    pulls = state.closing.T * weigh[:, None]
    found = nnls(np.hstack([sides, pulls, -pulls]), state.load / problem.weight * weigh)[0][: len(near)]
    chosen = list(near[found > -NOT_NEGATIVE])
    rows = np.vstack([state.closing, state.motion[chosen]]) * problem.unit
    rank = int(np.linalg.matrix_rank(rows, tol=1e-9)) if rows.size else 0
    for row in near[found <= -NOT_NEGATIVE]:
        if rank == problem.n:
            break
        wider = np.vstack([rows, state.motion[row] * problem.unit])
        if int(np.linalg.matrix_rank(wider, tol=1e-9)) > rank:
            rows, rank = wider, rank + 1
            chosen.append(row)
    return np.array(sorted({int(plain[row]) for row in chosen}), dtype=np.int64)


def heaviest_loser(problem: Problem, loads: Loads, state: State) -> str | None:
    """The wheel or stop whose load would be the most negative if every support held it down."""
    touching = loads.touching
    if not len(touching):
        return None
    sides = np.vstack([state.force[touching], state.closing]).T
    weigh = problem.unit
    found = np.linalg.lstsq(sides * weigh[:, None], state.load * weigh, rcond=1e-10)[0][: len(touching)]
    worst = int(np.argmin(found))
    return support_name(problem, state, int(touching[worst])) if found[worst] < 0.0 else None


def support_name(problem: Problem, state: State, row: int) -> str:
    """Name of the wheel, joint or element behind a one-sided row."""
    contacts = len(state.owners)
    if row < contacts:
        return str(problem.rover.shapes[int(state.owners[row])].name)
    row -= contacts
    if row < len(problem.stop_joints):
        return problem.stop_joints[row]
    return problem.one_sided[row - len(problem.stop_joints)].name


def tipped(problem: Problem, z: Array, lost: str | None) -> Footing:
    """It falls over; `lost` is the wheel or joint that lets go."""
    wheels = {shape.name for shape in problem.rover.shapes}
    if lost is None:
        reason = "it falls over: tilt above 80 deg"
    elif lost in wheels:
        reason = f"the load of {lost} would be negative and nothing catches it"
    else:
        reason = f"joint {lost} gives way and nothing catches it"
    return failed(z, Status.TIPS, lost, reason)


def _fell_to_its_stop(problem: Problem, start: Array, footing: Footing) -> str | None:
    """A joint that left its posture for a stop with no load on any wheel beyond it, and no element on it."""
    rover = problem.rover
    shapes = len(rover.shapes)
    bearing = {int(rover.shapes[row].joint) for row in footing.active if row < shapes}
    q0 = problem.reduction.expand(start)
    q1 = problem.reduction.expand(footing.z)
    bound = {joint for coupling in rover.couplings for joint in coupling.joints}
    bound |= {spring.joint for spring in rover.springs if hasattr(spring, "joint")}
    for row in footing.active:
        place = int(row) - shapes
        if not 0 <= place < len(problem.stop_joints):
            continue
        joint = problem.stop_joints[place]
        column = rover.column[joint]
        if joint in bound or rover.loops or abs(q1[column] - q0[column]) <= STOPPED:
            continue
        below = set(rover.model.subtrees[rover.model.getJointId(joint)])
        if not bearing & below:
            return joint
    return None
