"""Fig. 12: the climb of a vertical wall, as far as forces along gravity go.

Against the wall the idler is pushed back and, by the track, pulled up: forces across gravity, for which the
paper gives neither friction nor the motors' effort. Contacts here carry along gravity only, so the wall
cannot be had. What can: the front lifted by a ledge, first under the idler, then under the front road
wheel, until the way ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.papers.chart import Chart, Curve, Mark, Panel
from rover_pin.analysis.papers.finding import NOT_REPRODUCED, Finding
from rover_pin.analysis.papers.polibot.ground import ledge
from rover_pin.analysis.papers.polibot.reading import front_wheel, read, wheel_centers
from rover_pin.statics.settle import settle

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance

IDLER = "w2"
AHEAD, STEEP = 0.055, 0.02
"""m: the ledge's edge ahead of the idler's axis, where the front wheel clears its riser; the riser's run."""

UNDER_IDLER = np.linspace(0.005, 0.09, 6)
UNDER_WHEEL = np.array([0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.42])
"""m: heights of the ledges; under the idler above its lowest point at rest."""

NOTE = "No wall: a ledge lifts the front by forces along gravity."
REASON = (
    "the wall's push and the track's pull up it are forces across gravity, of which the paper gives neither"
    " friction nor effort; ours has forces along gravity only"
)


@dataclass(frozen=True, eq=False)
class Lift:
    """The front lifted by a ledge.

    Attributes:
        idler: (n,) mm, rise of the idler's axis.
        theta: (n,) deg.
        wheels: (n,) names of the wheels that carry, one word each.
    """

    idler: Array
    theta: Array
    wheels: tuple[str, ...]


def lifted_by_idler(rover: Rover, rest: Stance) -> Lift:
    """A ledge under the idler, its edge just ahead of the axis."""
    place = float(wheel_centers(rest)[IDLER][0]) + AHEAD
    level = rest.gaps[IDLER]
    return _lift(rest, [settle(rover, ledge(place, level + float(h), STEEP)) for h in UNDER_IDLER], IDLER)


def lifted_by_wheel(rover: Rover, rest: Stance) -> Lift:
    """A ledge under the front road wheel."""
    wheel = front_wheel(rover)
    place = float(wheel_centers(rest)[wheel][0]) + 0.02
    return _lift(rest, [settle(rover, ledge(place, float(h))) for h in UNDER_WHEEL], wheel)


def _lift(rest: Stance, stances: list[Stance], wheel: str) -> Lift:
    stood = [rest, *(s for s in stances if s.settled and s.loads[wheel] > 1e-3)]
    level = float(wheel_centers(rest)[IDLER][1])
    return Lift(
        np.array([1e3 * (float(wheel_centers(s)[IDLER][1]) - level) for s in stood]),
        np.array([read(s).theta for s in stood]),
        tuple(" ".join(name for name, load in s.loads.items() if load > 1e-3) for s in stood),
    )


def results(rover: Rover, rest: Stance) -> tuple[list[Finding], list[Chart]]:
    """Rows and the chart of Fig. 12."""
    by_idler, by_wheel = lifted_by_idler(rover, rest), lifted_by_wheel(rover, rest)
    k = int(np.argmin(by_wheel.theta))
    rows = [
        Finding("lowest pitch of the climb, idler on a ledge", "deg", -90.0, float(np.min(by_idler.theta)),
                NOT_REPRODUCED, f"until the ledge's corner slips past the idler; {REASON}", "Fig. 12"),
        Finding("lowest pitch of the climb, front wheel on a ledge", "deg", -90.0, float(by_wheel.theta[k]),
                NOT_REPRODUCED, f"as far as ledges were tried, 0.42 m; {REASON}", "Fig. 12"),
        Finding("wheels that carry there", "", "W6 alone, and the wall", by_wheel.wheels[k].upper(),
                NOT_REPRODUCED,
                f"the middle wheels are off the ground too, the ledge takes the wall's place; {REASON}",
                "Fig. 12"),
        Finding("mean error of pitch to the measured climb, to -40 deg", "%", 4.7, None, NOT_REPRODUCED,
                f"its measurements are only in the figure; {REASON}", "Fig. 12"),
    ]  # fmt: skip
    return rows, [_chart(by_idler, by_wheel)]


def _chart(by_idler: Lift, by_wheel: Lift) -> Chart:
    panel = Panel(
        "pitch [deg]",
        (
            Curve("ledge under the idler", by_idler.idler, by_idler.theta),
            Curve("ledge under the front road wheel", by_wheel.idler, by_wheel.theta, style="dashed"),
        ),
        (Mark(None, -40.0, "paper: the experiment ends"), Mark(None, -90.0, "paper: the model ends")),
    )
    return Chart("fig_12", "Fig. 12: the front lifted, in place of the wall climb",
                 "rise of the idler [mm]", (panel,), NOTE)  # fmt: skip
