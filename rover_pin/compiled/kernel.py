"""The loop over cases."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_pin.compiled.bounds import Tiles
from rover_pin.compiled.margins import heights, least, on_edges, polygon
from rover_pin.compiled.posed import Integers
from rover_pin.compiled.residuals import tensions
from rover_pin.compiled.search import Search
from rover_pin.compiled.settle import OPEN, SETTLED, settle_one
from rover_pin.numerics import Array, formula


class Out(NamedTuple):
    """What the loop fills in, the case first; only rows of settled cases have numbers.

    Attributes:
        code: (n,); who: (n,); depth: (n,) m; redundant: (n,).
        z: (n, free); loads: (n, s) N; residuals: (n, 4).
        corners: (n, s) shapes at the polygon's corners, -1 beyond the last.
        edges: (n, 5, s) measures of ON_EDGES along its edges; limiting: (n, 5) the least one, -1 none.
        belly: (n, p) m; edges and these are empty where no measures are asked.
        tensions: (n, t) N, of the tracks.
    """

    code: NDArray[np.uint8]
    who: Integers
    depth: Array
    redundant: Integers
    z: Array
    loads: Array
    residuals: Array
    corners: Integers
    edges: Array
    limiting: Integers
    belly: Array
    tensions: Array


@formula
def settle_all(
    machines: NDArray[np.void], scratch: NDArray[np.void], grounds: NDArray[np.void], params: Array,
    table: Array, tiles: Tiles, skin: Array, search: Search, groups: Integers, x: Array, y: Array, yaw: Array,
    out: Out,
) -> None:  # fmt: skip
    """Every case by itself; where its machine is not usable it is left open.

    Args:
        machines: (g,) of `posed_dtype`.
        scratch: (1,) of `work_dtype`.
        grounds: (1,) of GROUND.
        params: the surface's parameters.
        table: its table.
        tiles: its bounds.
        skin: (h, 4) points of the underside.
        search: the contact search.
        groups: (n,) machine of each case.
        x: (n,) m.
        y: (n,) m.
        yaw: (n,) rad.
        out: receives the answers.
    """
    w, ground = scratch[0], grounds[0]
    measured = out.edges.shape[0] > 0
    for i in range(x.shape[0]):
        p = machines[groups[i]]
        out.code[i] = OPEN
        if p.usable == 0:
            continue
        code, who, depth, redundant = settle_one(
            p,
            ground,
            params,
            table,
            tiles,
            skin,
            search,
            w,
            x[i],
            y[i],
            yaw[i],
            out.z[i],
            out.loads[i],
            out.residuals[i],
        )
        out.code[i], out.who[i], out.depth[i], out.redundant[i] = code, who, depth, redundant
        if code == SETTLED:
            tensions(p, w, out.tensions[i])
        if code == SETTLED and measured:
            corners = polygon(p, w)
            on_edges(p, w, corners, out.loads[i], out.edges[i])
            for c in range(corners):
                out.corners[i, c] = w.corners[c]
            for m in range(5):
                out.limiting[i, m] = least(out.edges[i, m], corners)
            heights(p, ground, params, table, w, out.belly[i])
