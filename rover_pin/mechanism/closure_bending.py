"""Second derivatives of the loops' residuals, for multipliers that hold them closed."""

from __future__ import annotations

from rover_pin.mechanism.bending import bend_fixed_pull, bend_strut
from rover_pin.mechanism.closure import DISTANCE, HINGE, LEVEL, PLANAR, WELD
from rover_pin.mechanism.columns import Integers, is_above, speed
from rover_pin.numerics import Array, formula, inlined

Three = tuple[float, float, float]


@inlined
def _cross(a: Three, b: Three) -> Three:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inlined
def _dot(a: Three, b: Three) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def _column(r: Array, across: Array, i: int) -> Three:
    """Column i of `across`, turned into the world."""
    u, v, w = across[0, i], across[1, i], across[2, i]
    return (
        r[0, 0] * u + r[0, 1] * v + r[0, 2] * w,
        r[1, 0] * u + r[1, 1] * v + r[1, 2] * w,
        r[2, 0] * u + r[2, 1] * v + r[2, 2] * w,
    )


@inlined
def _turn(turn: Array, c: int) -> Three:
    return turn[c, 0], turn[c, 1], turn[c, 2]


@inlined
def _take(out: Array, c: int, j: int, value: float) -> None:
    """Take a second derivative off both its places."""
    out[c, j] -= value
    if c != j:
        out[j, c] -= value


@formula
def bend_loop(
    kind: int, across: Array, parent: Integers, turn: Array, move: Array, ref: Array, ends: Integers,
    o: Array, r: Array, pulls: Array, rates: Array, out: Array,
) -> None:  # fmt: skip
    """Take sum of multipliers times second derivatives of a loop's residual off `out`.

    The residuals are those of `rover_pin.mechanism.closure.close`; a weld's are taken where it is closed.

    Args:
        kind: BALL, HINGE, PLANAR, WELD, DISTANCE or LEVEL.
        across: (3, 3) as of `close`.
        parent: (m,) columns as of `rover_pin.mechanism.columns`.
        turn: (m, 3).
        move: (m, 3).
        ref: (3,) m.
        ends: (2,) columns of the two bodies.
        o: (2, 3) m, origins of the frames, world.
        r: (2, 3, 3) their rotations.
        pulls: (rows,) multipliers.
        rates: (m, 3) scratch.
        out: (m, m).
    """
    if kind == LEVEL:
        _bend_level(parent, turn, ends[0], _column(r[0], across, 2), pulls[0], out)
        return
    if kind == DISTANCE:
        bend_strut(parent, turn, move, ref, ends, o, pulls[0], 0.0, rates, out)
        return
    if kind == PLANAR:
        for i in range(2):
            _bend_offset(parent, turn, move, ref, ends, o, _column(r[0], across, i), pulls[i], out)
        return
    for i in range(2):
        s = 1.0 if i == 1 else -1.0
        bend_fixed_pull(  # rows along the world's axes, which do not turn with what carries both
            parent, turn, move, ref, ends[i], -1, o[i, 0], o[i, 1], o[i, 2], s * pulls[0],
            s * pulls[1], s * pulls[2], out,
        )  # fmt: skip
    if kind == HINGE:
        for i in range(2):
            first, second = _column(r[0], across, 2), _column(r[1], across, i)
            _bend_angle(parent, turn, ends, first, second, pulls[3 + i], out)
    if kind == WELD:
        a = r[0]
        x = a[0, 0] * pulls[3] + a[0, 1] * pulls[4] + a[0, 2] * pulls[5]
        y = a[1, 0] * pulls[3] + a[1, 1] * pulls[4] + a[1, 2] * pulls[5]
        z = a[2, 0] * pulls[3] + a[2, 1] * pulls[4] + a[2, 2] * pulls[5]
        _bend_weld(parent, turn, ends, (x, y, z), out)


