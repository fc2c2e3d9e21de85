"""The public names, loaded when asked for."""

import subprocess
import sys

import pytest

import rover_pin as rp


def test_public_names():
    assert {"load", "Rover", "Terrain", "Stance", "Status", "stability", "errors", "robots"} <= set(dir(rp))
    assert callable(rp.load)
    assert callable(rp.stability)
    assert rp.Rover.__name__ == "Rover"
    with pytest.raises(AttributeError, match="module 'rover_pin' has no attribute 'laod'"):
        rp.laod  # noqa: B018


def test_importing_is_light():
    code = (
        "import sys, rover_pin; "
        "print([m for m in ('numpy', 'pinocchio', 'numba', 'matplotlib', "
        "'xarray', 'yourdfpy') if m in sys.modules])"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.strip() == "[]"


def test_loading_needs_no_viewer():
    code = (
        "import sys, rover_pin; rover_pin.load('rocker_bogie'); "
        "print([m for m in ('meshcat', 'matplotlib', 'xarray', 'yourdfpy', 'trimesh') if m in sys.modules])"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.strip() == "[]"
