"""How freely the joints move among themselves: rank, redundancy and mobility of couplings and loops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from rover_pin.errors import MechanismError
from rover_pin.mechanism import Bilateral, Coupling, Kinematics, Loop
from rover_pin.numerics import Array

_RANK = 1e-7  # singular values below this share of the largest count as zero


@dataclass(frozen=True)
class Mobility:
    """Counts at the home posture, loops closed there.

    Attributes:
        joints: degrees of freedom of the moving joints; the base does not count.
        rows: equations of all couplings and loops.
        rank: how many of them are independent.
        redundancy: rows - rank.
        mobility: joints - rank.
    """

    joints: int
    rows: int
    rank: int

    @property
    def redundancy(self) -> int:
        """How many equations say what others say already."""
        return self.rows - self.rank

    @property
    def mobility(self) -> int:
        """How many joints may still be chosen."""
        return self.joints - self.rank


def measure_mobility(
    model: pin.Model, couplings: Sequence[Coupling], loops: Sequence[Loop], home: Array, first: int
) -> Mobility:
    """Rank of the stacked Jacobian [couplings; loops] on the joints' columns, at home with the loops closed.

    Args:
        model: Pinocchio's model.
        couplings: linear rows.
        loops: closed loops.
        home: (nv,) where to start closing.
        first: column of the first joint.

    Raises:
        MechanismError: a loop that cannot close.
    """
    elements: list[Bilateral] = [*couplings, *loops]
    joints = model.nv - first
    rows = sum(e.size for e in elements)
    if not rows or not joints:
        return Mobility(joints, rows, 0)
    at = close_loops(model, couplings, loops, home, first)
    jacobian = np.vstack([e.jacobian(at) for e in elements])[:, first:]
    values = np.linalg.svd(jacobian, compute_uv=False)
    return Mobility(joints, rows, int(np.sum(values > _RANK * max(float(values[0]), 1e-300))))


def close_loops(
    model: pin.Model, couplings: Sequence[Coupling], loops: Sequence[Loop], start: Array, first: int
) -> Kinematics:
    """The configuration near `start` where couplings and loops hold, by damped Gauss-Newton on the joints.

    Raises:
        MechanismError: it does not close; names the worst loop or coupling and its residual.
    """
    elements: list[Bilateral] = [*couplings, *loops]
    data = model.createData()
    q = np.array(start)
    at = Kinematics(model, data, q)
    for _ in range(100):
        residual = np.concatenate([e.residual(at) for e in elements])
        size = float(np.linalg.norm(residual))
        if size < 1e-11:
            break
        jacobian = np.vstack([e.jacobian(at) for e in elements])[:, first:]
        step = np.zeros(model.nv)
        step[first:] = np.linalg.lstsq(jacobian, -residual, rcond=_RANK)[0]
        step *= min(1.0, 0.5 / max(float(np.abs(step).max()), 1e-300))
        scale = 1.0
        while scale > 1e-4:
            trial = Kinematics(model, data, q + scale * step)
            if np.linalg.norm(np.concatenate([e.residual(trial) for e in elements])) < size:
                break
            scale /= 2
        else:
            break
        q = q + scale * step
        at = Kinematics(model, data, q)
    at = Kinematics(model, data, q)
    _refuse_open(elements, at)
    return at


def _refuse_open(elements: Sequence[Bilateral], at: Kinematics) -> None:
    worst = max(elements, key=lambda e: float(np.abs(e.residual(at)).max()))
    left = float(np.abs(worst.residual(at)).max())
    tolerance = worst.tolerance if isinstance(worst, Loop) else 1e-9
    if left > tolerance:
        kind = "loops" if isinstance(worst, Loop) else "couplings"
        raise MechanismError(
            f"it cannot close from the home posture: {left:.3g} m or rad remain",
            element=f"{kind}.{worst.name}",
            cure="check its frames and lengths, or give a `home` posture near to where it closes",
        )
