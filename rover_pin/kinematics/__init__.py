"""Motion of rovers that roll: rows of wheels, tasks, limits, and constrained inverse kinematics.

>>> import rover_pin as rp
>>> from rover_pin.kinematics import InverseKinematics, advance
>>> from rover_pin.kinematics.tasks import BaseTwist
>>> rover, terrain = rp.load("rocker_bogie"), rp.Terrain.slope(10)
>>> inverse = InverseKinematics(rover, terrain)
>>> at = inverse.at(rp.settle(rover, terrain))
>>> for _ in range(100):
...     step = inverse.solve(at, [BaseTwist(forward=0.05)], dt=0.02)
...     at = advance(at, step.velocity, 0.02)
>>> step.solved
True
"""

from rover_pin.kinematics.advance import Sliding, advance
from rover_pin.kinematics.instant import Bodies, Instant
from rover_pin.kinematics.inverse import InverseKinematics, usual_limits
from rover_pin.kinematics.model import Motion, complete, forward
from rover_pin.kinematics.rows import Aim, Rows, equations
from rover_pin.kinematics.solution import Outcome, Solution
from rover_pin.kinematics.steering import Twist, steering_for, steering_joints, turning_centre
from rover_pin.kinematics.wheelbase import wheelbase

__all__ = [
    "Aim",
    "Bodies",
    "Instant",
    "InverseKinematics",
    "Motion",
    "Outcome",
    "Rows",
    "Sliding",
    "Solution",
    "Twist",
    "advance",
    "complete",
    "equations",
    "forward",
    "steering_for",
    "steering_joints",
    "turning_centre",
    "usual_limits",
    "wheelbase",
]
