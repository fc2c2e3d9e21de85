"""The paper's planar half model, quick and with exact derivatives by its lengths, for identifying them.

mm, N, rad; X rearwards, Z up, angles counter-clockwise, as the paper has them. One set of equations for
many cases: the 21 of the paper without motion resistance (T1 = T2, no tractions: 15 are left), corrected,
the track's and the springs' as complements: slack or taut, on the stop or pressed. Derivatives are complex
steps: exact, no step to choose. Wheels are held on the ground, so that a load that would lift one comes out
negative.

A vector is an array with two rows, X and Z; all else is behind them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rover_pin.numerics import Array

LENGTHS = (
    "d1", "d2", "d3", "d4", "d5", "d6", "d7", "d8", "d9", "d10", "d12", "d13", "d14", "d15",
    "alpha1_deg", "alpha2_deg", "alpha3_deg", "alpha4_deg", "r1", "r2", "r3", "r4", "r5", "r6",
)  # fmt: skip
"""What a geometry is, in order: mm, deg. d11 is an input of the cases (Table 5)."""

STATE = (
    "X_A", "Z_A", "theta", "theta_1", "theta_2", "theta_3", "theta_4",
    "N3", "N4", "N5", "N6", "T", "F1", "F2", "F3",
)  # fmt: skip
"""What a case is solved for: mm, rad, N."""

STEP = 1e-30
MOST_STEPS, MOST_HALVINGS = 16, 6
CLOSE = 1e-9
GRAVITY = 9.81

Numbers = Any  # float or complex arrays


@dataclass(frozen=True)
class Inputs:
    """Cases, one entry each.

    Attributes:
        mass: (c,) kg, of one side.
        track: (c,) mm.
        front_arm: (c,) mm, d11.
        ground: (4, c) mm, under wheels 3 to 6.
        com: mm, of G from A in the subframe.
        stiffness: N/mm.
        preload, length_max: (3,) N, mm.
    """

    mass: Array
    track: Array
    front_arm: Array
    ground: Array
    com: tuple[float, float] = (-50.0, -100.0)
    stiffness: float = 12.0
    preload: tuple[float, float, float] = (60.0, 0.0, 120.0)
    length_max: tuple[float, float, float] = (150.0, 150.0, 130.0)

    @property
    def count(self) -> int:
        """The number of cases."""
        return len(self.mass)


@dataclass(frozen=True)
class Solved:
    """Cases at rest.

    Attributes:
        state: (15, c) in the order of STATE.
        by_length: (15, l, c) its derivatives by LENGTHS (mm, deg).
        good: (c,) whether the equations are solved.
    """

    state: Array
    by_length: Array
    good: Any


def geometry(lengths: Mapping[str, float]) -> Array:
    """(l,) in the order of LENGTHS."""
    return np.array([lengths[name] for name in LENGTHS])


def solve(lengths: Array, inputs: Inputs, start: Array) -> Solved:
    """Newton for all cases at once.

    Args:
        lengths: (l,) of LENGTHS.
        inputs: c cases.
        start: (15, c) near the answer.
    """
    state = np.array(start)
    size = _size(equations(state, lengths[:, None], inputs))
    for _ in range(MOST_STEPS):
        value, slope = _by_state(state, lengths, inputs)
        if bool(np.all(size < CLOSE)):
            break
        step = _linear(slope, -value)
        turn, move = np.max(np.abs(step[2:7]), axis=0), np.max(np.abs(step[:2]), axis=0)
        step *= np.minimum(1.0, np.minimum(0.2 / np.maximum(turn, 1e-12), 40.0 / np.maximum(move, 1e-12)))
        state, size = _shortened(state, step, size, lengths, inputs)
    moved = lengths[:, None, None] + 1j * STEP * np.eye(len(lengths))[:, :, None]
    by_length = equations(state[:, None, :], moved, inputs).imag / STEP
    return Solved(state, -_linear(slope, by_length), _size(value) < 1e-6)


def _shortened(state: Array, step: Array, size: Array, lengths: Array, inputs: Inputs) -> tuple[Array, Array]:
    """The state after a step that makes the equations' largest residual smaller, case by case."""
    share = np.ones(inputs.count)
    best, best_size = state, size
    for _ in range(MOST_HALVINGS):
        tried = state + share * step
        now = _size(equations(tried, lengths[:, None], inputs))
        better = now < np.maximum(size, CLOSE)
        if bool(np.all(better)):
            return tried, now
        best, best_size = tried, now
        share = np.where(better, share, 0.5 * share)
    return best, best_size


