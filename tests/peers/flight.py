"""Flights of the paper's solutions by the full equations of motion.

The torques of a solution are a polynomial on every interval, through those at Lobatto's points: the
one whose rate the collocation takes. They drive all ten states (attitude, rate, wheel speeds) from
the start on, with nothing put right on the way, by CVODES with tight tolerances. Once as they are,
whatever limits they exceed between the points; and once by wheels that cannot exceed them: torques
are cut off at their limit, and a wheel at its limit of speed is driven no further.
"""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from lobatto import INTERVALS, polynomial
from rest_to_rest import product

TOLERANCES = {"abstol": 1e-12, "reltol": 1e-11, "max_num_steps": 100_000}
# Times of an interval at which limits are looked at.
SAMPLES = 200


@dataclass(frozen=True)
class Passage:
    """What is missed where a target should be reached: degrees, rad/s about each axis."""

    seconds: float
    miss_deg: float
    rates: np.ndarray


class Flights:
    """Flights of a spacecraft with three wheels on the principal axes."""

    def __init__(self, craft, limited):
        inertia = np.diag(np.array(craft["inertia_kg_m2"], float))
        order = [int(np.argmax(np.abs(wheel["axis"]))) for wheel in craft["wheels"]]
        wheels = [craft["wheels"][order.index(axis)] for axis in range(3)]
        spin = np.array([wheel["inertia_kg_m2"] for wheel in wheels])
        most_torque = np.array([wheel["max_torque_nm"] for wheel in wheels])
        most_speed = np.array([wheel["max_speed_rad_s"] for wheel in wheels])
        state, law, seconds = ca.SX.sym("x", 10), ca.SX.sym("law", 3, 5), ca.SX.sym("T")
        share = ca.SX.sym("share")
        q, w, speed = state[:4], state[4:7], state[7:] * most_speed
        torque = ca.mtimes(law, ca.vertcat(*(share**power for power in range(5))))
        if limited:
            torque = ca.fmin(1, ca.fmax(-1, torque))
            # A wheel at its limit can still be braked.
            torque *= ca.logic_or(ca.fabs(state[7:]) < 1, torque * state[7:] < 0)
        torque *= most_torque
        gyration = ca.cross(w, inertia * w + spin * speed)
        acceleration = (-gyration - torque) / (inertia - spin)
        turning = 0.5 * product(q, ca.vertcat(w, 0))
        slope = ca.vertcat(turning, acceleration, (torque / spin - acceleration) / most_speed)
        model = {"x": state, "p": ca.vertcat(ca.vec(law), seconds), "t": share, "ode": seconds * slope}
        grid = np.linspace(0, 1, SAMPLES + 1)
        self.flight = ca.integrator("flight", "cvodes", model, 0, grid[1:], TOLERANCES)
        self.powers = np.vander(grid, 5, increasing=True)

    def fly(self, places, intervals):
        """Passages of all places but the first, and the largest torque and wheel speed by limits."""
        state = np.array([*places[0], 0, 0, 0, 0, 0, 0])
        passages, clock, torque, speed = [], 0.0, 0.0, 0.0
        for number, interval in enumerate(intervals):
            law = polynomial(interval.torques)
            torque = max(torque, np.abs(self.powers @ law).max())
            driven = np.append(law.ravel(), interval.seconds)
            states = np.array(self.flight(x0=state, p=driven)["xf"])
            speed = max(speed, np.abs(states[7:]).max())
            state, clock = states[:, -1], clock + interval.seconds
            if number % INTERVALS == INTERVALS - 1:
                goal = places[len(passages) + 1]
                missed = np.array(product(np.append(-goal[:3], goal[3]), state[:4])).ravel()
                angle = 2 * np.arctan2(np.linalg.norm(missed[:3]), abs(missed[3]))
                passages.append(Passage(clock, np.degrees(angle), state[4:7]))
        return passages, torque, speed
