"""Motion constraints, one a file; a module here that holds a `CONSTRAINT` is one."""

from rover_pin.control.motion_constraints.constraint import Kind, MotionConstraint, Options
from rover_pin.control.motion_constraints.lifted_set import admissible_sets, broken_rules
from rover_pin.control.motion_constraints.registry import CONSTRAINTS, motion_constraints

__all__ = [
    "CONSTRAINTS",
    "Kind",
    "MotionConstraint",
    "Options",
    "admissible_sets",
    "broken_rules",
    "motion_constraints",
]
