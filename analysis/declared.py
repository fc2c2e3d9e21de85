"""Declared parameters: what the sidecar says of them, and what a study asks of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from rover_pin.analysis.one_by_one import probes
from rover_pin.analysis.quantities import Quantity
from rover_pin.analysis.spec import StudySpec
from rover_pin.description.parameters import ParameterSpec
from rover_pin.description.sidecar import read_sidecar
from rover_pin.errors import StudyError, nearest

if TYPE_CHECKING:
    from rover_pin.rover import Rover


def declared(rover: Rover) -> Mapping[str, ParameterSpec]:
    """What the sidecar says of each parameter: default, unit, bounds."""
    text = rover.recipe.sidecar_text
    return {} if text is None else read_sidecar(text, rover.recipe.sidecar_path).parameters


def asked_of(spec: StudySpec, rover: Rover) -> Mapping[str, Quantity]:
    """What is asked of the parameters: as the study says, or each with its neighbours.

    Raises:
        StudyError: no such parameter, or no step that can be taken.
    """
    for name in spec.vary.parameters:
        if name not in rover.parameters:
            cure = nearest(name, rover.parameters)
            raise StudyError("no such parameter", element=f"vary.parameters.{name}", cure=cure)
    if spec.cases.sampler != "sensitivity":
        return spec.vary.parameters
    bounds = {name: each.bounds for name, each in declared(rover).items()}
    return probes(spec.cases, spec.vary.parameters, rover.parameters, bounds)
