"""Shapes that touch the ground: wheels, feet and capsules, and where they touch it.

The search itself is in `rover_pin.contact.search`.
"""

from rover_pin.contact.capsule import Capsule
from rover_pin.contact.pack import Packed, Shape, half_extents, pack
from rover_pin.contact.sphere import Foot
from rover_pin.contact.wheel import Wheel

__all__ = ["Capsule", "Foot", "Packed", "Shape", "Wheel", "half_extents", "pack"]
