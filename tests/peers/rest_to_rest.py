"""Minimum-time legs by CasADi with fatrop or IPOPT: the peers of legs.py and pipeline.py.

usage: rest_to_rest.py SCENARIO, in the environment of environment.py

The formulation that serves general solvers best, for spacecraft without total momentum whose wheels
stand on principal axes: momentum is eliminated, so that the state is the attitude and the rate in
units of its limits; twenty intervals of equal length with constant torque, integrated by one step of
the classical Runge-Kutta method each; the duration is a state of every stage, which leaves a chain
with blocks; and the end is three equations on the attitude and three on the rate (fewer where
components of the rate are free). The program is built once. Attitudes are joined by the shorter way,
guessed by a turn about the eigenaxis at rest.

Reads names of solvers from standard input, one per line, flies all pairs of start and targets with
each, and answers with a line of JSON: per pair the seconds of the solve, on the clock and of processor
time, and the duration in seconds (null when it failed).
"""

import itertools
import json
import sys
import time

import casadi as ca
import numpy as np

INTERVALS = 20
OPTIONS = {"expand": True, "print_time": False, "error_on_fail": False}
MOST_ITERATIONS = 300
TOLERANCE = 1e-6
# States and controls of a stage: quaternion, rate, duration; torques.
NX, NU = 8, 3


def quaternion(attitude):
    """Scalar last, from the two forms that the fixtures use."""
    if "quaternion" in attitude:
        q = np.array([attitude["quaternion"][part] for part in "xyzw"], float)
        return q / np.linalg.norm(q)
    roll, pitch, yaw = (np.radians(angle) / 2 for angle in attitude["roll_pitch_yaw_deg"])
    about = {
        "x": np.array([np.sin(roll), 0, 0, np.cos(roll)]),
        "y": np.array([0, np.sin(pitch), 0, np.cos(pitch)]),
        "z": np.array([0, 0, np.sin(yaw), np.cos(yaw)]),
    }
    return np.array(product(product(about["z"], about["y"]), about["x"])).ravel()


def product(p, q):
    """Hamilton product."""
    p, q = ca.vcat([p]), ca.vcat([q])
    vector = p[3] * q[:3] + q[3] * p[:3] + ca.cross(p[:3], q[:3])
    return ca.vertcat(vector, p[3] * q[3] - ca.dot(p[:3], q[:3]))


def abilities(craft):
    """Angular acceleration and rate limit about each axis."""
    inertia = np.array(craft["inertia_kg_m2"], float)
    if np.count_nonzero(inertia - np.diag(np.diag(inertia))):
        sys.exit("the peers know principal axes only")
    acceleration, rate = np.zeros(3), np.full(3, np.inf)
    for wheel in craft["wheels"]:
        if np.count_nonzero(wheel["axis"]) != 1:
            sys.exit("the peers know wheels on the body axes only")
        i = int(np.argmax(np.abs(wheel["axis"])))
        whole, spin = inertia[i, i], wheel["inertia_kg_m2"]
        acceleration[i] = wheel["max_torque_nm"] / (whole - spin)
        rate[i] = spin * wheel["max_speed_rad_s"] / whole
    caps = craft.get("max_body_rate_rad_s") or [None] * 3
    return acceleration, np.minimum(rate, [np.inf if cap is None else cap for cap in caps])


def step(acceleration, rate, length):
    """State and torque to the state after an interval, a `length` of the duration's unit long, s."""
    state, torque = ca.SX.sym("state", NX), ca.SX.sym("torque", NU)
    q, w = state[:4], state[4:7]
    length = state[7] * length
    gain = torque * ca.DM(acceleration / rate)

    def slope(q, w):
        return 0.5 * product(q, ca.vertcat(w * ca.DM(rate), 0))

    middle, after = w + length / 2 * gain, w + length * gain
    a = slope(q, w)
    b = slope(q + length / 2 * a, middle)
    c = slope(q + length / 2 * b, middle)
    d = slope(q + length * c, after)
    turned = q + length / 6 * (a + 2 * b + 2 * c + d)
    return ca.Function("step", [state, torque], [ca.vertcat(turned, after, state[7])])


