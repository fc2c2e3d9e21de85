"""Motion of rovers that roll: rows of wheels, tasks, limits, and constrained inverse kinematics."""
