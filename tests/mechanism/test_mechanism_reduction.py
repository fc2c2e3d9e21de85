"""Couplings and held values: every expanded configuration satisfies them, contradictions are told."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from rover_pin.errors import MechanismError, SidecarError
from rover_pin.mechanism import Coupling, CouplingSpec, Kinematics, Reduction, reduce_coordinates

NAMES = {i: f"j{i}" for i in range(12)}
COLUMNS = {name: i for i, name in NAMES.items()}


def coupling(name, coefficients, offset=0.0, nv=8):
    return CouplingSpec(
        name=name, joints={NAMES[c]: k for c, k in coefficients.items()}, offset=offset
    ).resolve(COLUMNS, nv)


coefficient = st.sampled_from([-3.0, -1.0, -0.5, 0.25, 1.0, 2.0, 7.0]) | st.floats(0.1, 3.0)
row = st.dictionaries(st.integers(0, 7), coefficient, min_size=1, max_size=4)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(
    rows=st.lists(row, min_size=0, max_size=5),
    truth=st.lists(st.floats(-1, 1), min_size=8, max_size=8),
    held=st.sets(st.integers(0, 7), max_size=6),
    seed=st.integers(0, 1000),
)
def test_every_expanded_configuration_satisfies_couplings_and_held_values(rows, truth, held, seed):
    """Offsets and held values are taken from one configuration, so that they are consistent."""
    truth = np.array(truth)
    couplings = []
    for i, coefficients in enumerate(rows):
        offset = sum(k * truth[c] for c, k in coefficients.items())
        couplings.append(coupling(f"c{i}", coefficients, offset))
    reduction = reduce_coordinates(8, couplings, {c: truth[c] for c in held}, NAMES)
    generator = np.random.default_rng(seed)
    z = generator.normal(0, 1, len(reduction.columns))
    q = reduction.expand(z)
    np.testing.assert_allclose(reduction.pick(q), z, atol=1e-12)
    for c in held:
        assert q[c] == truth[c]
    size = 1 + np.abs(q).max()
    for element in couplings:
        assert abs(element.row @ q - element.offset) < 1e-9 * size * np.abs(element.row).max()
    stacked = np.array([element.row for element in couplings]).reshape(-1, 8)[
        :, [c for c in range(8) if c not in held]
    ]
    values = np.linalg.svd(stacked, compute_uv=False) if stacked.size else np.zeros(0)
    assume(not np.any((values > 1e-13) & (values < 1e-6)))
    rank = int(np.sum(values > 1e-9))
    assert len(reduction.columns) == 8 - len(held) - rank
    np.testing.assert_allclose(reduction.expand(reduction.pick(truth)), truth, atol=1e-8)


def test_no_coupling_and_nothing_held_is_the_identity():
    reduction = reduce_coordinates(4, [], {}, NAMES)
    np.testing.assert_array_equal(reduction.basis, np.eye(4))
    np.testing.assert_array_equal(reduction.offset, np.zeros(4))
    assert reduction.columns == (0, 1, 2, 3)


def test_everything_held_leaves_nothing():
    reduction = reduce_coordinates(3, [], {0: 1.0, 1: 2.0, 2: 3.0}, NAMES)
    assert reduction.basis.shape == (3, 0)
    np.testing.assert_array_equal(reduction.expand(np.zeros(0)), [1, 2, 3])


def test_a_gear_with_an_offset():
    """j1 = 3 j0 - 0.5."""
    reduction = reduce_coordinates(2, [coupling("gear", {0: 3.0, 1: -1.0}, 0.5, 2)], {}, NAMES)
    for z in (-1.0, 0.0, 0.7):
        q = reduction.expand(np.array([z]))
        assert q[1] == pytest.approx(3 * q[0] - 0.5, abs=1e-14)


def test_a_held_joint_moves_what_is_coupled_to_it():
    reduction = reduce_coordinates(3, [coupling("gear", {0: 2.0, 1: -1.0}, 0.0, 3)], {0: 0.3}, NAMES)
    assert reduction.columns == (2,)
    np.testing.assert_allclose(reduction.expand(np.array([9.0])), [0.3, 0.6, 9.0])


def test_redundant_couplings_count_once():
    twice = [coupling("one", {0: 1.0, 1: 1.0}, 0.2), coupling("other", {0: -2.0, 1: -2.0}, -0.4)]
    chain = [*twice, coupling("a", {1: 1.0, 2: 1.0}), coupling("b", {0: 1.0, 2: -1.0}, 0.2)]
    assert len(reduce_coordinates(8, twice, {}, NAMES).columns) == 7
    assert len(reduce_coordinates(8, chain, {}, NAMES).columns) == 6


def test_held_values_that_contradict_tell_the_residual():
    differential = coupling("differential", {0: 1.0, 1: 1.0}, 0.1)
    with pytest.raises(MechanismError) as caught:
        reduce_coordinates(8, [differential], {0: 0.3, 1: 0.2}, NAMES)
    text = str(caught.value)
    assert text.startswith("couplings.differential: held values contradict the coupling, residual -0.4")
    assert "j0 0.3, j1 0.2" in text
    assert text.endswith("hold fewer of its joints, or at values that satisfy it")


def test_held_values_that_contradict_through_a_chain_are_found():
    chain = [coupling("first", {0: 1.0, 1: -1.0}), coupling("second", {1: 1.0, 2: -1.0})]
    with pytest.raises(MechanismError, match=r"residual -?0\.5"):
        reduce_coordinates(8, chain, {0: 0.5, 2: 1.0}, NAMES)
    agreed = reduce_coordinates(8, chain, {0: 0.5, 2: 0.5}, NAMES)
    assert agreed.offset[1] == pytest.approx(0.5)


def test_couplings_that_contradict_each_other_are_found():
    with pytest.raises(MechanismError, match=r"residual -?2"):
        reduce_coordinates(8, [coupling("a", {0: 1.0}, 1.0), coupling("b", {0: 1.0}, 3.0)], {}, NAMES)


def test_a_contradiction_within_the_tolerance_passes():
    rows = [coupling("c", {0: 1.0, 1: 1.0})]
    held = {0: 0.3, 1: -0.3 + 1e-7}
    with pytest.raises(MechanismError):
        reduce_coordinates(8, rows, held, NAMES)
    reduce_coordinates(8, rows, held, NAMES, tolerance=1e-6)


def test_what_a_reduction_hands_out_is_read_only():
    reduction = reduce_coordinates(3, [], {}, NAMES)
    assert isinstance(reduction, Reduction)
    for array in (reduction.basis, reduction.offset):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


def test_couplings_rows_and_residual():
    from little_rover import fixture

    rover = fixture("thirds")
    (differential,) = rover.couplings
    assert isinstance(differential, Coupling)
    q = np.random.default_rng(1).normal(0, 1, rover.model.nv)
    here = Kinematics(rover.model, rover.model.createData(), q)
    expected = q[rover.column["rocker_l"]] + q[rover.column["rocker_r"]]
    np.testing.assert_allclose(differential.residual(here), [expected], atol=1e-15)
    np.testing.assert_array_equal(differential.jacobian(here)[0], differential.row)
    assert differential.size == 1


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"joints": {}}, "at least one joint"),
        ({"joints": {"a": 0}}, "the coefficient of a must be finite and not 0, got 0"),
        ({"joints": {"a": float("nan")}}, "the coefficient of a must be finite"),
        ({"joints": {"a": 1}, "offset": float("inf")}, "offset must be finite"),
        ({"joints": {"a": 1}, "ofset": 1}, "Extra inputs"),
    ],
)
def test_a_coupling_that_says_nothing_sensible_is_refused(fields, message):
    with pytest.raises(ValidationError, match=message):
        CouplingSpec(**{"name": "c", **fields})


def test_unknown_joint_names_the_nearest():
    with pytest.raises(SidecarError) as caught:
        CouplingSpec(name="c", joints={"rocker_left": 1}).resolve(
            {"rocker_l": 6, "rocker_r": 7}, 8, file="r.yaml"
        )
    text = str(caught.value)
    assert text.startswith("r.yaml: couplings.c: no moving joint of this name (got 'rocker_left'); did")
    assert "'rocker_l'" in text
