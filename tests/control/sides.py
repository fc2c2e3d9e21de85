"""HIT-MRII's sides, motions that keep contacts, finite differences: what tests of control share."""

import numpy as np

from rover_pin.control.layout import Layout, Side

HIT = Layout(
    Side("left", ("LF", "LM", "LB"), "L_diff", "L_act", "L_bogie"),
    Side("right", ("RF", "RM", "RB"), "R_diff", "R_act", "R_bogie"),
)


def sides_of(count):
    """A layout with `count` wheels a side; only names."""
    left, right = (tuple(f"{s}{i}" for i in range(count)) for s in "LR")
    return Layout(Side("left", left, "lh", "lr"), Side("right", right, "rh", "rr"))


def motion(at, wanted, lifted=(), locked=(), held=()):
    """dq/dt that keeps contacts without sliding, couplings, clutches, held joints, with rates as wanted."""
    which = np.array([i for i, name in enumerate(at.bodies.names) if name not in lifted])
    points, joints = at.contacts[which, 1:4], at.bodies.rolling_joints[which]
    rows = [at.rows(joints, points, np.tile(axis, (len(which), 1))) for axis in np.eye(3)]
    rows.append(np.array([coupling.row for coupling in at.rover.couplings]))
    rows.append(np.eye(at.rover.model.nv)[[at.rover.column[name] for name in (*locked, *held)]])
    _, size, right = np.linalg.svd(np.vstack(rows))
    basis = right[int(np.sum(size > 1e-9 * size[0])) :].T
    columns = [at.rover.column[name] for name in wanted]
    x, *_ = np.linalg.lstsq(basis[columns], np.array(list(wanted.values())), rcond=None)
    v = basis @ x
    np.testing.assert_allclose(v[columns], list(wanted.values()), atol=1e-9)
    return v


def slope(function, q, step=1e-6):
    """(parts, nv) central differences of function(q)."""
    columns = []
    for shift in step * np.eye(len(q)):
        columns.append((function(q + shift) - function(q - shift)) / (2 * step))
    return np.array(columns).T
