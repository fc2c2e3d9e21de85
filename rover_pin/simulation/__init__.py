"""Motion in time: what a controller and the ground make of a rover, step by step."""
