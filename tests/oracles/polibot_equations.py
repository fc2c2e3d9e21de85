"""The 21 equations of Ugenti et al. for Polibot's half model, corrected, solved by Newton: no project code.

mm, N, rad; X rearwards, Z up, angles counter-clockwise (theta: nose down positive), points as X + i Z.
Unknowns: X_A, Z_A, theta, theta1..4 and T1, T2, F3..F6, N3..N6, k_c, Fel1..3 (Tables 3 and 4). Equations: (2)
to (7), (8) with its moments from the free bodies, (10) and (11). What is printed wrong there and corrected:

- B.5 to B.8: theta in the subframe's terms. C.1: L1 = distance H to J, and Fel1 along it.
- D.1, D.6, D.7: see `taut_belt`.
- E.3, E.5, E.7 and rows 3 to 8 of (8): moments of all forces about G and about the arms' hinges. A wheel's
  centre takes T_in (t_c - t_in) + T_out (t_out - t_c) + N upwards: the ground's tangential force pulls on the
  track, whose tension steps from T_in to T_out = T_in + F_i at the wheel's contact (t_c the track's direction
  there). On level ground these are the paper's terms: T2 at the bottom of wheel 3, T1 at that of wheel 6.

Contacts are at the wheels' lowest points. Where the paper's regime does not hold, an equation gives way to
its complement: N_i = 0 for a wheel off the ground, T2 = 0 for a slack track, L = Lmax for a spring below its
preload.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from damped_newton import newton
from taut_belt import Belt, around, taut

IDENTIFIED = {
    "d1": 143.650, "d2": 0.0, "d3": 29.867, "d4": 115.836, "d5": 25.262, "d6": 152.554, "d7": 105.637,
    "d8": 180.960, "d9": 286.402, "d10": 154.873, "d11": 198.0, "d12": 130.0, "d13": 54.808, "d14": 0.0,
    "d15": 33.357, "alpha1": np.radians(80.233), "alpha2": np.radians(74.475), "alpha3": np.radians(46.458),
    "alpha4": np.radians(80.849), "r1": 66.0, "r2": 80.0, "r3": 65.0, "r4": 60.0, "r5": 60.298, "r6": 70.0,
}  # fmt: skip
"""Geometry identified from Tables 6 to 8: mm, rad."""

ROAD = (3, 4, 5, 6)
TABLE_6 = (311.0, 303.3, *np.radians([4.41, 61.6, 38.3, 71.6, 52.2]))

Terrain = Callable[[float], float]


@dataclass(frozen=True)
class Setup:
    """What the paper's model is given (Table 5), and the terrain.

    Attributes:
        geometry: mm, rad.
        mass: kg, of one side.
        com: mm, of G from A in the subframe, X rearwards: the paper's (50, -100) is X forwards.
        track_length: mm.
        stiffness: N/mm.
        preload, length_max: N, mm, of springs 1 to 3.
        resistance: N, F_v at G, against the heading.
        terrain: mm, heights under wheels 3 to 6, or f_te(X).
        x_first: mm, X of wheel 3's contact.
        gravity: m/s^2.
    """

    geometry: Mapping[str, float] = field(default_factory=lambda: dict(IDENTIFIED))
    mass: float = 48.1
    com: tuple[float, float] = (-50.0, -100.0)
    track_length: float = 2026.0
    stiffness: float = 12.0
    preload: tuple[float, float, float] = (60.0, 0.0, 120.0)
    length_max: tuple[float, float, float] = (150.0, 150.0, 130.0)
    resistance: float = 0.0
    terrain: Sequence[float] | Terrain = (0.0, 0.0, 0.0, 0.0)
    x_first: float = 0.0
    gravity: float = 9.81

    def heights(self, xs: Sequence[float]) -> list[float]:
        """Of the terrain under wheels 3 to 6."""
        if callable(self.terrain):
            return [self.terrain(x) for x in xs]
        return list(self.terrain)


@dataclass(frozen=True)
class Regime:
    """Which branch of each complementary pair holds.

    Attributes:
        down: wheels 3 to 6 that touch the ground.
        tight: whether the track is.
        pressed: springs 1 to 3 that are above their preload.
        on: wheels (0 to 5) that the belt touches, None: as `taut` finds.
    """

    down: tuple[bool, ...] = (True,) * 4
    tight: bool = True
    pressed: tuple[bool, ...] = (True,) * 3
    on: tuple[int, ...] | None = None


@dataclass(frozen=True)
class Answer:
    """A solution.

    Attributes:
        pose: X_A, Z_A (mm), theta, theta1..4 (rad).
        t1, t2: N, tight and slack strand.
        traction, loads: N, by wheel 3 to 6.
        ratio: k_c.
        springs: N, Fel1..3.
        slack: mm, of the track.
        gaps: mm, by wheel 3 to 6.
        regime: as found.
        points: mm, by the paper's letters.
        residual: largest, mm or N (moments over 100 mm).
    """

    pose: np.ndarray
    t1: float
    t2: float
    traction: np.ndarray
    loads: np.ndarray
    ratio: float
    springs: np.ndarray
    slack: float
    gaps: np.ndarray
    regime: Regime
    points: dict[str, complex]
    residual: float
    x: np.ndarray

    @property
    def theta_deg(self) -> float:
        """Pitch, nose down positive."""
        return float(np.degrees(self.pose[2]))

    @property
    def uneven(self) -> float:
        """sigma_N, (12) with the mean over wheels 3 to 6."""
        return float(np.std(self.loads) / np.mean(self.loads))


def places(g: Mapping[str, float], pose: np.ndarray) -> dict[str, complex]:
    """Appendix B and Fig. 5: every lettered point, X + i Z."""
    a = pose[0] + 1j * pose[1]
    ahead, up = np.exp(1j * pose[2]), 1j * np.exp(1j * pose[2])
    hang = lambda r, angle: -1j * r * np.exp(1j * angle)  # noqa: E731  (angle 0: straight down)
    t1, t2, t3, t4 = pose[3:]
    d, e = a - (g["d1"] + g["d2"]) * ahead, a + (g["d14"] + g["d15"]) * ahead
    d, e = d - (g["d3"] + g["d4"]) * up, e - (g["d3"] + g["d4"]) * up
    f = a - (g["d3"] + g["d4"] + g["d5"]) * up
    s, bar = d - hang(g["d11"], t4 + g["alpha3"]), t4 + g["alpha3"] - g["alpha4"]
    return {
        "A": a, "B": d + g["d2"] * ahead + g["d4"] * up, "C": e - g["d15"] * ahead + g["d4"] * up,
        "D": d, "E": e, "F": f,
        "H": f + hang(g["d7"], t1 + g["alpha1"]), "I": f + hang(g["d6"], t1),
        "J": f - hang(g["d7"], t2), "K": f - hang(g["d6"], t2 + g["alpha1"]),
        "L": e + hang(g["d8"], t3 + g["alpha2"]), "M": e + hang(g["d9"], t3),
        "N": d - hang(g["d10"], t4), "S": s, "O": s - hang(g["d12"], bar), "P": s + hang(g["d13"], bar),
    }  # fmt: skip


def _turn(arm: complex, force: complex) -> float:
    """Moment, counter-clockwise, over 100 mm."""
    return (arm.conjugate() * force).imag / 100.0


def belt_around(setup: Setup, p: Mapping[str, complex], on: tuple[int, ...] | None) -> Belt:
    """The track around wheels 1 to 6 (0 to 5 here)."""
    centers = np.array([p[k] for k in "AOPKIM"])
    radii = np.array([setup.geometry[f"r{i}"] for i in range(1, 7)])
    return taut(centers, radii) if on is None else around(centers, radii, on)


def wheel_forces(belt: Belt, t2: float, traction: np.ndarray, loads: np.ndarray) -> dict[int, complex]:
    """What track and ground press on the centres of wheels 2 to 6 [N].

    A wheel that the belt passes straight presses it to the ground all the same: t_in = t_out.
    """
    forces, tension, way = {}, t2, belt.t_out[0]
    for i in range(1, 6):
        n, f = (loads[i - 2], traction[i - 2]) if i > 1 else (0.0, 0.0)
        t_in, t_out = way, belt.t_out.get(i, way)
        forces[i] = tension * (1.0 - t_in) + (tension + f) * (t_out - 1.0) + 1j * n
        tension, way = tension + f, t_out
    return forces


def equations(x: np.ndarray, setup: Setup, regime: Regime) -> np.ndarray:
    """(21,) residuals: mm, N, moments over 100 mm."""
    pose, t1, t2, fs, ns, kc, fel = x[:7], x[7], x[8], x[9:13], x[13:17], x[17], x[18:21]
    g = setup.geometry
    p = places(g, pose)
    centers = [p[k] for k in "PKIM"]
    belt = belt_around(setup, p, regime.on)
    floor = setup.heights([c.real for c in centers])
    r = [p["P"].real - setup.x_first]
    for k, c in enumerate(centers):
        r.append(c.imag - g[f"r{ROAD[k]}"] - floor[k] if regime.down[k] else ns[k])
    r.append(belt.length - setup.track_length if regime.tight else t2)
    weight = setup.mass * setup.gravity
    at_g = p["A"] + complex(*setup.com) * np.exp(1j * pose[2])
    r += [np.sum(fs) - setup.resistance, np.sum(ns) - weight]
    feet = [c - 1j * g[f"r{i}"] for c, i in zip(centers, ROAD, strict=True)]
    r.append(sum(_turn(c - at_g, -f + 1j * n) for c, f, n in zip(feet, fs, ns, strict=True)))
    push = wheel_forces(belt, t2, fs, ns)
    ends = [(p["H"], p["J"]), (p["L"], p["C"]), (p["N"], p["B"])]
    lengths = [abs(a - b) for a, b in ends]
    s1, s2, s3 = (fel[k] * (a - b) / lengths[k] for k, (a, b) in enumerate(ends))
    r.append(_turn(p["I"] - p["F"], push[4]) + _turn(p["H"] - p["F"], s1))
    r.append(_turn(p["K"] - p["F"], push[3]) + _turn(p["J"] - p["F"], -s1))
    r.append(_turn(p["M"] - p["E"], push[5]) + _turn(p["L"] - p["E"], s2))
    front = _turn(p["O"] - p["D"], push[1]) + _turn(p["P"] - p["D"], push[2])
    r.append(front + _turn(p["N"] - p["D"], s3))
    r.append(np.sum(fs) - t1 + t2)
    r += list(fs - kc * ns)
    for k in range(3):
        short = (fel[k] - setup.preload[k]) / setup.stiffness if regime.pressed[k] else 0.0
        r.append(lengths[k] - setup.length_max[k] + short)
    return np.array(r)


def start() -> np.ndarray:
    """(21,) Table 6 with forces of the right size."""
    return np.array([*TABLE_6, 300.0, 300.0, 0, 0, 0, 0, 100.0, 150, 150, 50, 0, 300.0, 200.0, 300.0])


_STEP = np.array([1e-4, 1e-4, *[1e-6] * 5, *[1e-3] * 10, 1e-6, *[1e-3] * 3])
_REACH = np.array([50.0, 50.0, *[0.2] * 5, *[np.inf] * 14])


def _read(x: np.ndarray, setup: Setup, regime: Regime) -> Answer:
    pose = x[:7]
    p = places(setup.geometry, pose)
    centers = [p[k] for k in "PKIM"]
    floor = setup.heights([c.real for c in centers])
    gaps = np.array(
        [c.imag - setup.geometry[f"r{i}"] - z for c, i, z in zip(centers, ROAD, floor, strict=True)]
    )
    slack = setup.track_length - belt_around(setup, p, None).length
    size = float(np.max(np.abs(equations(x, setup, regime))))
    return Answer(
        pose, x[7], x[8], x[9:13], x[13:17], float(x[17]), x[18:21], slack, gaps, regime, p, size, x
    )


def _corrected(answer: Answer, setup: Setup) -> Regime:
    """The regime with what the answer contradicts turned over, one pair at a time: wheels, track, springs."""
    regime = answer.regime
    wrong = [(-n if d else -gap) for d, n, gap in zip(regime.down, answer.loads, answer.gaps, strict=True)]
    k = int(np.argmax(wrong))
    if wrong[k] > 1e-7:
        down = tuple(d != (i == k) for i, d in enumerate(regime.down))
        return replace(regime, down=down)
    if (regime.tight and answer.t2 < -1e-7) or (not regime.tight and answer.slack < -1e-7):
        return replace(regime, tight=not regime.tight)
    for k in range(3):
        over = answer.springs[k] - setup.preload[k]
        length = abs(answer.points["HLN"[k]] - answer.points["JCB"[k]])
        if (regime.pressed[k] and over < -1e-7) or (
            not regime.pressed[k] and over > 1e-7 and length >= setup.length_max[k] - 1e-7
        ):
            return replace(regime, pressed=tuple(s != (i == k) for i, s in enumerate(regime.pressed)))
    return regime


def solve(setup: Setup, guess: np.ndarray | None = None, regime: Regime | None = None) -> Answer | None:
    """From a nearby guess: Newton in a regime, which is corrected until the answer bears it out."""
    x, regime = start() if guess is None else guess, regime or Regime()
    for _ in range(12):
        found = newton(partial(equations, setup=setup, regime=regime), x, _STEP, _REACH)
        if found is None:
            return None
        answer = _read(found, setup, regime)
        corrected = _corrected(answer, setup)
        if corrected == regime:
            return answer
        x, regime = found, corrected
    return None


def follow(setup: Setup, origin: Setup | None = None, steps: int = 4) -> Answer:
    """From the baseline (or another solvable setup) to `setup` in steps, halved where one fails.

    Heights must be given under the wheels, or as the same function in both.

    Raises:
        ArithmeticError: no way there.
    """
    origin = origin or Setup()
    answer = solve(origin)
    if answer is None:
        raise ArithmeticError("the baseline does not solve")
    s, step = 0.0, 1.0 / steps
    while s < 1.0:
        ahead = min(1.0, s + step)
        found = solve(between(origin, setup, ahead), answer.x, answer.regime)
        if found is None:
            step /= 2.0
            if step < 1e-4:
                raise ArithmeticError(f"the way ends at {s:.4f}")
            continue
        s, answer, step = ahead, found, step * 1.5
    return answer


def between(a: Setup, b: Setup, s: float) -> Setup:
    """The setup at a share s of the way from a to b."""
    mix = lambda u, v: u + s * (v - u)  # noqa: E731
    many = lambda u, v: tuple(mix(i, j) for i, j in zip(u, v, strict=True))  # noqa: E731
    terrain = b.terrain if callable(b.terrain) else many(a.terrain, b.terrain)
    return Setup(
        {k: mix(a.geometry[k], b.geometry[k]) for k in a.geometry}, mix(a.mass, b.mass), many(a.com, b.com),
        mix(a.track_length, b.track_length), mix(a.stiffness, b.stiffness), many(a.preload, b.preload),
        many(a.length_max, b.length_max), mix(a.resistance, b.resistance), terrain,
        mix(a.x_first, b.x_first), b.gravity,
    )  # fmt: skip
