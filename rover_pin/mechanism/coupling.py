"""Couplings: a linear equation between joint positions (a differential, a gear pair, a mimic)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from pydantic import BaseModel, ConfigDict, field_validator

from rover_pin.errors import SidecarError, nearest
from rover_pin.mechanism.kinematics import Kinematics
from rover_pin.numerics import Array, frozen


class CouplingSpec(BaseModel):
    """`{name: differential, joints: {rocker_l: 1, rocker_r: 1}, offset: 0.0}`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str
    joints: dict[str, float]
    offset: float = 0.0

    @field_validator("joints")
    @classmethod
    def _useful(cls, value: dict[str, float]) -> dict[str, float]:
        if not value:
            raise ValueError("a coupling needs at least one joint")
        for joint, coefficient in value.items():
            if not math.isfinite(coefficient) or coefficient == 0.0:
                raise ValueError(f"the coefficient of {joint} must be finite and not 0, got {coefficient}")
        return value

    @field_validator("offset")
    @classmethod
    def _finite(cls, value: float) -> float:
        if not math.isfinite(value):
            raise ValueError("offset must be finite")
        return value

    def resolve(self, columns: Mapping[str, int], nv: int, *, file: object = None) -> Coupling:
        """The coupling as a row on the configuration.

        Raises:
            SidecarError: a joint that the model does not have.
        """
        row = np.zeros(nv)
        for joint, coefficient in self.joints.items():
            if joint not in columns:
                raise SidecarError(
                    "no moving joint of this name",
                    file=file,
                    element=f"couplings.{self.name}",
                    value=joint,
                    cure=nearest(joint, columns),
                )
            row[columns[joint]] = coefficient
        return Coupling(self.name, dict(self.joints), self.offset, frozen(row))


@dataclass(frozen=True)
class Coupling:
    """sum of coefficient times joint position = offset.

    Attributes:
        name: as in the sidecar.
        joints: coefficient per joint name.
        offset: right-hand side [rad or m].
        row: (nv,) the coefficients on the configuration.
    """

    name: str
    joints: Mapping[str, float]
    offset: float
    row: Array

    @property
    def size(self) -> int:
        """One row."""
        return 1

    def residual(self, at: Kinematics) -> Array:
        """(1,) row . q - offset."""
        return np.array([self.row @ at.q - self.offset])

    def jacobian(self, at: Kinematics) -> Array:
        """(1, nv) the row itself."""
        return self.row[None, :]