def _size(value: Numbers) -> Array:
    size: Array = np.max(np.abs(value), axis=0)
    return np.where(np.isfinite(size), size, np.inf)


def _by_state(state: Array, lengths: Array, inputs: Inputs) -> tuple[Array, Array]:
    """(15, c) residuals and (15, 15, c) their derivatives."""
    moved = state[:, None, :] + 1j * STEP * np.eye(len(state))[:, :, None]
    found = equations(moved, lengths[:, None, None], inputs)
    return found.real[:, 0], found.imag / STEP


def _linear(slope: Array, right: Array) -> Array:
    """Solve for every case; (15, k, c) or (15, c)."""
    matrix = np.moveaxis(slope, -1, 0)
    sides = np.moveaxis(right, -1, 0)
    flat = sides.ndim == 2
    found: Any
    try:
        found = np.linalg.solve(matrix, sides[..., None] if flat else sides)
    except np.linalg.LinAlgError:
        found = np.stack([np.linalg.lstsq(m, s, rcond=None)[0] for m, s in
                          zip(matrix, sides[..., None] if flat else sides, strict=True)])  # fmt: skip
    found = found[..., 0] if flat else found
    solved: Array = np.moveaxis(found, 0, -1)
    return solved


def equations(state: Numbers, lengths: Numbers, inputs: Inputs) -> Numbers:
    """(15, ...) residuals: mm, N, moments over 100 mm.

    In order: X_P = 0, gaps of wheels 3 to 6, vertical forces, moments about A (subframe with its hinges), F
    (both bogie arms), E, D; track; springs 1 to 3.
    """
    g = dict(zip(LENGTHS, lengths, strict=True))
    pose, loads, tension, forces = state[:7], state[7:11], state[11], state[12:15]
    p = points(pose, g, inputs.front_arm)
    wheels = [p[name] for name in "AOPKIM"]
    radii = [g[f"r{k}"] for k in range(1, 7)]
    length, pulls, _ = belt(wheels, radii)
    weight = inputs.mass * GRAVITY
    push = [tension * pull for pull in pulls]
    for k in range(4):
        push[k + 2] = push[k + 2] + np.array([0.0 * loads[k], loads[k]])
    _, at_o, at_p, at_k, at_i, at_m = push
    ends = ((p["H"], p["J"]), (p["L"], p["C"]), (p["N"], p["B"]))
    spans = [a - b for a, b in ends]
    reach = [np.sqrt(s[0] ** 2 + s[1] ** 2) for s in spans]
    s1, s2, s3 = (f * s / r for f, s, r in zip(forces, spans, reach, strict=True))
    a, d, e, f = p["A"], p["D"], p["E"], p["F"]
    down = np.array([0.0 * weight, -weight]).reshape((2,) + (1,) * (np.ndim(tension) - 1) + (-1,))
    rows = [p["P"][0]]
    rows += [wheels[k + 2][1] - radii[k + 2] - inputs.ground[k] for k in range(4)]
    rows.append(loads[0] + loads[1] + loads[2] + loads[3] - weight)
    rows.append(
        (_turn(p["G"](inputs.com) - a, down) + _turn(d - a, at_o + at_p + s3) - _turn(p["B"] - a, s3)
         + _turn(e - a, at_m + s2) - _turn(p["C"] - a, s2) + _turn(f - a, at_k + at_i)) / 100.0
    )  # fmt: skip
    rows.append((_turn(p["I"] - f, at_i) + _turn(p["H"] - f, s1)) / 100.0)
    rows.append((_turn(p["K"] - f, at_k) - _turn(p["J"] - f, s1)) / 100.0)
    rows.append((_turn(p["M"] - e, at_m) + _turn(p["L"] - e, s2)) / 100.0)
    rows.append((_turn(p["O"] - d, at_o) + _turn(p["P"] - d, at_p) + _turn(p["N"] - d, s3)) / 100.0)
    slack = inputs.track - length
    rows.append(np.where((tension / 100.0).real < slack.real, tension / 100.0, slack))
    for k in range(3):
        over = forces[k] - inputs.preload[k]
        short = np.where(over.real > 0.0, over, 0.0 * over) / inputs.stiffness
        rows.append(inputs.length_max[k] - reach[k] - short)
    return np.array(np.broadcast_arrays(*rows))


