#!/usr/bin/env python3
"""Legs of the random suite by slewplan and by general optimal control on the same machine.

The peer is CasADi's symbolic derivatives with IPOPT: multiple shooting, torque constant on 40
intervals of equal length, the state (quaternion, body rate, wheel momenta) integrated by the
classical Runge-Kutta method, limits imposed at the nodes, the best of five starts. It knows nothing
of what slewplan does: neither free interval lengths nor the elimination of momentum.

    cargo build --release -p slewplan-server
    cargo run --release -p slewplan-tests --example scenarios -- legs > legs.jsonl
    python3 -m venv peers && peers/bin/pip install casadi numpy
    peers/bin/python tests/peers/general.py target/release/slewplan legs.jsonl

Prints one line per leg: both durations, their ratio, and the times to find them. Ends with code 1
when slewplan is slower than the peer by more than 0.1 % on any leg, or not faster on most.
"""
import json
import subprocess
import sys
import time

import casadi as ca
import numpy as np

from rest_to_rest import quaternion

INTERVALS = 40
STARTS = 5
WORST_RATIO = 1.001


def product(p, q):
    """Hamilton product, scalar last."""
    v, a, u, b = p[:3], p[3], q[:3], q[3]
    return ca.vertcat(a * u + b * v + ca.cross(v, u), a * b - ca.dot(v, u))


def conjugate(q):
    return ca.vertcat(-q[:3], q[3])


def rolled(q, axis, angle):
    """An attitude after a turn about a body axis."""
    return product(q, ca.vertcat(ca.sin(angle / 2) * ca.DM(axis), ca.cos(angle / 2)))


class Craft:
    """The numbers of a spacecraft, and units in which its slews are of order one."""

    def __init__(self, spec):
        wheels = spec["wheels"]
        axes = np.array([w["axis"] for w in wheels], float).T
        scaled = [w.get("normalize_axis", True) for w in wheels]
        self.axes = axes / np.where(scaled, np.linalg.norm(axes, axis=0), 1.0)
        self.spin = np.array([w["inertia_kg_m2"] for w in wheels])
        self.torque = np.array([w["max_torque_nm"] for w in wheels])
        self.speed = np.array([w["max_speed_rad_s"] for w in wheels])
        self.inertia = np.array(spec["inertia_kg_m2"], float)
        self.body = self.inertia - (self.axes * self.spin) @ self.axes.T
        caps = spec.get("max_body_rate_rad_s") or [None] * 3
        self.caps = np.array([np.inf if cap is None else cap for cap in caps])
        self.norm = spec.get("max_body_rate_norm_rad_s") or np.inf

    def units(self, angle):
        """Time and rate of a turn by this angle when the weakest wheel does it alone."""
        moment = np.linalg.eigvalsh(self.inertia)[-1]
        acceleration = self.torque.min() / moment
        top = (self.spin * self.speed).min() / moment
        rate = min(np.sqrt(acceleration * angle), top)
        return angle / rate + rate / acceleration, rate


