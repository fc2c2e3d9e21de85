"""Appendix F of Ugenti et al.: a tracked robot whose road wheels slide on springs along the body's vertical.

No project code. mm, N, rad; X rearwards, Z up, theta counter-clockwise (nose down positive), points X + i Z.
Unknowns: X_G, Z_G, theta, L1..4, Fz1..4, T; equations (F.1) to (F.12), each wheel's with the track's pull
along the body's vertical, T times (t_out - t_in), which is the paper's for a wheel on level ground. A slack
track has T = 0, a wheel off the ground Fz = 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from damped_newton import newton
from taut_belt import Belt, taut


@dataclass(frozen=True)
class Setup:
    """What the model is given.

    Attributes:
        columns: mm, of wheels 2 to 5 along the body from G, rearwards positive.
        upper: mm, of wheels 1 and 6 from G: rearwards, upwards.
        radius: mm, of all wheels.
        mass: kg, of one side.
        stiffness: N/mm.
        rest: mm, length of a spring without force, from G's height down to the wheel's centre.
        track_length: mm.
        heights: mm, of the ground under wheels 2 to 5.
    """

    columns: tuple[float, ...] = (-315.0, -105.0, 105.0, 315.0)
    upper: tuple[complex, complex] = (-415.0 - 100.0j, 415.0 - 100.0j)
    radius: float = 65.0
    mass: float = 48.1
    stiffness: float = 12.0
    rest: float = 154.0
    track_length: float = 2083.497
    heights: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)
    gravity: float = 9.81


@dataclass(frozen=True)
class Answer:
    """A solution.

    Attributes:
        pose: Z_G (mm), theta (rad).
        lengths: mm, of the springs of wheels 2 to 5.
        loads: N.
        tension: N.
        slack: mm.
        x: (12,) the unknowns.
        tight: whether the track is.
        down: by wheel.
    """

    pose: tuple[float, float]
    lengths: np.ndarray
    loads: np.ndarray
    tension: float
    slack: float
    x: np.ndarray
    tight: bool
    down: tuple[bool, ...]

    @property
    def uneven(self) -> float:
        """sigma_N."""
        return float(np.std(self.loads) / np.mean(self.loads))


def belt_around(setup: Setup, x: np.ndarray) -> tuple[Belt, np.ndarray]:
    """The track, and the centres of wheels 1 to 6."""
    at, turn = x[0] + 1j * x[1], np.exp(1j * x[2])
    road = [c - 1j * q for c, q in zip(setup.columns, x[3:7], strict=True)]
    centers = at + turn * np.array([setup.upper[0], *road, setup.upper[1]])
    return taut(centers, np.full(6, setup.radius)), centers


def equations(x: np.ndarray, setup: Setup, tight: bool, down: tuple[bool, ...]) -> np.ndarray:
    """(12,) residuals: mm, N, moments over 100 mm."""
    belt, centers = belt_around(setup, x)
    lengths, loads, tension = x[3:7], x[7:11], x[11]
    up = 1j * np.exp(1j * x[2])
    r = [centers[1].real]
    for k in range(4):
        gap = centers[k + 1].imag - setup.radius - setup.heights[k]
        r.append(gap if down[k] else loads[k])
    r.append(belt.length - setup.track_length if tight else tension)
    for k in range(4):
        pull = tension * (belt.t_out[k + 1] - belt.t_in[k + 1]) if k + 1 in belt.on else 0.0
        spring = setup.stiffness * (setup.rest - lengths[k])
        r.append(((pull + 1j * loads[k]) * np.conj(up)).real - spring)
    weight = setup.mass * setup.gravity
    r.append(np.sum(loads) - weight)
    r.append(float(np.sum(loads * (centers[1:5].real - x[0]))) / 100.0)
    return np.array(r)


def solve(
    setup: Setup, x: np.ndarray, tight: bool = True, down: tuple[bool, ...] = (True,) * 4
) -> Answer | None:
    """From a nearby guess; branches of complementary pairs are corrected until the answer bears them out."""
    for _ in range(12):
        found = newton(partial(equations, setup=setup, tight=tight, down=down), x, _STEP, _REACH)
        if found is None:
            return None
        belt, centers = belt_around(setup, found)
        slack = setup.track_length - belt.length
        gaps = [c.imag - setup.radius - h for c, h in zip(centers[1:5], setup.heights, strict=True)]
        wrong = [-n if d else -g for d, n, g in zip(down, found[7:11], gaps, strict=True)]
        k = int(np.argmax(wrong))
        if wrong[k] > 1e-7:
            down = tuple(d != (i == k) for i, d in enumerate(down))
        elif (tight and found[11] < -1e-7) or (not tight and slack < -1e-7):
            tight = not tight
        else:
            pose = (float(found[1]), float(found[2]))
            return Answer(pose, found[3:7], found[7:11], float(found[11]), slack, found, tight, down)
        x = found
    return None


def follow(setup: Setup, steps: int = 8) -> Answer:
    """From level ground to the setup's heights.

    Raises:
        ArithmeticError: no way there.
    """
    weight = setup.mass * setup.gravity
    length = setup.rest - weight / 4.0 / setup.stiffness
    x = np.array([315.0, length + setup.radius, 0.0, *[length] * 4, *[weight / 4.0] * 4, 0.0])
    answer = solve(replace(setup, heights=(0.0,) * 4), x)
    for s in np.linspace(0.0, 1.0, steps + 1)[1:]:
        if answer is None:
            break
        part = replace(setup, heights=tuple(float(s) * h for h in setup.heights))
        answer = solve(part, answer.x, answer.tight, answer.down)
    if answer is None:
        raise ArithmeticError("the way ends")
    return answer


_STEP = np.array([1e-4, 1e-4, 1e-6, *[1e-4] * 4, *[1e-3] * 5])
_REACH = np.array([50.0, 50.0, 0.2, *[50.0] * 4, *[np.inf] * 5])