def points(pose: Numbers, g: Mapping[str, Numbers], front_arm: Numbers) -> dict[str, Any]:
    """Appendix B and Fig. 5: every lettered point, (2, ...) mm; `G` is a function of the mass centre."""
    x, z, theta, t1, t2, t3, t4 = pose
    zero = 0.0 * (x + z + g["d1"] + front_arm)
    a = np.array([x + zero, z + zero])
    ahead = np.array([np.cos(theta) + zero, np.sin(theta) + zero])
    up = np.array([-np.sin(theta) + zero, np.cos(theta) + zero])
    a1, a2, a3, a4 = (np.pi / 180.0 * g[f"alpha{k}_deg"] for k in range(1, 5))

    def hang(reach: Numbers, angle: Numbers) -> Numbers:
        """A bar of that length; straight down at angle 0."""
        return np.array([reach * np.sin(angle) + zero, -reach * np.cos(angle) + zero])

    low = g["d3"] + g["d4"]
    d = a - (g["d1"] + g["d2"]) * ahead - low * up
    e = a + (g["d14"] + g["d15"]) * ahead - low * up
    f = a - (low + g["d5"]) * up
    bar = t4 + a3 - a4
    s = d - hang(front_arm, t4 + a3)
    return {
        "A": a, "B": d + g["d2"] * ahead + g["d4"] * up, "C": e - g["d15"] * ahead + g["d4"] * up,
        "D": d, "E": e, "F": f, "G": lambda com: a + com[0] * ahead + com[1] * up,
        "H": f + hang(g["d7"], t1 + a1), "I": f + hang(g["d6"], t1),
        "J": f - hang(g["d7"], t2), "K": f - hang(g["d6"], t2 + a1),
        "L": e + hang(g["d8"], t3 + a2), "M": e + hang(g["d9"], t3), "N": d - hang(g["d10"], t4),
        "S": s, "O": s - hang(g["d12"], bar), "P": s + hang(g["d13"], bar),
    }  # fmt: skip


def arcs(lengths: Array, state: Array, inputs: Inputs) -> Array:
    """(6, c) rad, what the belt turns at each wheel; negative where the wheel would not touch it."""
    g = dict(zip(LENGTHS, lengths[:, None], strict=True))
    p = points(state[:7], g, inputs.front_arm)
    return np.array(belt([p[name] for name in "AOPKIM"], [g[f"r{k}"] for k in range(1, 7)])[2])


def belt(wheels: Sequence[Numbers], radii: Sequence[Numbers]) -> tuple[Numbers, list[Numbers], list[Numbers]]:
    """Length of a belt around wheels, forces on the centres at unit tension, arcs: Appendix D, corrected.

    A wheel that would not touch counts with a negative arc: on level ground the road wheels between the
    ends lie on the belt's straight part, where length and forces are the same either way.

    Args:
        wheels: centres (2, ...), counter-clockwise.
        radii: theirs.
    """
    count = len(wheels)
    along, spans = [], []
    for i in range(count):
        j = (i + 1) % count
        apart, less = wheels[j] - wheels[i], radii[i] - radii[j]
        square = apart[0] ** 2 + apart[1] ** 2
        span = np.sqrt(square - less**2)
        along.append(
            np.array([span * apart[0] - less * apart[1], span * apart[1] + less * apart[0]]) / square
        )
        spans.append(span)
    length = sum(spans)
    pulls, turns = [], []
    for i in range(count):
        before, after = along[i - 1], along[i]
        turn = _angle(_turn(before, after), before[0] * after[0] + before[1] * after[1])
        length = length + radii[i] * turn
        pulls.append(after - before)
        turns.append(turn)
    return length, pulls, turns


def _turn(arm: Numbers, force: Numbers) -> Numbers:
    """Moment, counter-clockwise."""
    return arm[0] * force[1] - arm[1] * force[0]


def _angle(sine: Numbers, cosine: Numbers) -> Numbers:
    """atan2 with its first-order part, where the arguments are complex steps."""
    angle = np.arctan2(np.real(sine), np.real(cosine))
    if not (np.iscomplexobj(sine) or np.iscomplexobj(cosine)):
        return angle
    sine, cosine = sine + 0.0j, cosine + 0.0j
    square = sine.real**2 + cosine.real**2
    return angle + 1j * (cosine.real * sine.imag - sine.real * cosine.imag) / square
