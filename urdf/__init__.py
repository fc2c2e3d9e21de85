"""Bundled robots: one folder each, with `<robot>.urdf.xacro`, `rover.yaml` and a README of its numbers."""
