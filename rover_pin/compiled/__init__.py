"""Many cases at the speed of the machine: arrays taken once from a Rover, and compiled loops on them.

The formulas are those of the other rooms: contact search, surface, loops and springs, edges of measures. The
tree walk, the Newton loop and the following of contacts from pose to pose are the room's own.
"""

from rover_pin.compiled.answers import COMPILED_MEASURES, Answers
from rover_pin.compiled.batch import Batch
from rover_pin.compiled.designs import Designs
from rover_pin.compiled.settle import GROUNDED, OFF_MAP, OPEN, SETTLED

__all__ = ["COMPILED_MEASURES", "GROUNDED", "OFF_MAP", "OPEN", "SETTLED", "Answers", "Batch", "Designs"]
