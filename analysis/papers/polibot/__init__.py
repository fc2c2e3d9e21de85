"""Polibot (Ugenti et al.): a tracked robot with sprung swing arms, Tables 6 to 8, Figs 12 to 18, 20 and 21.

The paper's axes: X rearwards, Z up, angles counter-clockwise as seen there: pitch is nose down positive, as
ours is.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from rover_pin.analysis.papers.paper import Paper, Results

if TYPE_CHECKING:
    from rover_pin.rover import Rover

HALF, OTHER = "polibot_half", "x_suspension"

REMARKS = (
    "Geometry: the paper draws it (Fig. A.1) but its text has no lengths. Ours was identified"
    " from Tables 6 to 8"
    " and from statements about Figs 13 to 18, so these are in sample, and it is not unique:"
    " python -m rover_pin.analysis.papers.polibot_identification says how well each length is fixed.",
    "The curves themselves are not in the text: what it says of them is compared.",
    "Half model: half of the mass, in its plane of symmetry, contacts without motion resistance.",
    "Misprints: Table 3 swaps the words for X_A and Z_A. B.5 to B.8 write theta_1 for theta. C.1 has a sum of"
    " sines for the distance H to J. D.6 and D.7 add (R_i - R_j)^2 where it is subtracted. E.5"
    " has the wrong sign"
    " before N4, E.7 before N3. (13) sums over 1 to 4 for 3 to 6. Rows 3, 4, 7 and 8 of (8) lack terms.",
    "Prose against tables: -2.98 deg (section 5.1.2) is the measurement, the model's value is"
    " -2.69; the 3.3 deg"
    " are 2.90 by the model's own columns.",
)


def _compute(robots: Mapping[str, Rover]) -> Results:
    from rover_pin.analysis.papers.polibot import comparison, stances, sweeps, tables, wall

    half, other = robots[HALF], robots[OTHER]
    cases = tables.Stances(half)
    parts = [
        (tables.findings(cases), [stances.chart(cases)]),
        wall.results(half, cases.baseline),
        sweeps.results(half),
        comparison.results(half, other),
    ]
    return Results(
        tuple(row for rows, _ in parts for row in rows),
        tuple(chart for _, charts in parts for chart in charts),
    )


PAPER = Paper(
    key="polibot",
    title="Analysis of an all-terrain tracked robot with innovative suspension system",
    citation="A. Ugenti, R. Galati, G. Mantriota, G. Reina; Polytechnic University of Bari",
    robots=(HALF, OTHER),
    compute=_compute,
    remarks=REMARKS,
)
