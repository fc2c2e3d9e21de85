"""Rates that a rover's drives need over rough ground: `python inverse_kinematics.py [ROBOT | my.urdf]`."""

import sys

import rover_pin as rp
from rover_pin.kinematics import InverseKinematics, advance
from rover_pin.kinematics.tasks import BaseTwist

rover = rp.load(sys.argv[1] if len(sys.argv) > 1 else "rocker_bogie")
terrain = rp.Terrain.rough(seed=1, rms=0.03, hurst=0.8)
inverse = InverseKinematics(rover, terrain)
at = inverse.at(rp.settle(rover, terrain, x=5.0, y=5.0))
for cycle in range(201):
    step = inverse.solve(at, [BaseTwist(forward=0.05)], dt=0.02)  # m/s, s
    if not step.solved:
        raise SystemExit(step.reason)  # which rows cannot hold together
    if cycle % 50 == 0:
        rates = "  ".join(f"{joint} {step.rates[joint]:+.3f}" for joint in rover.actuated)
        print(f"{0.02 * cycle:4.1f} s  {rates} rad/s")  # noqa: T201
    at = advance(at, step.velocity, 0.02)
