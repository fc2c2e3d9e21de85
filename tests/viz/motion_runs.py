"""Runs to look at: hit_mrii settled again and again while its rockers turn, as a slow motion would pass."""

from __future__ import annotations

import numpy as np

import rover_pin as rp
from rover_pin.simulation.run import Run


def settled_run(rover, terrain, count=12, x=(0.0, 0.0), steepest_deg=39.108):
    """Raises its chassis from 250 to 480 mm and lowers it, on the way from x[0] to x[1]; a stance every 2 s.

    Indices and drift are made up; `load_deviation` is silent at the fifth sample; LF and RM are said to be
    lifted from sample count // 3 on, before count // 2.
    """
    way = np.linspace(0.0, 1.0, count)
    angles = np.radians(steepest_deg) * (1 - np.abs(2 * way - 1))
    stances = [
        rp.settle(rover, terrain, x=float(x[0] + part * (x[1] - x[0])), joints={"L_act": u, "R_act": u})
        for part, u in zip(way, angles.tolist(), strict=True)
    ]
    assert all(stance.settled for stance in stances)
    q = np.array([stance.configuration for stance in stances])
    time = 2.0 * np.arange(count)
    spread = np.array([[np.ptp(list(stance.loads.values())) / 1100] for stance in stances])
    deviation = spread.copy()
    deviation[4:5] = np.nan
    wheelbase = np.outer(np.rad2deg(angles) / steepest_deg, [1.2, 0.9])
    middle = range(count // 3, count // 2)
    return Run(
        rover=rover,
        terrain=terrain,
        time=time,
        configuration=q,
        rates=np.zeros_like(q),
        actions=tuple("chassis_raise" if i < count // 2 else "chassis_lower" for i in range(count)),
        lifted=tuple(("LF", "RM") if i in middle else () for i in range(count)),
        indices={"wheelbase": wheelbase, "load_difference": spread, "load_deviation": deviation},
        loads={w.name: np.array([stance.loads[w.name] for stance in stances]) for w in rover.wheels},
        drift=np.outer(way, np.arange(6)) * 1e-3,
    )
