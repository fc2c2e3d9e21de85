"""Slopes at tip and at slip as an xarray Dataset with units and provenance."""

from __future__ import annotations

import datetime
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from rover_pin.analysis.provenance import git_state, versions

if TYPE_CHECKING:
    from rover_pin.analysis.slopes.tilt_table import Limits
    from rover_pin.rover import Rover

HEADING = "heading_rad"


def as_dataset(
    rover: Rover, found: Sequence[Limits], friction: float | None, how: Mapping[str, Any]
) -> xr.Dataset:
    """The Dataset from the limits of headings evenly over the circle."""
    tip, slip = (np.array([getattr(each, name) for each in found]) for name in ("tip", "slip"))
    commit, state = git_state(Path(__file__).resolve().parent)

    def words(name: str) -> list[str]:
        return [getattr(each, name) for each in found]

    return xr.Dataset(
        {
            "tip_rad": (HEADING, tip, {"units": "rad", "long_name": "least slope without a stance"}),
            "slip_rad": (
                HEADING,
                slip,
                {
                    "units": "rad",
                    "long_name": "least slope that friction does not hold; NaN where it tips first",
                },
            ),
            "stands_to_rad": (
                HEADING,
                np.fmin(tip, slip),
                {"units": "rad", "long_name": "the lesser of both"},
            ),
            "tip_limiting": (
                HEADING,
                words("tip_limiting"),
                {"long_name": "wheel, joint or link that ends it"},
            ),
            "tip_status": (HEADING, words("tip_status"), {"long_name": "how the stance ends"}),
            "slip_limiting": (HEADING, words("slip_limiting"), {"long_name": "contact that slips first"}),
        },
        coords={
            HEADING: (
                HEADING,
                2.0 * np.pi * np.arange(len(found)) / len(found),
                {
                    "units": "rad",
                    "long_name": "in the slope from straight uphill, counterclockwise from above",
                },
            )
        },
        attrs={
            "title": f"{rover.name} on slopes",
            "robot": rover.name,
            "robot_file": str(rover.source),
            "parameters": ", ".join(f"{name}={value!r}" for name, value in rover.parameters.items()),
            "posture": "home" if how["posture"] is None else str(how["posture"]),
            "joints": ", ".join(f"{name}={value!r}" for name, value in (how["joints"] or {}).items()),
            "locks": ", ".join(how["locks"]),
            "gravity": how["gravity"],
            "friction": "as declared" if friction is None else float(friction),
            "rover_pin_git_commit": commit,
            "rover_pin_git_state": state,
            **{f"{name}_version": text for name, text in versions().items()},
            "created": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        },
    )
