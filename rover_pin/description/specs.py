"""What a sidecar may say about joints, masses, wheels, feet and belly.

The mechanism's elements bring their own specs.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, FiniteFloat

Vector = tuple[FiniteFloat, FiniteFloat, FiniteFloat]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]


def _pointing(vector: Vector) -> Vector:
    if sum(v * v for v in vector) < 1e-18:
        raise ValueError("a zero vector points nowhere")
    return vector


Direction = Annotated[Vector, AfterValidator(_pointing)]


class Spec(BaseModel):
    """Base: unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class FreeSpec(Spec):
    """A joint the URDF fixes and the robot does not.

    Attributes:
        type: how it moves.
        axis: in the joint's frame.
        limits: rad or m, or None where it has none.
    """

    type: Literal["revolute", "prismatic", "continuous"]
    axis: Direction = (0.0, 0.0, 1.0)
    limits: tuple[FiniteFloat, FiniteFloat] | None = None


class InertialSpec(Spec):
    """A link's mass properties, in place of the URDF's.

    Attributes:
        mass: kg.
        com: m, in the link's frame.
        inertia: ixx, iyy, izz, ixy, ixz, iyz about the centre of mass, in the link's axes, kg m2.
    """

    mass: NotNegative
    com: Vector = (0.0, 0.0, 0.0)
    inertia: tuple[NotNegative, NotNegative, NotNegative, FiniteFloat, FiniteFloat, FiniteFloat] = (0.0,) * 6


class WheelSpec(Spec):
    """A wheel.

    Attributes:
        frame: link or joint whose frame `center` and `axis` are given in.
        name: the frame's where silent.
        center: m.
        axis: that of the nearest moving joint above where silent.
        radius: m, to the tread's outermost circle.
        width: m.
        tread: radius of the rounding of the rim, m; the lesser of half the width and the radius where silent.
        friction: Coulomb's coefficient.
        free: whether it turns freely and so carries no rolling force.
        auxiliary: whether it touches only where the ground rises to it (a sprocket, an idler, a tail wheel),
            so that how evenly loads are shared does not count it.
    """

    frame: str
    name: str | None = None
    center: Vector = (0.0, 0.0, 0.0)
    axis: Direction | None = None
    radius: Positive
    width: NotNegative | None = None
    tread: NotNegative | None = None
    friction: NotNegative = 0.6
    free: bool = False
    auxiliary: bool = False


class FootSpec(Spec):
    """A point (radius 0) or spherical foot."""

    frame: str
    name: str | None = None
    center: Vector = (0.0, 0.0, 0.0)
    radius: NotNegative = 0.0
    friction: NotNegative = 0.6


class BellySpec(Spec):
    """A point of the body that must stay above the ground, m in its frame."""

    frame: str
    point: Vector