class Model:
    """The nonlinear program of slews of one spacecraft from rest to rest.

    `margins` makes of an attitude what must not be negative, at the nodes and half-way between them.
    With `axes`, two of the body, the attitudes at the ends are rolled about them by two angles, rad, which
    are the variables after the duration.
    """

    def __init__(self, craft, angle, intervals=INTERVALS, margins=None, axes=None):
        self.craft, count, self.intervals = craft, len(craft.spin), intervals
        self.time, self.rate = craft.units(angle)
        self.momentum = craft.spin * craft.speed
        step = self.step = self.integrator(count)
        start, goal = ca.MX.sym("start", 7 + count), ca.MX.sym("goal", 4)
        duration = ca.MX.sym("duration")
        variables, low, high = [duration], [1e-3], [np.inf]
        conditions, least, most = [], [], []

        def require(value, lower, upper):
            conditions.append(value)
            least.extend(np.broadcast_to(lower, value.shape[0]))
            most.extend(np.broadcast_to(upper, value.shape[0]))

        state, aim = start, goal
        if axes is not None:
            rolls = ca.MX.sym("rolls", 2)
            variables.append(rolls)
            low += [0.0] * 2
            high += [0.0] * 2
            state = ca.vertcat(rolled(start[:4], axes[0], rolls[0]), start[4:])
            aim = rolled(goal, axes[1], rolls[1])
        for k in range(intervals):
            torque = ca.MX.sym(f"torque{k}", count)
            variables.append(torque)
            low += [-1.0] * count
            high += [1.0] * count
            arrived = step(state, torque, duration / intervals)
            if margins:
                require(margins(step(state, torque, duration / intervals / 2)[:4]), 0.0, np.inf)
            state = ca.MX.sym(f"state{k}", 7 + count)
            variables.append(state)
            caps = craft.caps / self.rate
            low += [-np.inf] * 4 + list(-caps) + [-np.inf] * count
            high += [np.inf] * 4 + list(caps) + [np.inf] * count
            require(arrived - state, 0.0, 0.0)
            require(self.wheel_speed(state), -1.0, 1.0)
            if margins and k < intervals - 1:
                require(margins(state[:4]), 0.0, np.inf)
            if craft.norm < np.inf:
                require(ca.sumsqr(state[4:7]), 0.0, (craft.norm / self.rate) ** 2)
        missed = product(conjugate(aim), state[:4])
        require(missed[:3], 0.0, 0.0)
        require(missed[3], 0.0, np.inf)
        require(state[4:7], 0.0, 0.0)
        program = {
            "x": ca.vertcat(*variables),
            "f": duration,
            "g": ca.vertcat(*conditions),
            "p": ca.vertcat(start, goal),
        }
        options = {
            "expand": True,
            "print_time": False,
            "ipopt.print_level": 0,
            "ipopt.sb": "yes",
            "ipopt.max_iter": 500,
            "ipopt.tol": 1e-8,
        }
        self.solver = ca.nlpsol("slew", "ipopt", program, options)
        self.bounds = {"lbx": low, "ubx": high, "lbg": least, "ubg": most}

    def integrator(self, count):
        """One step of the scaled equations of motion with constant torque."""
        craft = self.craft
        inverse = np.linalg.inv(craft.body)
        state, torque = ca.SX.sym("state", 7 + count), ca.SX.sym("torque", count)
        length = ca.SX.sym("length")

        def slope(x):
            q, w, h = x[:4], x[4:7] * self.rate, x[7:] * self.momentum
            u = torque * craft.torque
            held = craft.body @ w + craft.axes @ h
            turning = 0.5 * product(q, ca.vertcat(w, 0))
            speeding = inverse @ (-ca.cross(w, held) - craft.axes @ u)
            return self.time * ca.vertcat(turning, speeding / self.rate, u / self.momentum)

        a = slope(state)
        b = slope(state + length / 2 * a)
        c = slope(state + length / 2 * b)
        d = slope(state + length * c)
        after = state + length / 6 * (a + 2 * b + 2 * c + d)
        return ca.Function("step", [state, torque, length], [after])

    def wheel_speed(self, state):
        """Speeds relative to the body as shares of their limits."""
        craft = self.craft
        along = craft.axes.T @ (state[4:7] * self.rate)
        return (state[7:] * self.momentum / craft.spin - along) / craft.speed

    def best(self, start, goal, angle, generator, starts=STARTS):
        """Shortest duration, s, of all starts; none when no start converges."""
        found = []
        for attempt in range(starts):
            wild = 0.12 * attempt
            # Every other disturbed start of a long slew goes the other way round.
            toward = -goal if attempt in (2, 4) and angle > 2.0 else goal
            guess = self.guess(start, toward, wild, angle, generator)
            answer = self.solver(x0=guess, p=np.concatenate([start, toward]), **self.bounds)
            if self.solver.stats()["success"]:
                found.append(float(answer["f"]) * self.time)
        return min(found, default=None)

    def guess(self, start, goal, wild, angle, generator):
        count = len(self.craft.spin)
        from_q = start[:4]
        cosine = np.clip(from_q @ goal, -1.0, 1.0)
        arc = np.arccos(cosine)
        guess = [1.0]
        for k in range(1, self.intervals + 1):
            share = k / self.intervals
            if arc < 1e-9:
                q = goal.copy()
            else:
                q = np.sin((1 - share) * arc) * from_q + np.sin(share * arc) * goal
            q = q / max(np.linalg.norm(q), 1e-12)
            q = q + 0.3 * wild * min(1.0, angle) * generator.normal(size=4)
            guess.extend(wild * generator.uniform(-1.0, 1.0, count))
            guess.extend(q / np.linalg.norm(q))
            guess.extend([0.0] * 3)
            guess.extend(start[7:])
        return guess


def posed(leg, intervals=INTERVALS):
    """The program of a leg, and what its solver is asked: start, goal, angle."""
    craft = Craft(leg["spacecraft"])
    start, goal = quaternion(leg["start"]["attitude"]), quaternion(leg["targets"][0]["attitude"])
    goal = goal if start @ goal >= 0 else -goal
    # The vector part is exact where the arc cosine of the scalar product is not.
    turn = np.array(product(conjugate(ca.DM(start)), ca.DM(goal))).ravel()
    angle = 2 * np.arctan2(np.linalg.norm(turn[:3]), turn[3])
    model = Model(craft, angle, intervals)
    speeds = np.array(leg["start"]["wheel_speed_rad_s"])
    state = np.concatenate([start, np.zeros(3), craft.spin * speeds / model.momentum])
    return model, (state, goal, angle)


def by_peer(leg, intervals=INTERVALS, starts=STARTS):
    """Shortest duration, s, and the time of all starts, s."""
    model, asked = posed(leg, intervals)
    begin = time.perf_counter()
    duration = model.best(*asked, np.random.default_rng(0), starts)
    return duration, time.perf_counter() - begin


def by_slewplan(binary, leg):
    begin = time.perf_counter()
    run = subprocess.run(
        [binary, "solve", "-", "--threads", "1", "--progress", "none"],
        input=json.dumps(leg), capture_output=True, text=True, check=False,
    )
    if run.returncode != 0:
        sys.exit(f"{leg['name']}: slewplan ended with {run.returncode}: {run.stderr}")
    return json.loads(run.stdout)["total_time_s"], time.perf_counter() - begin


def main(binary, path):
    ratios = []
    for line in open(path, encoding="utf-8"):
        leg = json.loads(line)
        mine, my_time = by_slewplan(binary, leg)
        peer, peer_time = by_peer(leg)
        if peer is None:
            print(f"{leg['name']}: {mine:.6f} s, the peer found nothing", flush=True)
            continue
        ratios.append(mine / peer)
        print(
            f"{leg['name']}: {mine:.6f} s, peer {peer:.6f} s, ratio {mine / peer:.6f}, "
            f"found in {my_time:.2f} s and {peer_time:.1f} s", flush=True,
        )
    below = sum(ratio < 1 for ratio in ratios)
    print(
        f"{len(ratios)} legs: worst ratio {max(ratios):.6f}, median {np.median(ratios):.6f}, "
        f"best {min(ratios):.6f}; {below} faster than the peer"
    )
    return max(ratios) > WORST_RATIO or 2 * below <= len(ratios)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(int(main(sys.argv[1], sys.argv[2])))
