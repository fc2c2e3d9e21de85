"""The Pinocchio model: a floating base of translation and ZYX Euler angles, so that q is a plain vector."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import numpy as np
import pinocchio as pin

from rover_pin.description.limits import Limits
from rover_pin.numerics import Array, frozen

BASE_DOF = ("base_x", "base_y", "base_z", "base_yaw", "base_pitch", "base_roll")
_FIRST_JOINT = 2  # Pinocchio's id of the first moving joint: 0 is the universe, 1 the base


def build_model(urdf: str, name: str, taken: Collection[str] = ()) -> pin.Model:
    """The model of a sanitised URDF text.

    q = [x, y, z, yaw, pitch, roll, joints...] with R = Rz(yaw) Ry(pitch) Rx(roll) of the root link,
    nq == nv and v = dq/dt. A free-flyer's base is used always: a fixed one would lose the root link's mass.

    Args:
        urdf: the text.
        name: of the robot.
        taken: joint names of the URDF, which the base's own must not be.
    """
    own = "root_joint"
    while own in taken:
        own = f"_{own}"
    base = pin.JointModelComposite()
    base.addJoint(pin.JointModelTranslation())
    base.addJoint(pin.JointModelSphericalZYX())
    model = pin.buildModelFromXML(urdf, base, own)
    model.name = name
    return model


def joint_names(model: pin.Model) -> tuple[str, ...]:
    """The moving joints, in the order of q."""
    return tuple(str(n) for n in list(model.names)[_FIRST_JOINT:])


def set_limits(model: pin.Model, limits: Mapping[str, Limits]) -> dict[str, Array]:
    """`lower`, `upper`, `effort`, `velocity` of every degree of freedom, (nv,) each, +-inf where none.

    The model is given the same limits, so that who reads it sees them too.
    """
    arrays = {
        key: np.full(model.nv, sign * np.inf)
        for key, sign in (("lower", -1), ("upper", 1), ("effort", 1), ("velocity", 1))
    }
    for i, name in enumerate(joint_names(model)):
        for key, array in arrays.items():
            array[len(BASE_DOF) + i] = getattr(limits[name], key)
    model.lowerPositionLimit, model.upperPositionLimit = arrays["lower"], arrays["upper"]
    model.upperEffortLimit, model.lowerEffortLimit = arrays["effort"], -arrays["effort"]
    model.upperVelocityLimit, model.lowerVelocityLimit = arrays["velocity"], -arrays["velocity"]
    return {key: frozen(array) for key, array in arrays.items()}
