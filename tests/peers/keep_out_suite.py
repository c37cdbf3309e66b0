"""Random slews from rest to rest that are in the way of cones, from seeds.

Three or four wheels, full inertia matrices, with and without stored momentum that the wheels hold at
rest in every attitude, one to three cones of one or two boresights, in every sixth slew one of them
to stay within. Start and goal are clear by 2 degrees, and a clear way between them is known (detour.py).
The slew without the cones, as slewplan flies it, is more than a degree on the wrong side of one.
"""

import itertools

import numpy as np

import slewplan
from cones import Cone, attitude, between, cones, free, least, product, rotated, turn, unit
from detour import detour
from ordinary import held_everywhere, pyramid

KEEP_IN_DEG = 75.0
ROOM, VIOLATED = np.radians(2.0), np.radians(1.0)
# Clearance of the way that shows that a slew can be flown, rad.
WAY_ROOM = 0.01
TRIES = 300


def rounded(array, digits=9):
    """What is written down: digits that no version of a library changes."""
    return np.round(np.asarray(array, float), digits).tolist()


def inertia(generator, size):
    moments = np.sort(generator.uniform(0.6, 1.3, 3)) * size
    moments[2] = min(moments[2], 0.95 * (moments[0] + moments[1]))
    axes = np.linalg.qr(generator.normal(size=(3, 3)))[0]
    return (axes * moments) @ axes.T


def wheel_axes(generator, count):
    """Rows that span all directions well."""
    if count == 4 and generator.random() < 0.5:
        return np.array([unit(row) for row in pyramid(4, np.sqrt(generator.uniform(0.3, 0.8)))])
    while True:
        axes = np.array([unit(row) for row in generator.normal(size=(count, 3))])
        if np.linalg.svd(axes)[1][-1] > 0.6:
            return axes


def spacecraft(generator, wheels, stored):
    """A spacecraft, and speeds of its wheels at the start."""
    size = 10 ** generator.uniform(0, 3)
    acceleration, rate = 10 ** generator.uniform(-3, -1.7), 10 ** generator.uniform(-2, -1)
    matrix = inertia(generator, size)
    axes = wheel_axes(generator, wheels)
    speed = generator.uniform(300, 700)
    momentum = size * rate * generator.uniform(0.8, 1.3)
    torque = size * acceleration * generator.uniform(0.8, 1.3)
    craft = {
        "inertia_kg_m2": [[float(f"{part:.9g}") for part in row] for row in (matrix + matrix.T) / 2],
        "wheels": [
            {
                "axis": rounded(axis),
                "inertia_kg_m2": float(f"{momentum / speed:.9g}"),
                "max_torque_nm": float(f"{torque:.9g}"),
                "max_speed_rad_s": float(f"{speed:.9g}"),
            }
            for axis in axes
        ],
    }
    if generator.random() < 0.4:
        craft["max_body_rate_rad_s"] = rounded(rate * generator.uniform(0.4, 1.0, 3))
    speeds = np.zeros(wheels)
    while stored:
        held = unit(generator.normal(size=3)) * held_everywhere(axes, momentum)
        speeds = np.linalg.pinv(axes.T) @ held * generator.uniform(0.1, 0.5) / momentum
        if np.abs(speeds).max() < 0.9:
            break
    return craft, rounded(speeds * speed)


def cone(generator, boresight, path, inside):
    """A cone that both ends of a path are clear of, of those in its way or those somewhere; or none."""
    name, axis = boresight
    half_angle = KEEP_IN_DEG if inside else generator.uniform(8, 50)
    direction = unit(generator.normal(size=3))
    if not inside and generator.random() < 0.8:
        passed = rotated(path[generator.integers(len(path) // 5, 4 * len(path) // 5)], axis)
        off = np.radians(generator.uniform(0, 0.8) * half_angle)
        direction = unit(rotated(turn(off * unit(np.cross(passed, direction))), passed))
    made = {"boresight": name, "direction": rounded(direction), "half_angle_deg": round(half_angle, 6)}
    limit = Cone("", axis, unit(made["direction"]), np.radians(made["half_angle_deg"]), inside)
    return made if least([limit], path[[0, -1]]) > ROOM else None


def posed(generator, pair):
    """A slew of a kind whose shortest turn is not clear, or none."""
    craft, speeds = spacecraft(generator, 3 + pair % 2, (pair // 2) % 2 == 1)
    count = 1 + pair % 3
    names = ["camera", "tracker"][: 1 + (count > 1 and (pair // 3) % 2)]
    axes = [rounded(unit(generator.normal(size=3))) for _ in names]
    craft["boresights"] = [{"name": name, "axis": axis} for name, axis in zip(names, axes)]
    boresights = [(name, unit(axis)) for name, axis in zip(names, axes)]
    start = unit(generator.normal(size=4))
    turned = turn(unit(generator.normal(size=3)) * generator.uniform(0.5, np.pi))
    places = [start, product(start, turned)]
    first, last = ({"quaternion": dict(zip("xyzw", rounded(place, 12)))} for place in places)
    scenario = {
        "spacecraft": craft,
        "start": {"attitude": first, "wheel_speed_rad_s": speeds},
        "targets": [{"id": "there", "attitude": last}],
    }
    path = between(attitude(scenario["start"]), attitude(scenario["targets"][0]), 200)
    path /= np.linalg.norm(path, axis=1)[:, None]
    within = (pair + pair // 6) % 6 == 0
    for _ in range(TRIES):
        made = [
            cone(generator, boresights[index % len(boresights)], path, within and index == count - 1)
            for index in range(count)
        ]
        if None in made:
            continue
        scenario["keep_out"] = made[:-1] if within else made
        scenario["keep_in"] = made[-1:] if within else []
        if least(cones(scenario), path) < -VIOLATED:
            return scenario
    return None


def violated(program, scenario):
    """Whether slewplan's plan without the cones is on the wrong side, by its dense states."""
    plan, _ = slewplan.solve(program, free(scenario), "--threads", "1")
    states = [[state["quaternion"][part] for part in "xyzw"] for state in plan["trajectory"]["states"]]
    return least(cones(scenario), np.array(states)) < -VIOLATED


def slew(program, seed, number):
    """One of the suite. Of each pair of the same kind one goes to the peer."""
    for attempt in itertools.count():
        generator = np.random.default_rng([seed, number, attempt])
        scenario = posed(generator, number // 2)
        if scenario is None or not violated(program, scenario):
            continue
        ends = attitude(scenario["start"]), attitude(scenario["targets"][0])
        if detour(cones(scenario), *ends, generator, WAY_ROOM) is not None:
            return {"name": f"seed {seed}, slew {number}"} | scenario
