"""What a batch answers: arrays with the case first, and the words that go with them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rover_pin.compiled.kernel import Out
from rover_pin.compiled.margins import ON_EDGES
from rover_pin.compiled.posed import Integers
from rover_pin.compiled.settle import GROUNDED, OFF_MAP, OPEN, SETTLED
from rover_pin.numerics import Array
from rover_pin.statics.stance import Status

if TYPE_CHECKING:
    from rover_pin.rover import Rover

COMPILED_MEASURES = ("loads", *ON_EDGES, "clearance")
"""Measures that the kernels have; the others need a Stance."""

Labelled = tuple[list[str], Array, Integers]


@dataclass(frozen=True)
class Answers:
    """Answers of n cases; numbers are NaN where a case is not settled.

    Attributes:
        code: (n,) SETTLED, GROUNDED, OFF_MAP, or OPEN: the plain path (`rover_pin.settle`) has to answer.
        who: (n,) GROUNDED: index into `links`; OFF_MAP: index into `wheels`; else -1.
        depth_m: (n,) GROUNDED: how deep.
        z_m, roll_rad, pitch_rad: (n,) of the root link.
        joint_rad: (n, joints) in the rover's order; m where a joint slides.
        load_n: (n, wheels) N.
        tension_n: (n, tracks) N.
        redundant: (n,) how many more supports there are than equilibrium determines.
        equilibrium, gap_m, loop_m, complementarity: (n,) residuals, as of a `Stance`.
        value: (n,) per measure asked; -inf where it fails closed.
        wheels: names of wheels, then feet.
        tracks: names of tracks.
        bearing: which of them should carry (`Rover.bearing`).
        links: the link of each point of the underside.
        belly: names of the belly's points.
    """

    code: NDArray[np.uint8]
    who: Integers
    depth_m: Array
    z_m: Array
    roll_rad: Array
    pitch_rad: Array
    joint_rad: Array
    load_n: Array
    tension_n: Array
    redundant: Integers
    equilibrium: Array
    gap_m: Array
    loop_m: Array
    complementarity: Array
    value: dict[str, Array]
    wheels: tuple[str, ...]
    tracks: tuple[str, ...]
    bearing: tuple[int, ...]
    links: tuple[str, ...]
    belly: tuple[str, ...]
    _out: Out = field(repr=False)

    def __len__(self) -> int:
        """The number of cases."""
        return len(self.code)

    @property
    def settled(self) -> NDArray[np.bool_]:
        """(n,) whether a case is answered by a stance."""
        there: NDArray[np.bool_] = self.code == SETTLED
        return there

    def labelled(self, measure: str) -> Labelled:
        """A measure along its edges.

        Args:
            measure: one of those asked.

        Returns:
            sorted names (edges, wheels or belly points), (n, names) values, NaN where a case has no such
            edge, and (n,) the index of the limiting name, -1 where there is none.
        """
        if measure == "loads":
            names = [self.wheels[k] for k in self.bearing]
            return _ranked(names, shares(self.load_n[:, self.bearing]), self.settled)
        if measure == "clearance":
            return _ranked(self.belly, np.where(self.settled[:, None], self._out.belly, np.nan), self.settled)
        return self._on_polygon(ON_EDGES.index(measure))

    def _on_polygon(self, m: int) -> Labelled:
        names, place, rows, columns, labels = self._pairs
        table = np.full((len(self), len(names)), np.nan)
        table[rows, labels] = self._out.edges[rows, m, columns]
        limiting = self._out.limiting[:, m]
        named = np.flatnonzero(limiting >= 0)
        index = np.full(len(self), -1, dtype=np.int64)
        index[named] = place[named, limiting[named]]
        return list(names), table, index

    @cached_property
    def _pairs(self) -> tuple[list[str], Integers, Integers, Integers, Integers]:
        """Edge names; (n, s) the name of each edge of each case; where there are edges, and their names."""
        wheels, corners = len(self.wheels), self._out.corners
        there = corners >= 0
        last = np.maximum(np.count_nonzero(there, axis=1) - 1, 0)
        following = np.roll(corners, -1, axis=1)
        following[np.arange(len(corners)), last] = corners[:, 0]
        pair = corners * wheels + following
        found = np.flatnonzero(np.bincount(pair[there], minlength=wheels * wheels)).tolist()
        words = {k: f"{self.wheels[k // wheels]}-{self.wheels[k % wheels]}" for k in found}
        order = sorted(found, key=words.__getitem__)
        rank = np.full(wheels * wheels, -1, dtype=np.int64)
        rank[order] = np.arange(len(order))
        place = rank[pair]
        rows, columns = np.nonzero(there)
        return [words[k] for k in order], place, rows, columns, place[rows, columns]

    def words(self) -> tuple[NDArray[np.str_], NDArray[np.str_]]:
        """Status and reason of every case, as the plain path words them; both empty where it is open."""
        status = np.full(len(self), "", dtype="U14")
        status[self.code == SETTLED] = Status.SETTLED.value
        status[self.code == GROUNDED] = Status.GROUNDED.value
        status[self.code == OFF_MAP] = Status.OFF_MAP.value
        reasons = {
            int(i): f"{self.links[self.who[i]]} is {self.depth_m[i]:.3g} m in the ground"
            for i in np.flatnonzero(self.code == GROUNDED)
        }
        reasons |= {
            int(i): f"{self.wheels[self.who[i]]} reaches beyond the map"
            for i in np.flatnonzero(self.code == OFF_MAP)
        }
        longest = max((len(text) for text in reasons.values()), default=1)
        reason = np.full(len(self), "", dtype=f"U{longest}")
        for i, text in reasons.items():
            reason[i] = text
        return status, reason


def shares(loads: Array) -> Array:
    """(n, wheels) each wheel's load over the mean load."""
    total = loads[:, 0].copy()
    for k in range(1, loads.shape[1]):
        total += loads[:, k]
    result: Array = loads / (total / loads.shape[1])[:, None]
    return result


