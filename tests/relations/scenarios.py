"""Scenarios with everything that a planner may ask for, from a seed: any body and array of wheels, momentum,
limits, kinds of targets, and cones."""

import math
import random

# Shares of scenarios or targets that have something.
SYMMETRIC_BODY, RATE_LIMITS, NORM_LIMIT, MOMENTUM, MOVING_START, END = 0.5, 0.35, 0.2, 0.35, 0.2, 0.7
DISABLED_WHEEL, UNEVEN_TORQUE, POINTING, ROLL_LIMITS, CONES, CLOSE_TARGETS = 0.2, 0.1, 0.25, 0.3, 0.3, 0.4


def unit(state, size=3):
    vector = [state.gauss(0, 1) for _ in range(size)]
    norm = math.sqrt(sum(x * x for x in vector))
    return [x / norm for x in vector]


def quaternion(components):
    return {"quaternion": dict(zip("xyzw", components))}


def determinant(a, b, c):
    return sum(a[i] * (b[i - 2] * c[i - 1] - b[i - 1] * c[i - 2]) for i in range(3))


def inertia(state, scale):
    """The inertia of some masses: the sum of its principal moments is three times the scale."""
    size = 3
    rows = [[state.gauss(0, 1) for _ in range(size)] for _ in range(size)]
    spread = [[sum(a * b for a, b in zip(p, q)) / 3 + 0.1 * (p is q) for q in rows] for p in rows]
    if state.random() < SYMMETRIC_BODY:
        spread = [[x * (i == j) for j, x in enumerate(row)] for i, row in enumerate(spread)]
    trace = sum(spread[i][i] for i in range(size))
    factor = 3 * scale / (2 * trace)
    return [[factor * (trace * (i == j) - x) for j, x in enumerate(row)] for i, row in enumerate(spread)]


def axes(state):
    kind = state.choice(["orthogonal", "orthogonal", "pyramid", "any"])
    if kind == "orthogonal":
        return [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    if kind == "pyramid":
        up = math.radians(state.uniform(20, 60))
        around = [0.3 + i * math.pi / 2 for i in range(4)]
        return [[math.cos(up) * math.cos(t), math.cos(up) * math.sin(t), math.sin(up)] for t in around]
    found = [unit(state) for _ in range(state.choice([3, 4, 5, 6]))]
    if abs(determinant(*found[:3])) < 0.2:
        found[:3] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    return found


class Generator:
    """A scenario from a seed."""

    def __init__(self, seed):
        self.state = random.Random(seed)
        self.rate = math.radians(10 ** self.state.uniform(-1, 0.5))
        self.speed = 10 ** self.state.uniform(1.5, 2.9)

    def has(self, share):
        return self.state.random() < share

    def spacecraft(self):
        state, scale = self.state, 10 ** self.state.uniform(-2, 4)
        torque = scale * self.rate / 10 ** state.uniform(0.3, 1.7)
        wheels = []
        for axis in axes(state):
            most = torque * state.uniform(0.7, 1.3)
            wheel = {
                "axis": axis,
                "inertia_kg_m2": scale * self.rate / self.speed * state.uniform(0.8, 1.2),
                "max_torque_nm": most,
                "max_speed_rad_s": self.speed * state.uniform(0.8, 1.2),
            }
            if self.has(UNEVEN_TORQUE):
                wheel["min_torque_nm"] = -most * state.uniform(0.5, 1.5)
            wheels.append(wheel)
        if len(wheels) > 3 and self.has(DISABLED_WHEEL):
            wheels[-1]["enabled"] = False
        found = {
            "inertia_kg_m2": inertia(state, scale),
            "wheels": wheels,
            "boresights": [{"name": name, "axis": unit(state)} for name in ("camera", "tracker")],
        }
        if self.has(RATE_LIMITS):
            found["max_body_rate_rad_s"] = [self.rate * state.uniform(0.3, 1.2) for _ in range(3)]
        if self.has(NORM_LIMIT):
            found["max_body_rate_norm_rad_s"] = self.rate * state.uniform(0.3, 1.2)
        return found

    def start(self, wheels):
        state, found = self.state, {"attitude": quaternion(unit(self.state, 4))}
        if self.has(MOMENTUM):
            found["wheel_speed_rad_s"] = [self.speed * state.uniform(-0.5, 0.5) * state.choice([0.2, 1]) for _ in range(wheels)]
        if self.has(MOVING_START):
            found["body_rate_rad_s"] = [self.rate * state.uniform(-0.2, 0.2) for _ in range(3)]
        return found

    def target(self, name, pointed, near):
        state, found = self.state, {"id": name}
        if pointed and self.has(0.6):
            found["pointing"] = {"boresight": state.choice(["camera", "tracker"]), "direction": unit(state)}
            if self.has(ROLL_LIMITS):
                found["pointing"].update(roll_min_deg=-30, roll_max_deg=40)
        elif near:
            turned = [q + 0.03 * state.gauss(0, 1) for q in near]
            norm = math.sqrt(sum(x * x for x in turned))
            found["attitude"] = quaternion([x / norm for x in turned])
        else:
            found["attitude"] = quaternion(unit(state, 4))
        kind = state.random()
        if kind < 0.35:
            found["zero_rate_axes"] = state.choice([["z"], ["z"], ["x"], ["x", "y"], []])
        elif kind < 0.45:
            found["rate_min_rad_s"] = [-0.1 * self.rate, None, -0.01 * self.rate]
            found["rate_max_rad_s"] = [0.3 * self.rate, 0.1 * self.rate, 0.01 * self.rate]
        elif kind < 0.6:
            found["dwell_s"] = state.uniform(0, 30)
        elif kind < 0.65:
            found["settle_s"] = state.uniform(0, 10)
        return found

    def scenario(self, most_targets):
        state, spacecraft = self.state, self.spacecraft()
        found = {"spacecraft": spacecraft, "start": self.start(len(spacecraft["wheels"]))}
        if self.has(END):
            found["end"] = {"attitude": quaternion(unit(state, 4))}
        pointed, near = self.has(POINTING), unit(state, 4) if self.has(CLOSE_TARGETS) else None
        count = state.randint(1, most_targets)
        found["targets"] = [self.target(f"t{i}", pointed, near) for i in range(count)]
        if self.has(CONES):
            found["keep_out"] = [self.cone() for _ in range(state.choice([1, 2]))]
        return found

    def cone(self):
        state = self.state
        return {
            "boresight": state.choice(["camera", "tracker"]),
            "direction": unit(state),
            "half_angle_deg": state.uniform(5, 40),
            "applies": state.choice(["always", "always", "at_targets", "report"]),
        }
