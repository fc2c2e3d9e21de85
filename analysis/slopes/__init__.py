"""The slopes at which a rover tips and slips, against its heading."""

from rover_pin.analysis.slopes.run import slopes

__all__ = ["slopes"]
