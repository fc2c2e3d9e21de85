"""What URDF cannot say: couplings, loops, springs, tracks and locks, one element a file.

A new element is one file: its piece of the sidecar's schema (a pydantic model with `resolve`), and a class
that offers `Bilateral`, `OneSided` or `Elastic` rows (`element.py`). Statics and kinematics read only those.
"""

from rover_pin.mechanism.coupling import Coupling, CouplingSpec
from rover_pin.mechanism.element import Bilateral, Elastic, OneSided
from rover_pin.mechanism.frames import BodyFrame, FrameSpec
from rover_pin.mechanism.kinematics import Kinematics
from rover_pin.mechanism.lock import Lock
from rover_pin.mechanism.loop import Loop, LoopSpec
from rover_pin.mechanism.reduction import Reduction, reduce_coordinates
from rover_pin.mechanism.spring import (
    FrameSpring,
    FrameSpringSpec,
    JointSpring,
    JointSpringSpec,
    Spring,
    SpringSpec,
)
from rover_pin.mechanism.track import Track, TrackSpec

__all__ = [
    "Bilateral",
    "BodyFrame",
    "Coupling",
    "CouplingSpec",
    "Elastic",
    "FrameSpec",
    "FrameSpring",
    "FrameSpringSpec",
    "JointSpring",
    "JointSpringSpec",
    "Kinematics",
    "Lock",
    "Loop",
    "LoopSpec",
    "OneSided",
    "Reduction",
    "Spring",
    "SpringSpec",
    "Track",
    "TrackSpec",
    "reduce_coordinates",
]
