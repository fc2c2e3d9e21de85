"""What a paper's figure shows, as numbers: panels of curves over one axis."""

from __future__ import annotations

from dataclasses import dataclass, field

from rover_pin.numerics import Array


@dataclass(frozen=True, eq=False)
class Curve:
    """A line.

    Attributes:
        label: for the legend; empty for none.
        x: (n,) in the chart's unit.
        y: (n,) in the panel's; NaN breaks the line.
        style: `solid`, `dashed` or `dotted`.
        steps: whether the value jumps from one point to the next.
        faint: whether it is not one of the figure's own curves but helps to read them.
    """

    label: str
    x: Array
    y: Array
    style: str = "solid"
    steps: bool = False
    faint: bool = False


@dataclass(frozen=True)
class Mark:
    """What the paper's text says of the figure: a point, or a line where one coordinate is None.

    Attributes:
        x: in the chart's unit.
        y: in the panel's.
        label: what is said.
    """

    x: float | None
    y: float | None
    label: str


@dataclass(frozen=True)
class Panel:
    """One pair of axes.

    Attributes:
        label: of the y axis, with its unit.
        curves: ours.
        marks: the paper's statements.
        equal: whether both axes have one scale.
    """

    label: str
    curves: tuple[Curve, ...]
    marks: tuple[Mark, ...] = ()
    equal: bool = False


@dataclass(frozen=True)
class Chart:
    """A figure of the paper as we compute it.

    Attributes:
        key: name of the file, `fig_13`.
        title: which figure, and of what.
        x_label: with its unit.
        panels: from the top down.
        note: what to know when looking at it.
        beside: whether the panels stand side by side.
    """

    key: str
    title: str
    x_label: str
    panels: tuple[Panel, ...] = field(default_factory=tuple)
    note: str = ""
    beside: bool = False
