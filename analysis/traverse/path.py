"""The line that is driven: waypoints, and the places along it that are looked at."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from rover_pin.errors import InputError, OffMapError
from rover_pin.numerics import Array, frozen

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain

MOST = 200_000
"""The most places along a path."""

TURN = math.radians(10.0)
"""The most that it turns on the spot from place to place."""

Waypoints: TypeAlias = "str | Path | Sequence[Sequence[float]] | Array"


@dataclass(frozen=True)
class Place:
    """Where the root link's frame is held.

    Attributes:
        way: m driven since the first waypoint.
        x: m, world.
        y: m, world.
        yaw: rad, without jumps of a whole turn.
        turning: whether it turns on the spot here.
    """

    way: float
    x: float
    y: float
    yaw: float
    turning: bool = False

    def towards(self, other: Place, share: float) -> Place:
        """A share of the way to another."""
        mine, its = ((p.way, p.x, p.y, p.yaw) for p in (self, other))
        way, x, y, yaw = (a + share * (b - a) for a, b in zip(mine, its, strict=True))
        return Place(way, x, y, yaw, self.turning)


def waypoints(path: Waypoints) -> Array:
    """(n, 2) m: `x1,y1;x2,y2;...`, a CSV file of two columns, or the numbers; repeated ones once.

    Raises:
        InputError: no such file, no pair of finite numbers, fewer than two different points.
    """
    file = None
    if isinstance(path, Path) or (isinstance(path, str) and _is_file(path)):
        file = Path(path)
        points = list(_from_file(file))
    elif isinstance(path, str):
        words = [word for word in path.split(";") if word.strip()]
        points = [_pair(word.split(","), f"waypoint {k}", None) for k, word in enumerate(words, 1)]
    else:
        points = [_pair(point, f"waypoint {k}", None) for k, point in enumerate(_listed(path), 1)]
    kept = [point for k, point in enumerate(points) if not k or point != points[k - 1]]
    if len(kept) < 2:
        raise InputError(
            "needs two different waypoints",
            file=file,
            element="path",
            value=";".join(f"{x:g},{y:g}" for x, y in kept) or "nothing",
            cure="write x1,y1;x2,y2 in m",
        )
    return frozen(kept)


def _is_file(text: str) -> bool:
    """Whether a word can only be the name of a file."""
    return not set(text) <= set("0123456789+-.,;eE naif\t")


def _listed(path: object) -> Sequence[Sequence[object]]:
    try:
        points = [tuple(point) for point in path]  # type: ignore[attr-defined]
    except TypeError:
        cure = "give (x, y) pairs [m], 'x1,y1;x2,y2', or a CSV file"
        raise InputError("is no path", element="path", value=str(path), cure=cure) from None
    return points


def _from_file(file: Path) -> Iterator[tuple[float, float]]:
    """The pairs of a CSV file; empty lines, `#` comments and one line of names are passed over."""
    try:
        lines = file.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        why = "is no text" if isinstance(error, UnicodeDecodeError) else (error.strerror or "cannot be read")
        cure = "give x1,y1;x2,y2 in m, or a CSV file of two columns"
        raise InputError(why, file=file, element="path", cure=cure) from error
    first = True
    for number, text in enumerate(lines, 1):
        words = text.partition("#")[0].replace(";", ",").split(",")
        if not any(word.strip() for word in words):
            continue
        named = first and not any(_is_number(word) for word in words)
        first = False
        if not named:
            yield _pair(words, f"line {number}", file)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _pair(words: Sequence[object], element: str, file: Path | None) -> tuple[float, float]:
    """Two finite numbers."""
    told = ",".join(str(word).strip() for word in words)
    cure = "write x,y in m"
    try:
        x, y = (float(word) for word in words)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        message = "is no pair of numbers"
        raise InputError(message, file=file, element=f"path, {element}", value=told, cure=cure) from None
    if not (math.isfinite(x) and math.isfinite(y)):
        message = "is not finite"
        raise InputError(message, file=file, element=f"path, {element}", value=told, cure=cure)
    return x, y


def check_on_map(points: Array, terrain: Terrain) -> None:
    """Refuse a waypoint beyond the map; between two on the map the path is on it.

    Raises:
        OffMapError: names the first one.
    """
    for k, (x, y) in enumerate(points, 1):
        if not bool(terrain.covers(x, y)):
            xmin, xmax, ymin, ymax = terrain.extent
            raise OffMapError(
                f"waypoint {k} of the path is not on the map",
                element=terrain.label,
                value=f"{x:g},{y:g}",
                cure=f"the map spans x {xmin:g} to {xmax:g} m, y {ymin:g} to {ymax:g} m;"
                " wheels need their room too",
            )


def places(points: Array, step: float, crab: float) -> list[Place]:
    """Places at most `step` apart on every leg, both ends included; at a corner it turns on the spot.

    Args:
        points: (n, 2) m.
        step: m.
        crab: rad; the heading from the path's direction, counterclockwise from above.

    Raises:
        InputError: more than `MOST` places.
    """
    legs = np.diff(points, axis=0)
    lengths = np.linalg.norm(legs, axis=1)
    if float(np.sum(np.ceil(lengths / step))) > MOST:
        cure = f"at most {MOST}: make the step longer or the path shorter"
        raise InputError("makes too many places along the path", element="step", value=step, cure=cure)
    yaws = np.unwrap(np.arctan2(legs[:, 1], legs[:, 0])) + crab
    found: list[Place] = []
    way = 0.0
    for k, (start, leg, length) in enumerate(zip(points[:-1], legs, lengths, strict=True)):
        if k:
            found += _turn(found[-1], float(yaws[k]))
        count = max(1, math.ceil(length / step - 1e-9))
        for j in range(min(k, 1), count + 1):
            x, y = start + leg * (j / count)
            found.append(Place(way + float(length) * j / count, float(x), float(y), float(yaws[k])))
        way += float(length)
    return found


def _turn(at: Place, yaw: float) -> list[Place]:
    """On the spot to another heading."""
    count = math.ceil(abs(yaw - at.yaw) / TURN - 1e-9)
    headings = [at.yaw + (yaw - at.yaw) * j / count for j in range(1, count + 1)]
    return [Place(at.way, at.x, at.y, heading, True) for heading in headings]


def total(points: Array) -> float:
    """Length of a path, m."""
    return float(sum(math.dist(a, b) for a, b in pairwise(points)))
