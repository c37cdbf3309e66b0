"""Slews that keep boresights clear of cones by CasADi and IPOPT: the peer of keep_out.py.

The program of general.py (full state, constant torque on equal intervals, Runge-Kutta) with one more
inequality for every cone at every node and half-way between nodes. IPOPT goes round a cone on the
side where its guess lies; so there are many starts, through random clear attitudes.
"""

import time
from dataclasses import dataclass

import casadi as ca
import numpy as np

from cones import attitude, between, cones, least, product, turn
from detour import distance
from general import Craft, Model

INTERVALS = 40
# Looks between two nodes at a solution, and the deepest cut that is let pass there, degrees.
LOOKS = 8
MOST_CUT_DEG = 0.5
# How far from half-way the random attitudes are, rad, and how clear.
NEAREST, FARTHEST, ROOM = 0.3, 2.5, 0.02


@dataclass(frozen=True)
class Solve:
    """One start: duration, s (none when it failed), deepest cut, degrees, and its time, s."""

    duration: float | None
    cut_deg: float
    wall: float
    cpu: float


def margins(limits):
    """Cosines to spare of all cones, of a quaternion of about unit length."""
    q = ca.MX.sym("q", 4)
    spare = []
    for cone in limits:
        twice = 2 * ca.cross(q[:3], ca.DM(cone.axis))
        look = ca.DM(cone.axis) + q[3] * twice + ca.cross(q[:3], twice)
        beyond = np.cos(cone.half_angle) - ca.dot(look, ca.DM(cone.direction))
        spare.append(-beyond if cone.inside else beyond)
    return ca.Function("margins", [q], [ca.vertcat(*spare)])


class Clear:
    """A slew's program and its starts."""

    def __init__(self, scenario, intervals=INTERVALS):
        self.limits = cones(scenario)
        self.start, self.goal = attitude(scenario["start"]), attitude(scenario["targets"][0])
        self.craft, self.intervals = Craft(scenario["spacecraft"]), intervals
        angle = max(distance(self.start, self.goal), 0.1)
        self.model = Model(self.craft, angle, intervals, margins(self.limits))
        speeds = scenario["start"].get("wheel_speed_rad_s") or np.zeros(len(self.craft.spin))
        self.momenta = self.craft.spin * np.array(speeds, float) / self.model.momentum

    def way(self, number, generator):
        """Attitudes to guess from: directly, or through a random clear one, some the long way."""
        if number == 0:
            return [self.start, self.goal]
        half_way = between(self.start, self.goal, 3)[1]
        for _ in range(500):
            axis = generator.normal(size=3)
            angle = generator.uniform(NEAREST, FARTHEST)
            passed = product(half_way, turn(axis / np.linalg.norm(axis) * angle))
            if least(self.limits, passed) > ROOM:
                break
        return [self.start, passed, self.goal]

    def guess(self, way):
        """Variables of the program: nodes at equal steps along the way, at rest, without torques."""
        chain = [way[0]]
        for place in way[1:]:
            chain.append(place if chain[-1] @ place >= 0 else -place)
        turns = [distance(*pair) for pair in zip(chain, chain[1:])]
        total, found = max(sum(turns), 0.1), []
        for k in range(1, self.intervals + 1):
            part, at = k / self.intervals * sum(turns), 0
            while at < len(turns) - 1 and part > turns[at]:
                part, at = part - turns[at], at + 1
            share = min(part / turns[at], 1.0) if turns[at] > 1e-9 else 1.0
            place = chain[at] + share * (chain[at + 1] - chain[at])
            if turns[at] > 1e-3:
                half = turns[at] / 2
                weights = np.sin((1 - share) * half), np.sin(share * half)
                place = (weights[0] * chain[at] + weights[1] * chain[at + 1]) / np.sin(half)
            found += [*([0.0] * len(self.momenta)), *place, 0.0, 0.0, 0.0, *self.momenta]
        return [self.craft.units(total)[0] / self.model.time, *found], chain[-1]

    def solve(self, number, generator):
        guess, goal = self.guess(self.way(number, generator))
        ends = np.concatenate([self.start, np.zeros(3), self.momenta, goal])
        wall, cpu = time.perf_counter(), time.process_time()
        answer = self.model.solver(x0=guess, p=ends, **self.model.bounds)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        if not self.model.solver.stats()["success"]:
            return Solve(None, 0.0, wall, cpu)
        cut = max(0.0, -np.degrees(self.closest(np.array(answer["x"]).ravel())))
        return Solve(float(answer["f"]) * self.model.time, float(cut), wall, cpu)

    def closest(self, solution):
        """Least clearance of a solution between its nodes too, rad."""
        wheels = len(self.momenta)
        stages = solution[1:].reshape(self.intervals, 2 * wheels + 7)
        first = np.concatenate([self.start, np.zeros(3), self.momenta])
        states = np.vstack([first, stages[:-1, wheels:]])
        worst = np.inf
        for share in np.linspace(0, 1, LOOKS + 1)[1:]:
            length = solution[0] / self.intervals * share
            reached = np.array(self.model.step(states.T, stages[:, :wheels].T, length)).T[:, :4]
            reached /= np.linalg.norm(reached, axis=1)[:, None]
            worst = min(worst, least(self.limits, reached))
        return worst


def best(scenario, starts, seed=0):
    """The shortest acceptable solve, or none, and the mean times of one solve, s."""
    program, generator = Clear(scenario), np.random.default_rng(seed)
    solves = [program.solve(number, generator) for number in range(starts)]
    good = [each for each in solves if each.duration and each.cut_deg <= MOST_CUT_DEG]
    shortest = min(good, key=lambda each: each.duration, default=None)
    return {
        "duration_s": shortest and shortest.duration,
        "cut_deg": shortest and shortest.cut_deg,
        "durations_s": [each.duration for each in solves],
        "wall_s": float(np.mean([each.wall for each in solves])),
        "cpu_s": float(np.mean([each.cpu for each in solves])),
    }
