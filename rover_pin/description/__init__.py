"""Files in: URDF and xacro with our own checks, the sidecar, the catalogue of bundled robots."""