def arc(start, goal, shares):
    """Attitudes at these shares of the turn about the eigenaxis."""
    angle = float(np.arccos(np.clip(start @ goal, -1.0, 1.0)))
    for share in shares:
        weights = (1 - share, share)
        if angle > 1e-9:
            weights = [np.sin(weight * angle) / np.sin(angle) for weight in weights]
        yield weights[0] * start + weights[1] * goal


def options(solver, equalities):
    """What the solver is told for a program with so many conditions, all equalities."""
    if solver == "fatrop":
        special = {"structure_detection": "auto", "equality": [True] * equalities}
        own = {"print_level": 0}
    else:
        special, own = {}, {"print_level": 0, "sb": "yes"}
    own |= {"max_iter": MOST_ITERATIONS, "tol": TOLERANCE}
    return OPTIONS | special | {solver: own}


class Legs:
    """The program of one spacecraft, with the start and the goal as parameters.

    `begin` and `end` are the components of the rate that vanish there.
    """

    def __init__(self, craft, solver, intervals=INTERVALS, begin=(0, 1, 2), end=(0, 1, 2)):
        self.acceleration, self.rate = abilities(craft)
        self.intervals = intervals
        self.ramp = float(np.max(self.rate / self.acceleration))
        self.unit = self.ramp + np.pi / float(np.mean(self.rate))
        stage = step(self.acceleration, self.rate, self.unit / intervals)
        ends = ca.MX.sym("ends", 8)
        state = ca.MX.sym("state0", NX)
        variables, links = [state], []
        for k in range(intervals):
            torque, after = ca.MX.sym(f"torque{k}", NU), ca.MX.sym(f"state{k + 1}", NX)
            links.append(after - stage(state, torque))
            if k == 0:
                links += [state[:4] - ends[:4], *(state[4 + i] for i in begin)]
            variables += [torque, after]
            state = after
        back = ca.vertcat(-ends[4:7], ends[7])
        links += [product(back, state[:4])[:3], *(state[4 + i] for i in end)]
        conditions = ca.vertcat(*links)
        free = np.inf * np.ones(4)
        most = np.concatenate([free, np.ones(3), [20.0]])
        least = np.concatenate([-free, -np.ones(3), [1e-3]])
        each = np.ones(NU)
        self.bounds = {
            "lbx": np.concatenate([least] + [np.concatenate([-each, least])] * intervals),
            "ubx": np.concatenate([most] + [np.concatenate([each, most])] * intervals),
            "lbg": 0,
            "ubg": 0,
        }
        program = {"x": ca.vertcat(*variables), "f": state[7], "g": conditions, "p": ends}
        self.solver = ca.nlpsol("legs", solver, program, options(solver, conditions.numel()))

    def fly(self, start, goal):
        """Time on the clock and of the processor, s, of one solve, and the leg's duration, s."""
        goal = goal if start @ goal >= 0 else -goal
        angle = float(np.arccos(min(1.0, start @ goal)))
        duration = (self.ramp + 2 * angle / float(np.mean(self.rate))) / self.unit
        guess = []
        for q in arc(start, goal, np.linspace(0, 1, self.intervals + 1)):
            guess += [0] * NU if guess else []
            guess += [*q, 0, 0, 0, duration]
        ends = np.concatenate([start, goal])
        wall, cpu = time.perf_counter(), time.process_time()
        answer = self.solver(x0=guess, p=ends, **self.bounds)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        solved = self.solver.stats()["success"]
        return wall, cpu, float(answer["f"]) * self.unit if solved else None


def main(path):
    with open(path, encoding="utf-8") as file:
        scenario = json.load(file)
    places = [scenario["start"], *scenario["targets"]]
    pairs = list(itertools.combinations([quaternion(p["attitude"]) for p in places], 2))
    programs = {}
    for line in sys.stdin:
        solver = line.strip()
        if solver not in programs:
            programs[solver] = Legs(scenario["spacecraft"], solver)
            # What is loaded or allocated once is not part of a leg.
            programs[solver].fly(*pairs[0])
        legs = [programs[solver].fly(*pair) for pair in pairs]
        print(json.dumps(legs), flush=True)


if __name__ == "__main__":
    main(sys.argv[1])