def _ranked(names: Sequence[str], values: Array, settled: NDArray[np.bool_]) -> Labelled:
    """A table whose columns stand in the order of their names; a case's first least value limits it."""
    order = sorted(range(len(names)), key=names.__getitem__)
    place = np.empty(len(names), dtype=np.int64)
    place[order] = np.arange(len(names))
    index = np.full(len(values), -1, dtype=np.int64)
    if len(names):
        index[settled] = place[np.argmin(values[settled], axis=1)]
    return [names[k] for k in order], np.ascontiguousarray(values[:, order]), index


def blank(rover: Rover, count: int, measured: bool, free: int = 0) -> Out:
    """Room for the answers of `count` cases."""
    shapes, corners = len(rover.shapes), len(rover.shapes) if measured else 0
    rows = count if measured else 0
    return Out(
        code=np.full(count, OPEN, dtype=np.uint8),
        who=np.full(count, -1, dtype=np.int64),
        depth=np.zeros(count),
        redundant=np.zeros(count, dtype=np.int64),
        z=np.full((count, free if free else 3), np.nan),
        loads=np.full((count, shapes), np.nan),
        residuals=np.full((count, 4), np.nan),
        corners=np.full((rows, corners), -1, dtype=np.int64),
        edges=np.full((rows, len(ON_EDGES), corners), np.nan),
        limiting=np.full((rows, len(ON_EDGES)), -1, dtype=np.int64),
        belly=np.full((rows, len(rover.belly)), np.nan),
        tensions=np.full((count, len(rover.tracks)), np.nan),
    )


def answers_of(
    rover: Rover, measures: Sequence[str], out: Out, joint_rad: Array, links: tuple[str, ...]
) -> Answers:
    """What the loops filled in, in the words of users."""
    settled = out.code == SETTLED
    keep = np.where(settled, 0.0, np.nan)
    seen: dict[str, int] = {}
    value: dict[str, Array] = {}
    loads = out.loads + keep[:, None]
    for name in measures:
        if name in ON_EDGES:
            m = ON_EDGES.index(name)
            limiting = out.limiting[:, m]
            found = np.take_along_axis(out.edges[:, m], np.maximum(limiting, 0)[:, None], axis=1)[:, 0]
            value[name] = np.where(limiting >= 0, found, -np.inf) + keep
        elif name == "loads":
            value[name] = np.min(shares(loads[:, rover.bearing]), axis=1)
        else:
            value[name] = np.min(out.belly, axis=1, initial=np.inf) + keep
    return Answers(
        code=out.code,
        who=out.who,
        depth_m=out.depth,
        z_m=out.z[:, 0] + keep,
        roll_rad=out.z[:, 2] + keep,
        pitch_rad=out.z[:, 1] + keep,
        joint_rad=joint_rad + keep[:, None],
        load_n=loads,
        tension_n=out.tensions + keep[:, None],
        redundant=out.redundant,
        equilibrium=out.residuals[:, 0] + keep,
        gap_m=out.residuals[:, 1] + keep,
        loop_m=out.residuals[:, 2] + keep,
        complementarity=out.residuals[:, 3] + keep,
        value=value,
        wheels=tuple(shape.name for shape in rover.shapes),
        tracks=tuple(track.name for track in rover.tracks),
        bearing=rover.bearing,
        links=links,
        belly=tuple(_numbered(point.link, seen) for point in rover.belly),
        _out=out,
    )


def _numbered(link: str, seen: dict[str, int]) -> str:
    """`body`, then `body#2` for a link's further points."""
    seen[link] = seen.get(link, 0) + 1
    return link if seen[link] == 1 else f"{link}#{seen[link]}"
