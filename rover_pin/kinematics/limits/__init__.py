"""What a motion must obey, one a file."""

from rover_pin.kinematics.limits.clutch import Clutch
from rover_pin.kinematics.limits.contact import ContactKept, rolling_contacts
from rover_pin.kinematics.limits.coupling import CouplingsKept
from rover_pin.kinematics.limits.held import Held
from rover_pin.kinematics.limits.joint import JointLimits
from rover_pin.kinematics.limits.loop import LoopsClosed
from rover_pin.kinematics.limits.velocity import SpeedLimits

__all__ = [
    "Clutch",
    "ContactKept",
    "CouplingsKept",
    "Held",
    "JointLimits",
    "LoopsClosed",
    "SpeedLimits",
    "rolling_contacts",
]
