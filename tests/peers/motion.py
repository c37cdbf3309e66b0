"""Plans integrated from their torques alone, in plain numpy, and how clear of cones they fly.

The full state (attitude, body rate, wheel momenta) by the classical Runge-Kutta method, from the
start on; nothing is put right on the way. Between the steps the cosine of the angle between boresight
and cone is a cubic through its values and derivatives, the extremes of which are exact.
"""

import numpy as np

from cones import attitude, rotated, unit

# Most that the attitude turns, or the rate is carried round by the momentum, in a step, rad.
MOST_TURN = 0.01
LEAST_STEPS = 8


class Craft:
    """Inertia without the wheels' spin, axes as columns, and the spin of each wheel."""

    def __init__(self, spacecraft):
        wheels = spacecraft["wheels"]
        self.axes = np.array([unit(wheel["axis"]) for wheel in wheels]).T
        self.spin = np.array([wheel["inertia_kg_m2"] for wheel in wheels])
        self.inertia = np.array(spacecraft["inertia_kg_m2"], float)
        self.body = self.inertia - (self.axes * self.spin) @ self.axes.T
        self.inverse = np.linalg.inv(self.body)
        self.least_moment = np.linalg.eigvalsh(self.body)[0]

    def slope(self, state, torque):
        x, y, z, w, a, b, c = state[:7].tolist()
        d, e, f = (self.body @ state[4:7] + self.axes @ state[7:]).tolist()
        # Half the Hamilton product of attitude and rate, and the rate across the momentum.
        turning = (
            (w * a + y * c - z * b) / 2,
            (w * b + z * a - x * c) / 2,
            (w * c + x * b - y * a) / 2,
            -(x * a + y * b + z * c) / 2,
        )
        across = np.array((b * f - c * e, c * d - a * f, a * e - b * d))
        return np.concatenate((turning, self.inverse @ (-across - self.axes @ torque), torque))

    def step(self, state, torque, length):
        a = self.slope(state, torque)
        b = self.slope(state + length / 2 * a, torque)
        c = self.slope(state + length / 2 * b, torque)
        d = self.slope(state + length * c, torque)
        return state + length / 6 * (a + 2 * b + 2 * c + d)

    def pace(self, state):
        """How fast the attitude or the rate's direction turns at most nearby, rad/s."""
        held = self.body @ state[4:7] + self.axes @ state[7:]
        return np.linalg.norm(state[4:7]) + np.linalg.norm(held) / self.least_moment


def start_of(scenario, craft):
    start = scenario["start"]
    rate = np.array(start.get("body_rate_rad_s") or [0.0] * 3, float)
    speeds = np.array(start.get("wheel_speed_rad_s") or [0.0] * len(craft.spin), float)
    momenta = craft.spin * (speeds + craft.axes.T @ rate)
    return np.concatenate([attitude(start), rate, momenta])


def fly(scenario, plan):
    """Times, s, and states of the whole plan, by its torques."""
    craft = Craft(scenario["spacecraft"])
    state, clock = start_of(scenario, craft), 0.0
    times, states = [clock], [state]
    idle = np.zeros(len(craft.spin))
    arcs = []
    for control in plan["trajectory"]["controls"]:
        begin = control["start_s"]
        if begin > clock + 1e-9:
            arcs.append((begin - clock, idle))
        arcs.append((control["duration_s"], np.array(control["wheel_torque_nm"], float)))
        clock = begin + control["duration_s"]
    for length, torque in arcs:
        change = np.linalg.norm(craft.inverse @ (craft.axes @ torque)) * length
        count = max(LEAST_STEPS, int(np.ceil((craft.pace(state) + change) * length / MOST_TURN)))
        for _ in range(count):
            state = craft.step(state, torque, length / count)
            times.append(times[-1] + length / count)
            states.append(state)
    return np.array(times), np.array(states)


def least_clearance(cone, times, states):
    """Least angle to the surface of a cone along a flight, rad, and its time, s."""
    sign = -1.0 if cone.inside else 1.0
    attitudes = states[:, :4] / np.linalg.norm(states[:, :4], axis=1)[:, None]
    cosine = rotated(attitudes, cone.axis) @ cone.direction
    seen = rotated(attitudes * [-1, -1, -1, 1], cone.direction)
    slope = np.sum(np.cross(states[:, 4:7], cone.axis) * seen, axis=1)
    step = np.diff(times)
    begin, end = sign * cosine[:-1], sign * cosine[1:]
    first, last = sign * slope[:-1] * step, sign * slope[1:] * step
    # p(s) = begin + first s + square s^2 + cube s^3, whose slope has two roots.
    square = 3 * (end - begin) - 2 * first - last
    cube = 2 * (begin - end) + first + last
    root = np.sqrt(np.maximum(square**2 - 3 * cube * first, 0.0))
    best, moment = begin[0], times[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        # The stable one of the two forms; the other root is a minimum or outside.
        inner = np.where(square <= 0, first / (root - square), -(square + root) / (3 * cube))
    for share in (np.ones_like(step), np.clip(np.nan_to_num(inner), 0.0, 1.0)):
        value = begin + share * (first + share * (square + share * cube))
        k = int(np.argmax(value))
        if value[k] > best:
            best, moment = value[k], times[k] + share[k] * step[k]
    angle = float(np.arccos(np.clip(sign * best, -1.0, 1.0)))
    return sign * (angle - cone.half_angle), float(moment)
