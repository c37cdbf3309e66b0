"""Slews between directions, their rolls free or limited, by CasADi and IPOPT: the peer of pointing.py.

The program of general.py with the roll at either end as a variable: the attitude there is a given one,
turned about the boresight. IPOPT moves a roll to the nearest minimum, so there are many starts: the
rolls of the shortest turn, then random ones.
"""

import time

import numpy as np

from cones import between, product, rotated, turn, unit
from detour import distance
from general import Craft, Model

INTERVALS = 40


def shortest(places, axes, ranges):
    """Rolls, rad, of the least turn between two places, on a grid."""
    grids = [
        np.zeros(1) if span is None else np.linspace(*(span if span[0] > -np.inf else (-np.pi, np.pi)), 73)
        for span in ranges
    ]
    pairs = [(a, b) for a in grids[0] for b in grids[1]]

    def angle(rolls):
        ends = [product(q, turn(axis * r)) for q, axis, r in zip(places, axes, rolls)]
        return distance(ends[0], ends[1] if ends[0] @ ends[1] >= 0 else -ends[1])

    return min(pairs, key=angle)


class Pointed:
    """The program of a slew between attitudes that may be rolled about axes within ranges, rad.

    A range is none where the attitude is given, and infinite where every roll will do.
    """

    def __init__(self, spacecraft, speeds, places, axes, ranges):
        self.craft = Craft(spacecraft)
        self.places, self.axes, self.ranges = places, axes, ranges
        self.least = shortest(places, axes, ranges)
        ends = [product(q, turn(axis * r)) for q, axis, r in zip(places, axes, self.least)]
        self.model = Model(self.craft, max(distance(*signed(ends)), 0.1), INTERVALS, axes=axes)
        for index, span in enumerate(ranges):
            bounds = (0.0, 0.0) if span is None else span
            self.model.bounds["lbx"][1 + index], self.model.bounds["ubx"][1 + index] = bounds
        self.momenta = self.craft.spin * np.array(speeds, float) / self.model.momentum

    def rolls(self, number, generator):
        """Rolls to start from."""
        if number == 0:
            return self.least
        drawn = []
        for span in self.ranges:
            low, high = (0.0, 0.0) if span is None else span
            if low == -np.inf:
                low, high = -np.pi, np.pi
            drawn.append(generator.uniform(low, high))
        # Every other start is near the shortest turn.
        share = 0.5 if number % 2 else 1.0
        return [one + share * (roll - one) for one, roll in zip(self.least, drawn)]

    def solve(self, number, generator):
        """Duration, s, of one start, none when it fails, and the time that it took, s."""
        rolls = self.rolls(number, generator)
        ends = [product(q, turn(axis * r)) for q, axis, r in zip(self.places, self.axes, rolls)]
        begin, end = signed(ends)
        path = between(begin, end, INTERVALS + 1)[1:]
        length = max(distance(begin, end), 0.1)
        guess = [self.craft.units(length)[0] / self.model.time, *rolls]
        for place in path:
            guess += [*np.zeros(len(self.momenta)), *unit(place), 0.0, 0.0, 0.0, *self.momenta]
        # The sign with which the guess arrives.
        goal = self.places[1] if product(inverse(ends[1]), end)[3] > 0 else -self.places[1]
        asked = np.concatenate([self.places[0], np.zeros(3), self.momenta, goal])
        wall, cpu = time.perf_counter(), time.process_time()
        answer = self.model.solver(x0=guess, p=asked, **self.model.bounds)
        taken = time.perf_counter() - wall, time.process_time() - cpu
        solved = self.model.solver.stats()["success"]
        return float(answer["f"]) * self.model.time if solved else None, taken


def inverse(q):
    return q * np.array([-1.0, -1.0, -1.0, 1.0])


def signed(ends):
    """Two attitudes with signs of the shorter way."""
    return ends[0], ends[1] if ends[0] @ ends[1] >= 0 else -ends[1]


def best(slew, starts, seed=0):
    """The shortest duration, s, of so many starts, or none, and the mean times of one solve, s."""
    ends = slew["ends"]
    program = Pointed(
        slew["spacecraft"],
        slew["speeds"],
        [np.array(end["attitude"]) for end in ends],
        [unit(end["axis"]) for end in ends],
        [end["range"] for end in ends],
    )
    generator = np.random.default_rng(seed)
    solves = [program.solve(number, generator) for number in range(starts)]
    found = [duration for duration, _ in solves if duration]
    wall, cpu = np.mean([taken for _, taken in solves], axis=0)
    return {"duration_s": min(found, default=None), "solved": len(found), "wall_s": wall, "cpu_s": cpu}


def off(attitude, end):
    """Angle, rad, by which the boresight at an attitude misses that of an end."""
    looks = [rotated(np.array(q), unit(end["axis"])) for q in (attitude, end["attitude"])]
    return float(np.arctan2(np.linalg.norm(np.cross(*looks)), looks[0] @ looks[1]))
