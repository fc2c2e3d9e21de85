"""Pieces of the compiled path against other means: bounds, proofs, hulls, small systems, the walk."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import rover_pin as rp
from rover_pin.compiled.bounds import HEIGHT, HOLLOW, RINGS, SHARES, STEEP, sure_within, tile
from rover_pin.compiled.ground import ground_of
from rover_pin.compiled.hull import hull
from rover_pin.compiled.linear import eliminate, is_positive, null_basis
from rover_pin.compiled.sweep import DEEPER, LEAST, sweep
from rover_pin.compiled.track import track
from rover_pin.contact.search import find_contacts
from rover_pin.terrain.surface import surface


def test_small_systems_as_lapack_has_them():
    rng = np.random.default_rng(0)
    for n in (1, 3, 6, 9):
        a, b = rng.normal(size=(n, n)), rng.normal(size=n)
        expected = np.linalg.solve(a, b)
        sign = np.sign(np.linalg.det(a))
        work, right = a.copy(), b.copy()
        assert eliminate(work, right, n) == sign
        np.testing.assert_allclose(right, expected, rtol=1e-9, atol=1e-12)
    assert eliminate(np.array([[1.0, 2.0], [2.0, 4.0]]), np.ones(2), 2) == 0.0


def test_null_motions_are_all_there_are():
    rng = np.random.default_rng(1)
    rows = rng.normal(size=(3, 7))
    basis = np.zeros((7, 7))
    assert null_basis(rows.copy(), 3, 7, basis) == 4
    np.testing.assert_allclose(rows @ basis[:, :4], 0.0, atol=1e-12)
    assert np.linalg.matrix_rank(basis[:, :4]) == 4
    assert null_basis(np.vstack([rows[0], 2.0 * rows[0]]), 2, 7, basis) == -1


def test_a_positive_symmetric_part_is_told():
    rng = np.random.default_rng(2)
    skew = rng.normal(size=(4, 4))
    a = np.eye(4) + skew - skew.T
    assert is_positive(a.copy(), 4, 0.5)
    assert not is_positive(a.copy(), 4, 1.5)


def test_hulls_as_qhull_has_them():
    rng = np.random.default_rng(3)
    for count in (3, 4, 6, 12):
        for _ in range(50):
            points = rng.normal(size=(count, 7))
            corners = np.zeros(2 * count + 2, dtype=np.int64)
            n = hull(points, np.arange(count), count, corners)
            expected = ConvexHull(points[:, 1:3]).vertices.tolist()
            turned = corners[:n].tolist()
            start = expected.index(turned[0])
            assert turned == expected[start:] + expected[:start]
    line = np.zeros((4, 7))
    line[:, 1] = line[:, 2] = np.arange(4.0)
    assert hull(line, np.arange(4), 4, np.zeros(10, dtype=np.int64)) == 0


@pytest.mark.parametrize("spacing", [0.05, 0.02])
def test_bounds_hold_everywhere_within_their_reach(spacing):
    terrain = rp.Terrain.rough(5, 0.1, 0.4, size=5, spacing=spacing)
    reaches = (0.06, 0.3)
    record, params, table, tiles = ground_of(terrain, reaches)
    rng = np.random.default_rng(4)
    for x, y in rng.uniform(-2.4, 2.4, (300, 2)):
        i, j = tile(record[0], tiles, x, y)
        for r, reach in enumerate(reaches):
            angle, far = rng.uniform(0, 2 * np.pi), reach * np.sqrt(rng.uniform())
            u = np.clip(x + far * np.cos(angle), -2.5, 2.5)
            v = np.clip(y + far * np.sin(angle), -2.5, 2.5)
            h, hx, hy, hxx, hxy, hyy = surface(terrain.kind, table, params, u, v)
            assert h <= tiles[r, i, j, HEIGHT]
            assert np.hypot(hx, hy) <= tiles[r, i, j, STEEP]
            assert np.linalg.eigvalsh([[hxx, hxy], [hxy, hyy]])[-1] <= tiles[r, i, j, HOLLOW] * (1 + 1e-9)


def wheels(terrain, count, seed, ring=0.1, tread=0.03):
    """Wheels that hang near the ground, each with the contact followed from below its centre."""
    rng = np.random.default_rng(seed)
    for x, y in rng.uniform(-2.0, 2.0, (count, 2)):
        axis = np.array([0.0, 1.0, 0.0]) + rng.normal(size=3) * [0.6, 0.0, 0.15]
        axis /= np.linalg.norm(axis)
        center = np.array([x, y, float(terrain.height(x, y)) + ring + tread + rng.uniform(-0.01, 0.02)])
        place, found = (x, y), None
        for _ in range(30):
            found = track(terrain.kind, terrain.table, terrain.params, *center, *axis, ring, tread, *place)
            place = found[1:3]
            if found[7] < 1e-9:
                break
        if found[7] < 1e-9:
            yield center, axis, np.array(found[:7])


@pytest.mark.parametrize(("rms", "hurst"), [(0.05, 0.8), (0.065, 0.5), (0.13, 0.5)])
def test_a_proven_contact_is_the_least_of_a_thorough_search(rms, hurst):
    ring, tread = 0.1, 0.03
    terrain = rp.Terrain.rough(6, rms, hurst, size=5)
    record, _, _, tiles = ground_of(terrain, tuple(share * (ring + tread) for share in SHARES))
    out = np.empty((8, 7))
    proven = looked = 0
    for center, axis, contact in wheels(terrain, 300, 7):
        search = (terrain.kind, terrain.table, terrain.params, terrain.spacing, 0, center, axis, ring, tread)
        find_contacts(*search, 1e-5, out)
        off = float(np.hypot(*(contact[1:3] - center[:2])))
        sure = sure_within(record[0], tiles, 0, contact[1], contact[2], off, axis[2], ring, tread, contact[0])
        if sure == np.inf:
            proven += 1
            assert contact[0] <= out[0, 0] + 1e-9
            continue
        i, j = tile(record[0], tiles, contact[1], contact[2])
        top = float(tiles[RINGS - 1, i, j, HEIGHT])
        told = sweep(
            record[0], terrain.params, terrain.table, *center, *axis, ring, tread, top, sure, contact
        )  # fmt: skip
        if told == LEAST and out[0, 0] < -2e-7:
            looked += 1
            assert contact[0] <= out[0, 0] + 1e-6
        if told == DEEPER:
            assert contact[0] < -2e-7
    assert proven + looked > 20


def test_a_followed_contact_is_that_of_the_search_on_gentle_ground():
    terrain = rp.Terrain.rough(8, 0.05, 0.8, size=5)
    out = np.empty((8, 7))
    for center, axis, contact in wheels(terrain, 100, 9):
        find_contacts(
            terrain.kind, terrain.table, terrain.params, terrain.spacing, 0, center, axis, 0.1, 0.03, 0.0, out
        )
        np.testing.assert_allclose(contact, out[0], atol=1e-8)
