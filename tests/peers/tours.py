"""Minimum-time tours in a given order by CasADi with IPOPT: the peer of the search's last step.

One nonlinear program of all phases: momentum eliminated, every phase of intervals of equal length with
constant torque, each integrated by one step of the classical Runge-Kutta method, and a duration of
its own; the vector part of the attitude's error and the rates in `stops` vanish at targets, all
rates at both ends of the tour. The phases share one function of a stage, mapped over all stages,
so that building costs little. It is built once for a number of phases; attitudes are parameters.
"""

import casadi as ca
import numpy as np

from rest_to_rest import abilities, arc, product, step

OPTIONS = {
    "print_time": False,
    "error_on_fail": False,
    "ipopt": {"print_level": 0, "sb": "yes", "max_iter": 200, "tol": 1e-6},
}
# The longest phase in its unit of time.
LONGEST = 20.0


class Tours:
    """The program of tours with so many phases, each of so many intervals.

    `stops` are the components of the rate that vanish at targets.
    """

    def __init__(self, craft, phases, intervals, stops=(2,)):
        acceleration, rate = abilities(craft)
        self.phases, self.intervals, self.rate = phases, intervals, rate
        self.ramp = float(np.max(rate / acceleration))
        self.unit = 5 * self.ramp
        stages = phases * intervals
        states, torques = ca.MX.sym("states", 7, stages + 1), ca.MX.sym("torques", 3, stages)
        durations, places = ca.MX.sym("durations", 1, phases), ca.MX.sym("places", 4, phases + 1)
        stage = step(acceleration, rate, self.unit / intervals).map(stages)
        of_stages = ca.horzcat(*(ca.repmat(durations[k], 1, intervals) for k in range(phases)))
        arrived = stage(ca.vertcat(states[:, :-1], of_stages), torques)
        equal = [ca.vec(arrived[:7, :] - states[:, 1:])]
        equal += [states[:4, 0] - places[:, 0], states[4:, 0], states[4:, stages]]
        same_sign = []
        for phase in range(1, phases + 1):
            there, goal = states[:, phase * intervals], places[:, phase]
            missed = product(ca.vertcat(-goal[:3], goal[3]), there[:4])
            equal.append(missed[:3])
            same_sign.append(missed[3])
            if phase < phases:
                equal += [there[4 + axis] for axis in stops]
        equal, same_sign = ca.vertcat(*equal), ca.vertcat(*same_sign)
        program = {
            "x": ca.vertcat(ca.vec(states), ca.vec(torques), durations.T),
            "f": ca.sum2(durations),
            "g": ca.vertcat(equal, same_sign),
            "p": ca.vec(places),
        }
        self.solver = ca.nlpsol("tour", "ipopt", program, OPTIONS)
        most = np.concatenate([np.tile([np.inf] * 4 + [1.0] * 3, stages + 1), np.ones(3 * stages)])
        self.bounds = {
            "lbx": np.concatenate([-most, np.full(phases, 1e-3)]),
            "ubx": np.concatenate([most, np.full(phases, LONGEST)]),
            "lbg": np.zeros(equal.numel() + phases),
            "ubg": np.concatenate([np.zeros(equal.numel()), np.full(phases, np.inf)]),
        }

    def fly(self, places):
        """Duration, s, through these attitudes, signs included; none when it is not found."""
        states, durations = [[*places[0], 0, 0, 0]], []
        shares = np.linspace(0, 1, self.intervals + 1)[1:]
        for start, goal in zip(places, places[1:]):
            seconds, rates = eigenaxis(start, goal, self.rate, self.ramp)
            durations.append(seconds / self.unit)
            # At rest at its ends, else the guess of a long turn leads nowhere.
            for q in arc(start, goal, shares):
                states.append([*q, *rates])
            states[-1][4:] = [0, 0, 0]
        torques = np.zeros(3 * self.phases * self.intervals)
        guess = np.concatenate([np.ravel(states), torques, durations])
        answer = self.solver(x0=guess, p=np.concatenate(places), **self.bounds)
        return float(answer["f"]) * self.unit if self.solver.stats()["success"] else None


def eigenaxis(start, goal, rate, ramp):
    """Seconds of a turn about the eigenaxis, and its rates in units of their limits `rate`."""
    turn = np.array(product(np.append(-start[:3], start[3]), goal)).ravel()
    sine = np.linalg.norm(turn[:3])
    along = 2 * np.arctan2(sine, turn[3]) * turn[:3] / sine
    seconds = ramp + np.max(np.abs(along) / rate)
    return seconds, along / seconds / rate


def shorter_way(places):
    """The same attitudes, each with the sign that is nearer to the one before."""
    chain = [places[0]]
    for place in places[1:]:
        chain.append(place if place @ chain[-1] >= 0 else -place)
    return chain
