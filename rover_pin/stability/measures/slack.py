"""Robust slack: the load that every contact could lose at once (Del Prete et al. 2016)."""

from __future__ import annotations

import numpy as np

from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing
from rover_pin.statics.least_friction import SQUEEZE
from rover_pin.statics.robust_slack import robust_slack

_WHY = {
    "infeasible": "no contact forces of any size balance the weight",
    "failed": "the solver found no answer it could prove",
}


def evaluate(standing: Standing) -> Margin:
    """The largest s [N] with |tangential_i| <= friction_i (normal_i - s) at every contact, in equilibrium.

    It is the largest b0 with G b = D c + d, b >= b0, with exact cones in place of a pyramid: b >= b0 over n
    generators e_n + friction (e_r cos + e_l sin) leaves f - n b0 e_n in the pyramid, so s is the limit of
    n b0 (for generators of unit length n b0 / sqrt(1 + friction^2)). Any error of the forces smaller than
    friction_i s / sqrt(1 + friction_i^2) leaves every one in its cone. Negative where friction does not
    hold the rover: then s says by how much. The rows of passive joints, loops and couplings count.

    Edges: normal_i - |tangential_i| / friction_i of each contact in the forces that attain it.
    Details: `over_weight` (s over the weight, [-]).

    Cost: 1.4 ms a stance with six wheels, 0.4 beside `friction` (one cone program).
    """
    problem = standing.problem
    found = robust_slack(problem.space, problem.friction)
    if found.outcome != "found":
        return MEASURE.closed(_WHY[found.outcome])
    local = found.forces[: 3 * len(problem.contacts)].reshape(-1, 3) * problem.weight
    edges = local[:, 0] - np.hypot(local[:, 1], local[:, 2]) / problem.friction
    note = f"contacts brace: normal forces of {SQUEEZE:g} weights are the bound" if found.braced else ""
    return MEASURE.margin(
        dict(zip(problem.names, edges.tolist(), strict=True)), note=note, over_weight=found.value
    )


MEASURE = Measure("slack", "N", "high", 1.4, evaluate)
