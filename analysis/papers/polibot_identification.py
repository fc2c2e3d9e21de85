"""From Polibot's tables to a geometry, and how far the tables fix it.

    python -m rover_pin.analysis.papers.polibot_identification [--starts N] [--seed S] [--no-intervals]

The paper draws the suspension (Fig. A.1) without lengths in its text. Its model's results are there: Tables
6 to 8, and what it says of Figs 13, 14, 17 and 18. From starts drawn anywhere between wide bounds, lengths,
angles and radii are fitted to them; many quite different geometries meet every number to its last digit.
`polibot_half` has one of them.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from rover_pin.analysis.papers.polibot.certainty import Directions, directions, reach
from rover_pin.analysis.papers.polibot.planar import LENGTHS, geometry
from rover_pin.analysis.papers.polibot.search import (
    BOUNDS,
    FREE,
    Fit,
    closer,
    evaluated,
    search,
    starts,
    worst,
)
from rover_pin.analysis.papers.polibot.targets import TABLES, TARGETS
from rover_pin.numerics import Array

Progress = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Identification:
    """What the paper's numbers say of the geometry.

    Attributes:
        tried: starts.
        fits: where the searches that found a geometry ended: every target is met.
        bundled: the geometry of `polibot_half`, held against the same targets.
        near: where a search from the bundled geometry ends.
        by_tables: what Tables 6 to 8 alone fix about `bundled`, to first order.
        by_all: the same with the statements.
        intervals: by length, mm or deg: values between which geometries were found that meet every target;
            the true interval may be wider. Empty where they were not asked for.
    """

    tried: int
    fits: tuple[Fit, ...]
    bundled: Fit
    near: Fit
    by_tables: Directions
    by_all: Directions
    intervals: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    @property
    def best(self) -> Fit:
        """The fit with the least largest miss.

        Raises:
            ValueError: no search found one.
        """
        return min(self.fits, key=lambda fit: worst(fit, len(TARGETS)))


def identify(
    count: int = 20, seed: int = 1, *, intervals: bool = True, progress: Progress | None = None
) -> Identification:
    """Search from `count` starts, then measure what is fixed.

    Args:
        count: starts, a second or so each.
        seed: of the starts.
        intervals: whether to drive each length to its ends, a second or so each way.
        progress: told what is done.
    """
    tell = progress or _silent
    fits = []
    for k, start in enumerate(starts(count, seed)):
        fit = search(start)
        tell(f"start {k + 1} of {count}: largest miss {worst(fit, len(TARGETS)):.3g}")
        if fit.within:
            fits.append(fit)
    bundled = evaluated(bundled_lengths())
    near = closer(bundled, len(TARGETS))
    known = [*fits, *([near] if near.within else [])]
    return Identification(
        count,
        tuple(fits),
        bundled,
        near,
        directions(bundled, TABLES),
        directions(bundled),
        _intervals(known, tell) if intervals and known else {},
    )


def bundled_lengths() -> Array:
    """(l,) of LENGTHS, mm and deg: the geometry of `polibot_half`."""
    from rover_pin.loader import load

    values = load("polibot_half").parameters
    return geometry({name: values[name] * (1.0 if name.endswith("deg") else 1e3) for name in LENGTHS})


def as_parameters(lengths: Array) -> dict[str, float]:
    """A geometry as parameters of `polibot_half` (m, deg)."""
    return {
        name: float(value if name.endswith("deg") else 1e-3 * value)
        for name, value in zip(LENGTHS, lengths, strict=True)
    }


def _intervals(fits: Sequence[Fit], tell: Progress) -> dict[str, tuple[float, float]]:
    """Each length driven both ways, from the fit that is furthest already."""
    known = list(fits)
    for k in FREE:
        for sign in (-1.0, 1.0):
            known.append(reach(max(known, key=lambda fit: sign * fit.lengths[k]), int(k), sign))
        tell(f"{LENGTHS[k]}: {known[-2].lengths[k]:.4g} to {known[-1].lengths[k]:.4g}")
    table = np.array([fit.lengths for fit in known])
    return {LENGTHS[k]: (float(table[:, k].min()), float(table[:, k].max())) for k in FREE}


def report(found: Identification) -> str:
    """For people."""
    lines = [f"{found.tried} starts, {len(found.fits)} geometries that meet all {len(TARGETS)} targets", ""]
    if found.fits:
        lines += [*_lengths(found), ""]
    lines += [*_targets(found), "", *_fixed(found)]
    return "\n".join(lines)


def _lengths(found: Identification) -> list[str]:
    heads = ("length", "bounds", "found", "bundled", "interval that holds", "share of bounds")
    lines = ["{:<11} {:>10} {:>9} {:>9} {:>21} {:>16}".format(*heads)]
    for k in FREE:
        name = LENGTHS[k]
        low, high = BOUNDS[name]
        ends, share = "", ""
        if name in found.intervals:
            least, most = found.intervals[name]
            ends, share = f"{least:.2f} to {most:.2f}", f"{100 * (most - least) / (high - low):.0f} %"
        values = f"{found.best.lengths[k]:9.3f} {found.bundled.lengths[k]:9.3f}"
        lines.append(f"{name:<11} {f'{low:g}-{high:g}':>10} {values} {ends:>21} {share:>16}")
    lines.append("mm and deg; an interval is what was reached, the true one may be wider")
    return lines


def _targets(found: Identification) -> list[str]:
    lines = [f"{'target':<47} {'paper':>8} {'+-':>6} {'found':>9} {'bundled':>9}"]
    for k, target in enumerate(TARGETS):
        if target.least:
            continue
        values = [f"{target.value + target.half * fit.misses[k]:9.3f}" for fit in
                  (*((found.best,) if found.fits else ()), found.bundled)]  # fmt: skip
        shown = " ".join([*([] if found.fits else [" " * 9]), *values])
        lines.append(f"{target.name:<47} {target.value:8.2f} {target.half:6.3g} {shown}")
    miss, left = (worst(fit, len(TARGETS)) for fit in (found.bundled, found.near))
    moved = np.abs(found.near.lengths - found.bundled.lengths)
    k = int(np.argmax(moved))
    lines.append(
        f"the bundled geometry misses one by {miss:.1f} times what it leaves open, at most; a search from it"
        f" ends at {left:.2f}, nothing moved by more than {moved[k]:.2g} ({LENGTHS[k]})"
    )
    return lines


def _fixed(found: Identification) -> list[str]:
    lines = []
    for name, these in (("Tables 6 to 8", found.by_tables), ("with the statements", found.by_all)):
        count = len(these.names)
        lines.append(
            f"{name}: of {count} directions {these.fixed} are fixed to better than 1 mm (or deg),"
            f" {count - these.fixed} are not; {count - these.rank} of these move nothing to first order"
        )
        lines.append("  singular values: " + " ".join(f"{value:.3g}" for value in these.values[: these.rank]))
    lines.append("least fixed directions, with the statements:")
    for k in range(len(found.by_all.names) - 1, found.by_all.fixed - 1, -1):
        parts = [f"{share:+.2f} {name}" for name, share in found.by_all.largest(k).items()]
        lines.append(f"  {'  '.join(parts)}")
    return lines


def _silent(text: str) -> None:
    return None


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    words = argparse.ArgumentParser(description="From Polibot's tables to a geometry.")
    words.add_argument("--starts", type=int, default=20, help="searches, a second or so each")
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--no-intervals", action="store_true", help="leave out how far each length may go")
    given = words.parse_args(arguments)
    if given.starts < 1:
        words.error("--starts must be at least 1")
    found = identify(
        given.starts,
        given.seed,
        intervals=not given.no_intervals,
        progress=lambda text: print(text, file=sys.stderr),  # noqa: T201
    )
    print(report(found))  # noqa: T201
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
