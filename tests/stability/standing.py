"""Rovers made by hand that stand, for the measures of regions."""

import dataclasses

import numpy as np
from hand_made import rough, stance_of, with_pivot

import rover_pin as rp
from rover_pin.stability.measure import Standing
from rover_pin.stability.registry import MEASURES
from rover_pin.statics.friction_problem import make_problem

SQUARE = np.array([[1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]])
FOUR = ("fl", "fr", "rl", "rr")
FLAT = rp.Terrain.flat()


def measured(name, problem, com=(0.0, 0.0, 0.3), yaw=0.0):
    """A measure of a problem made by hand."""
    stance = dataclasses.replace(stance_of(problem.contacts, com, problem.weight), rpy=np.array([0, 0, yaw]))
    standing = Standing(stance)
    standing.__dict__["problem"] = problem
    return MEASURES[name].evaluate(standing)


def with_bogies(seed):
    """Six wheels on rough ground, middle and rear ones on a bogie a side."""
    problem = rough(seed)
    points = np.array([c.point for c in problem.contacts])
    rows = problem.rows
    for side, members in ((0.5, (2, 4)), (-0.5, (3, 5))):
        rows = with_pivot(rows, points, members, (-0.5, side, 0.3))
    return make_problem(problem.contacts, rows, problem.weight, 0.6, problem.driven)


def area(corners):
    """Of a polygon, m2."""
    x, y = np.array(corners).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
