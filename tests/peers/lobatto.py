"""The scheduling paper's transcription: fifth-degree Gauss-Lobatto collocation, two intervals a leg.

Herman and Conway, "Direct optimization using collocation based on high-order Gauss-Lobatto quadrature
rules" (1996): a state is a polynomial of degree five on an interval, given by its values and
derivatives at both ends and in the middle, and its derivative is that of the equations of motion at
the two inner Lobatto points too, at +-sqrt(3/7) of half the interval. Limits are imposed where there
are variables: on states at ends and middles, on torques at all points that have their own.

Total momentum is zero. I w + Iw Omega = 0 is linear, so the polynomials keep it exactly, and wheel
speeds need no variables of their own: what remains of the paper's ten states are the attitude and
the rate, in the units of rest_to_rest.py. The paper leaves open what a `Reading` states.
"""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from rest_to_rest import abilities, arc, product
from tours import eigenaxis

INTERVALS = 2
# Lobatto's points on [0, 1].
POINTS = np.array([0.0, 0.5 - np.sqrt(3 / 28), 0.5, 0.5 + np.sqrt(3 / 28), 1.0])
INNER, GIVEN = [1, 3], [0, 2, 4]


OPTIONS = {
    "expand": True,
    "print_time": False,
    "error_on_fail": False,
    "ipopt": {"print_level": 0, "sb": "yes", "max_iter": 1000, "tol": 1e-8},
}


@dataclass(frozen=True)
class Reading:
    """How the paper's description of its transcription is read."""

    # Where torques are continuous: over the whole "tour", within a "leg", within an "interval".
    continuous: str
    # Torques at the inner points are variables; else they lie on the parabola of the other three.
    inner_torques: bool
    # Equation (12), quaternions have norm one, is imposed at ends and middles of intervals.
    unit_norm: bool

    def __str__(self):
        inner = "free" if self.inner_torques else "parabola"
        return f"{self.continuous:8s} {inner:8s} {'unit' if self.unit_norm else 'free':4s}"


@dataclass(frozen=True)
class Interval:
    """An interval of a solution: seconds, and torques at Lobatto's points as shares of the limit."""

    seconds: float
    torques: np.ndarray


def hermite():
    """Rules of the fifth degree: inner values from six data, and inner derivatives of these.

    The data are values and derivatives (by the share of the interval) at ends and middle.
    """
    powers = np.arange(6)

    def values(points):
        return np.power.outer(points, powers)

    def slopes(points):
        return powers * np.power.outer(points, np.maximum(powers - 1, 0))

    given, inner = POINTS[GIVEN], POINTS[INNER]
    coefficients = np.linalg.inv(np.vstack([values(given), slopes(given)]))
    return values(inner) @ coefficients, slopes(inner) @ coefficients


def polynomial(torques):
    """Coefficients, constant first, of the polynomials through torques at Lobatto's points."""
    return np.linalg.solve(np.vander(POINTS, increasing=True), torques)


class Program:
    """The nonlinear program of a tour through these attitudes, signs included.

    At targets the rates in `stops` vanish; at both ends of the tour all do.
    """

    def __init__(self, craft, places, reading, stops=(2,)):
        self.acceleration, self.rate = abilities(craft)
        self.reading = reading
        self.ramp = float(np.max(self.rate / self.acceleration))
        self.unit = 5 * self.ramp
        self.variables, self.guess, self.low, self.high, self.conditions = [], [], [], [], []
        self.intervals, total = [], 0
        state = self.variable([*places[0], 0, 0, 0], fixed=range(7))
        torque = self.torque()
        for leg, (start, goal) in enumerate(zip(places, places[1:])):
            seconds, _ = eigenaxis(start, goal, self.rate, self.ramp)
            length = self.variable([seconds / self.unit / INTERVALS], least=1e-3, most=20)
            total += INTERVALS * length
            quarters = [[*q, 0, 0, 0] for q in arc(start, goal, np.linspace(0, 1, 5))]
            last = leg == len(places) - 2
            there = range(7) if last else [*range(4), *(4 + axis for axis in stops)]
            if leg and reading.continuous == "leg":
                torque = self.torque()
            for half in range(INTERVALS):
                if self.intervals and reading.continuous == "interval":
                    torque = self.torque()
                middle = self.variable(quarters[2 * half + 1])
                ended = half == INTERVALS - 1
                after = self.variable(quarters[2 * half + 2], fixed=there if ended else ())
                torques = [torque, None, self.torque(), None, self.torque()]
                for point in INNER:
                    torques[point] = self.inner(torques, POINTS[point])
                self.collocate(length, [state, middle, after], torques)
                if reading.unit_norm:
                    free = [middle] if ended else [middle, after]
                    self.conditions += [ca.sumsqr(x[:4]) - 1 for x in free]
                self.intervals.append(ca.vertcat(length, *torques))
                state, torque = after, torques[-1]
        self.total = total

    def variable(self, guess, fixed=(), least=-1.0, most=1.0):
        """A variable between its limits, but for components that keep their guess."""
        symbol = ca.MX.sym(f"v{len(self.variables)}", len(guess))
        low, high = np.full(len(guess), least), np.full(len(guess), most)
        for index in fixed:
            low[index] = high[index] = guess[index]
        self.variables.append(symbol)
        self.guess.extend(guess)
        self.low.extend(low)
        self.high.extend(high)
        return symbol

    def torque(self):
        return self.variable([0.0, 0.0, 0.0])

    def inner(self, torques, point):
        if self.reading.inner_torques:
            return self.torque()
        s = 2 * point - 1
        begin, middle, end = (torques[index] for index in GIVEN)
        return s * (s - 1) / 2 * begin + (1 - s * s) * middle + s * (s + 1) / 2 * end

    def slope(self, state, torque):
        """Derivative of a state by the duration's unit."""
        rate, gain = ca.DM(self.rate), ca.DM(self.acceleration / self.rate)
        turning = 0.5 * product(state[:4], ca.vertcat(state[4:] * rate, 0))
        return self.unit * ca.vertcat(turning, -gain * torque)

    def collocate(self, length, states, torques):
        values, slopes = hermite()
        given = [length * self.slope(x, torques[p]) for x, p in zip(states, GIVEN)]
        data = ca.horzcat(*states, *given)
        for row, point in enumerate(INNER):
            inner = ca.mtimes(data, ca.DM(values[row]))
            claimed = ca.mtimes(data, ca.DM(slopes[row]))
            self.conditions.append(claimed - length * self.slope(inner, torques[point]))

    def solve(self, disturbance=None):
        """Duration, s, and intervals, or none; guessed as attitudes on eigenaxes, at rest.

        `disturbance`, a generator of random numbers, disturbs the guess.
        """
        guess, low, high = (np.array(part) for part in (self.guess, self.low, self.high))
        if disturbance:
            guess += np.where(low < high, 0.1 * disturbance.normal(size=len(guess)), 0)
        program = {
            "x": ca.vertcat(*self.variables),
            "f": self.total,
            "g": ca.vertcat(*self.conditions),
        }
        solver = ca.nlpsol("paper", "ipopt", program, OPTIONS)
        answer = solver(x0=guess, lbx=low, ubx=high, lbg=0, ubg=0)
        if not solver.stats()["success"]:
            return None
        read = ca.Function("read", [program["x"]], [ca.horzcat(*self.intervals)])
        columns = np.array(read(answer["x"])).T
        found = [Interval(self.unit * column[0], column[1:].reshape(5, 3)) for column in columns]
        return float(answer["f"]) * self.unit, found
