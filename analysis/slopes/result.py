"""Slopes at tip and at slip as an xarray Dataset with units and provenance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from rover_pin.analysis.provenance import made_by, stands_how

if TYPE_CHECKING:
    from rover_pin.analysis.slopes.tilt_table import Limits
    from rover_pin.rover import Rover

HEADING = "heading_rad"


def as_dataset(
    rover: Rover, found: Sequence[Limits], friction: float | None, how: Mapping[str, Any]
) -> xr.Dataset:
    """The Dataset from the limits of headings evenly over the circle."""

    def told(name: str, text: str, unit: str = "") -> tuple[str, Any, dict[str, str]]:
        values: Any = [getattr(each, name) for each in found]
        return HEADING, values, {**({"units": unit} if unit else {}), "long_name": text}

    tip, slip = (np.array([getattr(each, name) for each in found]) for name in ("tip", "slip"))
    return xr.Dataset(
        {
            "tip_rad": told("tip", "least slope without a stance", "rad"),
            "slip_rad": told(
                "slip", "least slope that friction does not hold; NaN where it tips first", "rad"
            ),
            "stands_to_rad": (
                HEADING,
                np.fmin(tip, slip),
                {"units": "rad", "long_name": "the lesser of both"},
            ),
            "tip_open_rad": told(
                "tip_open", "how much further it might stand, no stance being found there", "rad"
            ),
            "slip_open_rad": told("slip_open", "how much further friction might hold it", "rad"),
            "tip_limiting": told("tip_limiting", "wheel, joint or link that ends it"),
            "tip_status": told("tip_status", "how the stance ends"),
            "slip_limiting": told("slip_limiting", "contact that slips first"),
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
            **stands_how(rover, how["posture"], how["gravity"], how["joints"], how["locks"]),
            "friction": "as declared" if friction is None else float(friction),
            **made_by(),
        },
    )
