"""Lifting wheels off the ground with clutches and rockers: planned by the loads that the statics gives."""

from rover_pin.control.lifting.admissible import admissible
from rover_pin.control.lifting.clutch import engage
from rover_pin.control.lifting.height import lift_height
from rover_pin.control.lifting.plan import plan_lift
from rover_pin.control.lifting.prepare import prepare_lift
from rover_pin.control.lifting.result import LiftPlan, Refusal, RefusalStatus

__all__ = [
    "LiftPlan",
    "Refusal",
    "RefusalStatus",
    "admissible",
    "engage",
    "lift_height",
    "plan_lift",
    "prepare_lift",
]
