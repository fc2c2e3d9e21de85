"""What may be wanted of a motion, one a file."""

from rover_pin.kinematics.tasks.base_twist import BaseTwist
from rover_pin.kinematics.tasks.clearance import Clearance
from rover_pin.kinematics.tasks.com import CenterOfMass
from rover_pin.kinematics.tasks.frame import FrameGoal
from rover_pin.kinematics.tasks.posture import Posture
from rover_pin.kinematics.tasks.rates import Rates
from rover_pin.kinematics.tasks.wheel_lift import WheelLift

__all__ = ["BaseTwist", "CenterOfMass", "Clearance", "FrameGoal", "Posture", "Rates", "WheelLift"]
