"""Support region with friction: how far the centre of mass may move sideways (Bretl and Lall 2008)."""

from __future__ import annotations

from rover_pin.stability.com_region import held_level, region_margin
from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing
from rover_pin.statics.com_reach import ComReach


def evaluate(standing: Standing) -> Margin:
    """Signed distance [m] of the centre of mass, seen along gravity, from the edge of the support region.

    The region holds every place the centre of mass could be moved to, by moving mass of the root link
    sideways, with the rover still in equilibrium within friction:
    S_p (g(c) - sum J_i' f_i - J_c' lambda) = 0 with |tangential_i| <= friction_i normal_i. The rows of
    passive joints, loops and couplings count, so it is often smaller than the support polygon; the six rows
    of the body alone would be optimistic. The friction cones are exact (second-order cone programs, no
    pyramid).

    Edges: the least distance over the directions of each eighth of the circle, `front` about the heading,
    then counterclockwise `front_left` to `front_right`. The note says what stands at its limit where the
    edge is nearest. Details: `area_m2` (of the inner outline; the region's is between it and
    `area_at_most_m2`), `toward_rad` (the nearest edge, from the heading). `outline` holds the region's
    corners, (x, y) in the world. Distances are within 1e-7 of the contacts' extent, from below. Closed where
    friction holds the rover nowhere, and where the region is a line or a point.

    Cost: 20 ms a stance with six wheels (about 45 cone programs).
    """
    if not standing.stance.contacts:
        return MEASURE.closed("0 contacts span no region")
    reach = ComReach(standing.problem)
    return region_margin(MEASURE, standing.stance, reach, "friction holds no place of the centre of mass")


MEASURE = Measure("region", "m", "high", 20.0, evaluate, held_level)
