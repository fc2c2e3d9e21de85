"""What watches and steers motion: motion constraints, projection, modes, supervisor; named by the idea."""
