"""Friction margin: how much of the friction the stance can do without."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing
from rover_pin.statics.distribute import smallest_friction
from rover_pin.statics.forces import ForceStatus
from rover_pin.statics.least_friction import least_friction


def evaluate(standing: Standing) -> Margin:
    """The most friction that every contact could lose at once with the rover still in equilibrium [-].

    With one friction mu for all it is mu - mu_least; where the shapes declare different ones it is the
    largest d with |tangential_i| <= (mu_i - d) normal_i. Negative where friction does not hold the rover.
    Edges: what each contact's friction exceeds its |tangential| / normal by, in the forces that attain it.
    Details: `least` (mu_least, the least one friction at every contact that holds the rover).

    Cost: 3 ms a stance with six wheels (about 12 cone programs); twice that where frictions differ.
    """
    problem = standing.problem
    forces = smallest_friction(problem)
    if not np.isfinite(forces.friction):
        return MEASURE.closed(forces.reason)
    edges = dict(zip(forces.contacts, (forces.given - forces.ratio).tolist(), strict=True))
    if forces.status is not ForceStatus.FEASIBLE and min(edges.values(), default=0.0) >= 0.0:
        return MEASURE.closed(forces.reason)
    if np.ptp(problem.friction) == 0.0:
        least = forces.friction
        return MEASURE.margin(edges, note=f"needs friction {least:.6g}", least=least)
    found = least_friction(problem.space, np.zeros(len(problem.contacts)))
    if found.outcome != "found":
        return MEASURE.margin(edges, least=math.inf)
    note = f"one friction of {found.excess:.6g} at every contact would do"
    return MEASURE.margin(edges, note=note, least=found.excess)


MEASURE = Measure("friction", "-", "high", 3.0, evaluate)
