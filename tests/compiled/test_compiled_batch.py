"""What a batch promises: an answer hangs on its case alone; what it cannot answer is left open, in words."""

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.compiled import COMPILED_MEASURES, GROUNDED, OFF_MAP, OPEN, SETTLED, Batch
from rover_pin.errors import InputError

TERRAIN = rp.Terrain.rough(1, 0.05, 0.8, size=12)


@pytest.fixture(scope="module")
def rover():
    return rp.load("rocker_bogie")


def places(count, seed=0, reach=4.5):
    rng = np.random.default_rng(seed)
    return *rng.uniform(-reach, reach, (2, count)), rng.uniform(0.0, 2.0 * np.pi, count)


def same(one, other):
    for name in ("code", "z_m", "roll_rad", "pitch_rad", "joint_rad", "load_n", "equilibrium", "gap_m"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    for name, values in one.value.items():
        np.testing.assert_array_equal(values, other.value[name])


def subset(answers, rows):
    """Some cases of answers, as far as `same` looks."""

    class Part:
        pass

    part = Part()
    for name in ("code", "z_m", "roll_rad", "pitch_rad", "joint_rad", "load_n", "equilibrium", "gap_m"):
        setattr(part, name, getattr(answers, name)[rows])
    part.value = {name: values[rows] for name, values in answers.value.items()}
    return part


@pytest.mark.parametrize("vary", ["place", "track", "steering"])
def test_an_answer_hangs_on_its_case_alone_to_the_last_bit(rover, vary):
    count = 700
    x, y, yaw = places(count)
    more = {}
    if vary == "track":
        more = {"parameters": {"track": np.linspace(1.0, 1.4, count)}}
    if vary == "steering":
        more = {"joints": {"steer_fl": np.linspace(-0.5, 0.5, count)}}
    whole = Batch(rover, TERRAIN, measures=COMPILED_MEASURES).answer(x, y, yaw, **more)
    assert np.mean(whole.code == SETTLED) > 0.98
    rows = np.random.default_rng(1).permutation(count)[:40]
    for chosen in (rows, rows[:1]):
        part = {key: {name: v[chosen] for name, v in values.items()} for key, values in more.items()}
        few = Batch(rover, TERRAIN, measures=COMPILED_MEASURES).answer(
            x[chosen], y[chosen], yaw[chosen], **part
        )
        same(few, subset(whole, chosen))


def test_loads_carry_the_weight_and_none_is_negative(rover):
    answers = Batch(rover, TERRAIN).answer(*places(2000))
    there = answers.settled
    np.testing.assert_allclose(answers.load_n[there].sum(axis=1), rover.mass * 9.81, rtol=1e-9)
    assert np.min(answers.load_n[there]) >= 0.0
    assert np.max(answers.equilibrium[there]) < 1e-12
    assert np.max(answers.gap_m[there]) < 1e-9


def test_where_on_the_map_does_not_matter(rover):
    heights = TERRAIN.height(np.arange(-6, 6, 0.05)[None, :], np.arange(-6, 6, 0.05)[:, None])
    here = rp.Terrain.from_grid(heights, 0.05, (0.0, 0.0))
    there = rp.Terrain.from_grid(heights, 0.05, (300.0, -200.0))
    x, y, yaw = places(50, reach=4.0)
    one = Batch(rover, here).answer(x + 6.0, y + 6.0, yaw)
    other = Batch(rover, there).answer(x + 306.0, y - 194.0, yaw)
    np.testing.assert_allclose(one.z_m, other.z_m, atol=1e-9)
    np.testing.assert_allclose(one.load_n, other.load_n, atol=1e-6)


def test_a_map_seen_in_a_mirror_mirrors_the_loads(rover):
    grid = TERRAIN.height(np.arange(-5, 5.01, 0.05)[None, :], np.arange(-5, 5.01, 0.05)[:, None])
    x, y, yaw = places(40, reach=3.0)
    one = Batch(rover, rp.Terrain.from_grid(grid, 0.05, (-5, -5))).answer(x, y, yaw)
    other = Batch(rover, rp.Terrain.from_grid(grid[::-1], 0.05, (-5, -5))).answer(x, -y, -yaw)
    np.testing.assert_allclose(
        one.load_n[:, [0, 1, 2, 3, 4, 5]], other.load_n[:, [3, 4, 5, 0, 1, 2]], atol=1e-6
    )
    np.testing.assert_allclose(one.roll_rad, -other.roll_rad, atol=1e-9)


def test_off_the_map_and_grounded_are_answers_with_their_words(rover):
    answers = Batch(rover, TERRAIN).answer(np.array([5.9]), np.array([0.0]), np.array([0.0]))
    assert answers.code.tolist() == [OFF_MAP]
    stance = rp.settle(rover, TERRAIN, x=5.9)
    assert [words[0] for words in answers.words()] == [str(stance.status), stance.reason]
    bump = rp.Terrain.from_grid(
        0.5 * np.exp(-(np.hypot(*np.meshgrid(np.arange(-3, 3, 0.05), np.arange(-3, 3, 0.05))) ** 2) / 0.02),
        0.05,
        (-3.0, -3.0),
    )
    answers = Batch(rover, bump).answer(np.zeros(1), np.zeros(1), np.zeros(1))
    stance = rp.settle(rover, bump)
    assert str(stance.status) == "grounded"
    assert answers.code.tolist() == [GROUNDED]
    assert [words[0] for words in answers.words()] == ["grounded", stance.reason]


def test_what_the_kernels_cannot_serve_is_left_open(rover):
    wavy = rp.Terrain.from_function(lambda x, y: 0.05 * np.sin(x) * np.cos(y))
    batch = Batch(rover, wavy)
    assert batch.refusal == "the terrain is a Python function"
    assert np.all(batch.answer(*places(5)).code == OPEN)
    steep = Batch(rover, rp.Terrain.slope(70)).answer(*places(5))
    assert np.all(steep.code == OPEN)
    assert steep.words()[0].tolist() == [""] * 5


def test_values_beyond_limits_are_left_to_the_path_that_words_errors(rover):
    x, y, yaw = places(3)
    answers = Batch(rover, TERRAIN).answer(x, y, yaw, joints={"steer_fl": np.array([0.0, 9.0, 0.1])})
    assert answers.code.tolist() == [SETTLED, OPEN, SETTLED]


def test_an_unknown_measure_is_refused(rover):
    with pytest.raises(
        InputError, match=r"measures: is no compiled measure \(got 'tipp'\); did you mean 'tip'"
    ):
        Batch(rover, TERRAIN, measures=["tipp"])
