"""The few colours of every picture; safe for colour blindness (blue, orange, magenta on sand)."""

from __future__ import annotations

LOAD = (0.043, 0.341, 0.643)  # loads and the support polygon
LIMIT = (0.851, 0.373, 0.008)  # the lightest wheel, the limiting edge
COM = (0.839, 0.0, 0.498)  # the centre of mass
REGION = (0.0, 0.62, 0.45)  # where the centre of mass may go
GRIP = (0.337, 0.706, 0.914)  # a belt on the ground
WEAK, STRONG = (0.98, 0.84, 0.30), (0.50, 0.04, 0.49)  # springs, from no force to the picture's greatest
RUBBER = (0.16, 0.17, 0.19)
HUB = (0.56, 0.58, 0.61)
SAND = (0.80, 0.76, 0.69)
BODY = (0.78, 0.77, 0.74)


def hexadecimal(rgb: tuple[float, float, float]) -> int:
    """The colour as the 24-bit number that three.js takes."""
    r, g, b = (round(255 * min(max(part, 0.0), 1.0)) for part in rgb)
    return (r << 16) | (g << 8) | b