@formula
def _bend_level(parent: Integers, turn: Array, e: int, axis: Three, pull: float, out: Array) -> None:
    """The height of a direction on the body of column e."""
    j = e
    while j >= 0:
        b = _cross(_turn(turn, j), axis)
        c = j
        while c >= 0:
            _take(out, c, j, pull * (turn[c, 0] * b[1] - turn[c, 1] * b[0]))
            c = parent[c]
        j = parent[j]


@formula
def _bend_offset(
    parent: Integers, turn: Array, move: Array, ref: Array, ends: Integers, o: Array, u: Three, pull: float,
    out: Array,
) -> None:  # fmt: skip
    """u . (o2 - o1), u a direction on the first body."""
    e = o[1, 0] - o[0, 0], o[1, 1] - o[0, 1], o[1, 2] - o[0, 2]
    bend_fixed_pull(
        parent, turn, move, ref, ends[1], ends[0], o[1, 0], o[1, 1], o[1, 2], pull * u[0], pull * u[1],
        pull * u[2], out,
    )  # fmt: skip
    j = ends[0]
    while j >= 0 and not is_above(parent, j, ends[1]):
        turned_j = _cross(_turn(turn, j), u)
        v_j = speed(turn, move, ref, j, o[0, 0], o[0, 1], o[0, 2])
        c = j
        while c >= 0 and not is_above(parent, c, ends[1]):
            w_c = _turn(turn, c)
            v_c = speed(turn, move, ref, c, o[0, 0], o[0, 1], o[0, 2])
            value = _dot(_cross(w_c, turned_j), e) - _dot(_cross(w_c, u), v_j)
            value -= _dot(turned_j, v_c) + _dot(u, _cross(w_c, v_j))
            _take(out, c, j, pull * value)
            c = parent[c]
        k = ends[1]
        while k >= 0 and not is_above(parent, k, ends[0]):
            v_k = speed(turn, move, ref, k, o[1, 0], o[1, 1], o[1, 2])
            _take(out, j, k, pull * _dot(turned_j, v_k))
            k = parent[k]
        j = parent[j]


@formula
def _bend_angle(
    parent: Integers, turn: Array, ends: Integers, u: Three, t: Three, pull: float, out: Array
) -> None:
    """u . t, directions on the first and on the second body."""
    for i in range(2):
        own, far = (u, t) if i == 0 else (t, u)
        j = ends[i]
        while j >= 0 and not is_above(parent, j, ends[1 - i]):
            turned_j = _cross(_turn(turn, j), own)
            c = j
            while c >= 0 and not is_above(parent, c, ends[1 - i]):
                _take(out, c, j, pull * _dot(far, _cross(_turn(turn, c), turned_j)))
                c = parent[c]
            if i == 0:
                k = ends[1]
                while k >= 0 and not is_above(parent, k, ends[0]):
                    _take(out, j, k, pull * _dot(turned_j, _cross(_turn(turn, k), t)))
                    k = parent[k]
            j = parent[j]


@formula
def _bend_weld(parent: Integers, turn: Array, ends: Integers, pull: Three, out: Array) -> None:
    """Twice the vector part of the quaternion from the first to the second body, at zero angle.

    Turns a, then b about axes fixed to what the former turned, make a + b + (a x b) / 2.
    """
    for i in range(2):
        sign = 0.5 if i == 1 else -0.5
        j = ends[i]
        while j >= 0 and not is_above(parent, j, ends[1 - i]):
            c = parent[j]
            while c >= 0 and not is_above(parent, c, ends[1 - i]):
                _take(out, c, j, sign * _dot(pull, _cross(_turn(turn, c), _turn(turn, j))))
                c = parent[c]
            if i == 0:
                k = ends[1]
                while k >= 0 and not is_above(parent, k, ends[0]):
                    _take(out, j, k, -0.5 * _dot(pull, _cross(_turn(turn, j), _turn(turn, k))))
                    k = parent[k]
            j = parent[j]
