"""What modes are made of, one a file."""

from rover_pin.control.actions.action import CLOSE, Action, Command, Grip, Start
from rover_pin.control.actions.clutches import Engage, Release
from rover_pin.control.actions.drive import Drive
from rover_pin.control.actions.lift import LiftWheels
from rover_pin.control.actions.reshape import Reshape
from rover_pin.control.actions.steer import Steer, SteerToward

__all__ = [
    "CLOSE",
    "Action",
    "Command",
    "Drive",
    "Engage",
    "Grip",
    "LiftWheels",
    "Release",
    "Reshape",
    "Start",
    "Steer",
    "SteerToward",
]
