"""Level shelves across the heading: each road wheel of a robot at the origin stands on its own."""

import numpy as np

import rover_pin as rp

PITCH = 0.01


def shelves(edges, heights, across=1.0):
    """Height heights[k] [m] between edges[k] and edges[k - 1] [m], from the front backwards; short ramps."""
    x = np.arange(-150, 151) * PITCH
    z = np.select([x > edge for edge in edges], heights[:-1], heights[-1])
    rows = 2 * round(across / PITCH) + 1
    return rp.Terrain.from_grid(np.tile(z, (rows, 1)), PITCH, (-1.5, -across), "linear")
