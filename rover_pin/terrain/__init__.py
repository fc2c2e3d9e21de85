"""Terrain: height, gradient and normal of one surface, whoever asks."""
