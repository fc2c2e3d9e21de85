"""Rows written down by hand."""

from __future__ import annotations

import numpy as np

from rover_pin.analysis.rows import Columns, Layout, Rows
from rover_pin.stability.margin import Margin

LAYOUT = Layout(("a", "b"), ("hinge",), ("tip",))


def rows(cases: list[dict[str, float]]) -> Columns:
    """Rows whose tip margin has these edges; an empty case is a failed one."""
    out = Rows(LAYOUT, len(cases))
    for i, edges in enumerate(cases):
        if edges:
            limiting = min(edges, key=edges.__getitem__)
            out.margins(i, {"tip": Margin("tip", edges[limiting], "rad", limiting, edges, "high")})
        else:
            out.failed(i, "tips", "over b")
    return out.columns()


def same(a: Columns, b: Columns) -> bool:
    return list(a) == list(b) and all(
        a[key].dtype.kind == b[key].dtype.kind
        and np.array_equal(a[key], b[key], equal_nan=a[key].dtype.kind == "f")
        for key in a
    )
