"""The cases of a study, all drawn before the first one runs, so that no case knows how the work is cut."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_pin.analysis.quantities import Choice, Quantity, Span
from rover_pin.analysis.spec import MOST_CASES, CasesSpec
from rover_pin.errors import StudyError, nearest
from rover_pin.numerics import Array, frozen

POSTURE = "posture"
CIRCLE_DEG = 360.0


@dataclass(frozen=True)
class Case:
    """One question: where, heading which way (rad), in which posture, as which rover, with which friction."""

    x: float
    y: float
    yaw: float
    posture: str | None
    friction: float | None
    parameters: Mapping[str, float]
    joints: Mapping[str, float]


@dataclass(frozen=True)
class Cases:
    """Every case of a study, by columns of n values.

    Attributes:
        x, y: (n,) m.
        yaw: (n,) rad.
        postures: names of the postures that occur; empty where none was asked for.
        posture: (n,) index into `postures`.
        friction: (n,) or None where each wheel's declared friction counts.
        parameters, joints: name to (n,) values.
    """

    x: Array
    y: Array
    yaw: Array
    postures: tuple[str, ...]
    posture: NDArray[np.int64]
    friction: Array | None
    parameters: Mapping[str, Array]
    joints: Mapping[str, Array]

    def __len__(self) -> int:
        """The number of cases."""
        return len(self.x)

    def __getitem__(self, i: int) -> Case:
        """Case i."""
        return Case(
            float(self.x[i]),
            float(self.y[i]),
            float(self.yaw[i]),
            self.postures[self.posture[i]] if self.postures else None,
            None if self.friction is None else float(self.friction[i]),
            {name: float(values[i]) for name, values in self.parameters.items()},
            {name: float(values[i]) for name, values in self.joints.items()},
        )

    @property
    def digest(self) -> str:
        """Hex of everything the cases say."""
        hasher = hashlib.sha256(repr((self.postures, *self.parameters, *self.joints)).encode())
        columns = [self.x, self.y, self.yaw, self.posture, *self.parameters.values(), *self.joints.values()]
        for column in [*columns, *([] if self.friction is None else [self.friction])]:
            hasher.update(np.ascontiguousarray(column).tobytes())
        return hasher.hexdigest()


@dataclass(frozen=True)
class Questions:
    """What varies, with the map resolved to numbers, in the order that samplers follow."""

    place: Mapping[str, Quantity]
    friction: Quantity | None
    parameters: Mapping[str, Quantity]
    joints: Mapping[str, Quantity]
    postures: tuple[str, ...]

    @property
    def columns(self) -> dict[str, Quantity]:
        """Every quantity by its name; the last varies fastest in a grid."""
        posture: Quantity = Choice(tuple(float(i) for i in range(max(1, len(self.postures)))))
        friction = {} if self.friction is None else {"friction": self.friction}
        return {**self.parameters, POSTURE: posture, **self.joints, **friction, **self.place}


def draw(questions: Questions, spec: CasesSpec) -> Cases:
    """All cases.

    Raises:
        StudyError: a grid without its counts, a count of what does not vary, or too many cases.
    """
    columns = questions.columns
    drawn = _grid(columns, spec) if spec.sampler == "grid" else _sobol(columns, questions.parameters, spec)
    return Cases(
        x=frozen(drawn["x"]),
        y=frozen(drawn["y"]),
        yaw=frozen(np.deg2rad(drawn["yaw_deg"])),
        postures=questions.postures,
        posture=drawn[POSTURE].astype(np.int64),
        friction=frozen(drawn["friction"]) if questions.friction is not None else None,
        parameters={name: frozen(drawn[name]) for name in questions.parameters},
        joints={name: frozen(drawn[name]) for name in questions.joints},
    )


def _sobol(columns: Mapping[str, Quantity], parameters: Iterable[str], spec: CasesSpec) -> dict[str, Array]:
    """Scrambled Sobol points over what varies; what is fixed takes no dimension.

    Parameters are Sobol points of their own, one a robot; robot k stands in the k-th run of cases, and a run
    of Sobol points covers the rest evenly too.
    """
    n = spec.number
    robots = min(spec.robots, n)
    varying = [name for name, asked in columns.items() if asked.varies]
    built = [name for name in varying if name in set(parameters)]
    others = [name for name in varying if name not in built]
    place = dict(zip(others, _unit(len(others), n, [spec.seed]).T, strict=True))
    run = np.arange(n) * robots // n
    place |= dict(zip(built, _unit(len(built), robots, [spec.seed, 1])[run].T, strict=True))
    return {name: _spread(asked, place.get(name, np.zeros(n))) for name, asked in columns.items()}


def _unit(dimensions: int, n: int, seed: Sequence[int]) -> Array:
    """(n, dimensions) scrambled Sobol points: the first of the next power of two, where they are balanced."""
    from scipy.stats import qmc

    if dimensions == 0:
        return np.empty((n, 0))
    sampler = qmc.Sobol(dimensions, scramble=True, seed=np.random.default_rng(seed))
    points: Array = sampler.random_base2(max(0, math.ceil(math.log2(n))))[:n]
    return points


def _spread(asked: Quantity, unit: Array) -> Array:
    """Numbers in [0, 1) spread over a quantity."""
    if isinstance(asked, Span):
        return asked.low + (asked.high - asked.low) * unit
    values = np.asarray(asked.values)
    return values[np.minimum((unit * len(values)).astype(np.int64), len(values) - 1)]


def _grid(columns: Mapping[str, Quantity], spec: CasesSpec) -> dict[str, Array]:
    """Every combination; the last column varies fastest."""
    counts = _counts(columns, spec)
    axes = {name: _ticks(name, asked, counts.get(name, 1)) for name, asked in columns.items()}
    total = math.prod(len(axis) for axis in axes.values())
    if total > MOST_CASES:
        raise StudyError(
            "has too many cases", element="cases.grid", value=total, cure=f"at most {MOST_CASES}"
        )
    mesh = np.meshgrid(*axes.values(), indexing="ij")
    return {name: values.ravel() for name, values in zip(axes, mesh, strict=True)}


def _counts(columns: Mapping[str, Quantity], spec: CasesSpec) -> dict[str, int]:
    """How many ticks each range gets."""
    ranges = [name for name, asked in columns.items() if isinstance(asked, Span) and asked.varies]
    if spec.grid is None:
        if spec.n is None:
            cure = f"write cases: {{grid: {{{', '.join(f'{name}: 10' for name in ranges)}}}}}"
            raise StudyError("a grid needs a count for each range, or n", element="cases", cure=cure)
        choices = math.prod(len(asked.values) for asked in columns.values() if isinstance(asked, Choice))
        each = _root(spec.n // choices, len(ranges))
        return dict.fromkeys(ranges, each)
    for name in spec.grid:
        if name not in ranges:
            what = "counts a quantity that is no range" if name in columns else "counts an unknown quantity"
            raise StudyError(what, element=f"cases.grid.{name}", cure=nearest(name, ranges))
    for name in ranges:
        if name not in spec.grid:
            raise StudyError("has no count", element=f"cases.grid.{name}", cure=f"add {name}: 10")
    return dict(spec.grid)


def _root(n: int, power: int) -> int:
    """The largest k >= 1 with k**power <= n."""
    if power == 0:
        return 1
    k: int = max(1, round(float(n) ** (1.0 / power)))
    while k > 1 and k**power > n:
        k -= 1
    return k


def _ticks(name: str, asked: Quantity, count: int) -> Array:
    """The values of one axis of a grid; a whole circle does not repeat its first heading."""
    if isinstance(asked, Choice):
        return np.asarray(asked.values)
    if not asked.varies or count == 1:
        return np.array([0.5 * (asked.low + asked.high)])
    whole = name == "yaw_deg" and math.isclose(asked.high - asked.low, CIRCLE_DEG)
    return np.linspace(asked.low, asked.high, count, endpoint=not whole)
