"""A terrain in figures: size, heights, slopes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import ArrayLike

from rover_pin.numerics import Array
from rover_pin.terrain.probe import Extent

REACH = 10.0
"""Half the side [m] of the square that is looked at where a terrain has no end."""

_MOST = 1500


@dataclass(frozen=True)
class Summary:
    """Figures of a terrain, over its extent or, where it has no end, over a square about the origin.

    Attributes:
        label: how the user named the terrain.
        extent_m: (xmin, xmax, ymin, ymax) of the place looked at.
        spacing_m: from node to node; a function's feature size; infinite for a plane.
        shape: (rows, columns) of the heights looked at.
        lowest_m: least height.
        highest_m: greatest height.
        mean_m: mean height.
        rms_m: root mean square of the heights about their mean.
        slope_mean_deg: mean steepness.
        slope_p95_deg: the steepness that 95 % of the place stays below.
        slope_max_deg: greatest steepness.
    """

    label: str
    extent_m: Extent
    spacing_m: float
    shape: tuple[int, int]
    lowest_m: float
    highest_m: float
    mean_m: float
    rms_m: float
    slope_mean_deg: float
    slope_p95_deg: float
    slope_max_deg: float

    def as_dict(self) -> dict[str, object]:
        """The figures by name, for tables and pages."""
        return asdict(self)


def summarize(
    height: Callable[[ArrayLike, ArrayLike], Array],
    gradient: Callable[[ArrayLike, ArrayLike], Array],
    extent: Extent,
    spacing: float,
    label: str,
) -> Summary:
    """Heights at the nodes and slopes at the middles between them, at most some two million of each."""
    xmin, xmax, ymin, ymax = where = _region(extent)
    x, y = _ticks(xmin, xmax, spacing), _ticks(ymin, ymax, spacing)
    z = height(x[None, :], y[:, None])
    middle_x, middle_y = 0.5 * (x[1:] + x[:-1]), 0.5 * (y[1:] + y[:-1])
    slopes = np.degrees(np.arctan(np.linalg.norm(gradient(middle_x[None, :], middle_y[:, None]), axis=-1)))
    return Summary(
        label=label,
        extent_m=where,
        spacing_m=spacing,
        shape=(y.size, x.size),
        lowest_m=float(z.min()),
        highest_m=float(z.max()),
        mean_m=float(z.mean()),
        rms_m=float(z.std()),
        slope_mean_deg=float(slopes.mean()),
        slope_p95_deg=float(np.percentile(slopes, 95.0)),
        slope_max_deg=float(slopes.max()),
    )


def _region(extent: Extent) -> Extent:
    """The extent with every open side closed 2 REACH from the other, or REACH from the origin."""
    ends = []
    for low, high in (extent[:2], extent[2:]):
        if np.isinf(low):
            low = -REACH if np.isinf(high) else high - 2.0 * REACH
        if np.isinf(high):
            high = low + 2.0 * REACH
        ends += [low, high]
    return ends[0], ends[1], ends[2], ends[3]


def _ticks(low: float, high: float, spacing: float) -> Array:
    count = 200 if np.isinf(spacing) else max(1, round((high - low) / spacing))
    return np.linspace(low, high, min(count, _MOST) + 1)
