"""Which wheels may be lifted together."""

from itertools import combinations

import pytest
from sides import HIT, sides_of

from rover_pin.control.motion_constraints import Options, admissible_sets, broken_rules
from rover_pin.control.now import Now
from rover_pin.errors import InputError

PAIRS = {"LF RF", "LM RM", "LB RB", "LF RM", "LM RF", "LM RB", "LB RM"}


def test_fourteen_sets_of_six_wheels():
    sets = admissible_sets(HIT)
    assert len(sets) == len(set(sets)) == 14
    assert sets[0] == frozenset()
    assert {" ".join(sorted(s)) for s in sets[1:7]} == {"LF", "LM", "LB", "RF", "RM", "RB"}
    assert {" ".join(sorted(s)) for s in sets[7:]} == PAIRS


@pytest.mark.parametrize("count", [2, 3, 4, 5])
def test_sides_of_any_length(count):
    """Counted over all subsets, by the three rules in words."""
    layout = sides_of(count)
    ends = {"0": "front", str(count - 1): "rear"}

    def fits(chosen):
        where = {ends.get(wheel[1:]) for wheel in chosen}
        one_a_side = len({wheel[0] for wheel in chosen}) == len(chosen)
        return len(chosen) <= 2 and one_a_side and not {"front", "rear"} <= where

    subsets = [frozenset(c) for n in range(2 * count + 1) for c in combinations(layout.wheels, n)]
    assert set(admissible_sets(layout)) == {s for s in subsets if fits(s)}
    assert len(admissible_sets(layout)) == 1 + 2 * count + count**2 - 2


def test_fewer_at_once():
    assert len(admissible_sets(HIT, most=1)) == 7
    assert admissible_sets(HIT, most=0) == (frozenset(),)
    assert broken_rules(HIT, ["LF", "RF"], most=1) == ("too many wheels",)


@pytest.mark.parametrize(
    ("lifted", "broken"),
    [((), 0), (("RF",), 0), (("LM", "RF"), 0), (("LF", "RB"), 1), (("LM", "LB"), 1), (("LF", "LB"), 2),
     (("LF", "RM", "RB"), 3)],
)  # fmt: skip
def test_counts_broken_rules(constraints, level, raised, still, lifted, broken):
    now = Now(level.at(raised.configuration), still, still, lifted=lifted)
    assert constraints["lifted_set"].value(now).tolist() == [broken]
    assert not constraints["lifted_set"].gradient(now).any()


def test_refuses_a_set(constraints):
    constraints["lifted_set"].require(["LM", "RF"])
    with pytest.raises(InputError) as caught:
        constraints["lifted_set"].require(["RB", "LF"])
    assert str(caught.value) == (
        "lifted wheels: may not be lifted together: a front with a rear wheel (got 'LF, RB'); "
        "lift at most 2, one a side, no front with a rear wheel"
    )


def test_unknown_wheel():
    with pytest.raises(InputError, match=r"LX: no wheel of that name; did you mean 'LM' or 'LF' or 'LB'\?"):
        broken_rules(HIT, ["LX"])


@pytest.mark.parametrize("most", [3, -1, True, 1.5])
def test_most_lifted(most):
    with pytest.raises(InputError, match="most_lifted: must be 0, 1 or 2 wheels"):
        Options(most_lifted=most)
