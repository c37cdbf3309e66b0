#!/usr/bin/env python3
"""Random slews between directions: slewplan beside CasADi + IPOPT, and every flight judged.

    python3 tests/peers/pointing.py [--count 40] [--starts 12] [--seed 0] [--judge]

Three or four wheels, full inertia matrices, with and without stored momentum, random boresights. A third
ends at a direction with every roll, a third with a limited one, a third leads from one direction to
another, without stored momentum. IPOPT (pointing_peer.py: 40 intervals, the best of so many starts)
minimises over the rolls too. The torques of `slewplan slew` are integrated here (motion.py); the
boresight has to arrive within 1e-5 rad and the roll in its range. Times are those of slewplan's process
with all its starts, and of one IPOPT solve without the building of its program.

SLEWPLAN names a built binary; CasADi is installed where it is not there (environment.py). Ends with code
1 when a slew is not solved or misses its end, and with --judge also when durations or times do not meet
the demands that the end lists.
"""

import os

# IPOPT's linear algebra in one thread, as slewplan's.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import environment  # noqa: E402

if __name__ == "__main__":
    environment.enter()

import argparse  # noqa: E402
import sys  # noqa: E402

import numpy as np  # noqa: E402

import pointing_peer  # noqa: E402
import slewplan  # noqa: E402
from cones import product, turn, unit  # noqa: E402
from keep_out_suite import rounded, spacecraft  # noqa: E402
from motion import fly  # noqa: E402

WORST_RATIO, MEDIAN_RATIO, LEAST_SPEED = 1.001, 1.0001, 8.0
MOST_MISS = 1e-5
# What a plan's numbers leave open of a roll, rad.
ROLL_FLOOR = 1e-5


def roll_zero(direction, axis):
    """The attitude of roll 0: north seen along body +Z, or +X where the axis is along Z."""
    up = np.array([0.0, 0.0, 1.0]) if np.hypot(*axis[:2]) > 1e-6 else np.array([1.0, 0.0, 0.0])
    body = np.column_stack([axis, unit(np.cross(up, axis)), np.cross(axis, unit(np.cross(up, axis)))])
    north = np.array([0.0, 0.0, 1.0])
    left = unit(np.cross(north, direction))
    sky = np.column_stack([direction, left, np.cross(direction, left)])
    matrix = sky @ body.T
    w = np.sqrt(max(0.0, 1 + np.trace(matrix))) / 2
    if w > 0.1:
        x, y, z = matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]
        return np.array([x / 4 / w, y / 4 / w, z / 4 / w, w])
    values, vectors = np.linalg.eig(matrix)
    about = unit(np.real(vectors[:, np.argmin(np.abs(values - 1))]))
    angle = np.arccos(np.clip((np.trace(matrix) - 1) / 2, -1, 1))
    signed = [turn(about * angle), turn(-about * angle)]
    return min(signed, key=lambda q: np.abs(rotation(q) - matrix).max())


def rotation(q):
    return np.column_stack([product(product(q, np.append(e, 0.0)), q * [-1, -1, -1, 1])[:3] for e in np.eye(3)])


def direction_end(generator, limited):
    """An end that points somewhere, as slewplan and as the peer read it."""
    axis, direction = unit(generator.normal(size=3)), unit(generator.normal(size=3))
    span = [-np.inf, np.inf]
    pointing = {"boresight": rounded(axis), "direction": rounded(direction)}
    if limited:
        middle, half = generator.uniform(-np.pi, np.pi), generator.uniform(0.1, 1.0)
        span = [middle - half, middle + half]
        pointing |= {"roll_min_deg": np.degrees(span[0]), "roll_max_deg": np.degrees(span[1])}
    given = roll_zero(unit(pointing["direction"]), unit(pointing["boresight"]))
    return pointing, {"attitude": given, "axis": pointing["boresight"], "range": span}


def slew(seed, number):
    """A slew, and its ends as the peer and the judge read them."""
    generator = np.random.default_rng([seed, number])
    between_directions = number % 3 == 2
    stored = number % 4 >= 2 and not between_directions
    craft, speeds = spacecraft(generator, 3 + number % 2, stored)
    first = unit(generator.normal(size=4))
    given = {"attitude": {"quaternion": dict(zip("xyzw", rounded(first, 12)))}}
    start = given | {"wheel_speed_rad_s": speeds}
    ends = [{"attitude": unit(rounded(first, 12)), "axis": [1.0, 0.0, 0.0], "range": None}]
    for _ in range(2 if between_directions else 1):
        pointing, end = direction_end(generator, number % 3 == 1 or (between_directions and number % 2))
        ends.append({**end, "pointing": pointing})
    if between_directions:
        start = {"pointing": ends[1]["pointing"]}
    document = {"spacecraft": craft, "start": start, "end": {"pointing": ends[-1]["pointing"]}}
    return document, {"spacecraft": craft, "speeds": speeds, "ends": ends[-2:]}


def flown(program, document, asked):
    """Duration, s, process time, s, and what is wrong with the flight."""
    answer, taken = slewplan.run(program, "slew", document, [], (0, 1), progress=False)
    found = answer["slews"][0]
    if not found["solved"]:
        return None, taken, found["status"]
    trajectory = found["trajectory"]
    begin = {**document["start"], "attitude": {"quaternion": trajectory["states"][0]["quaternion"]}}
    torques = [
        {**control, "wheel_torque_nm": control["wheel_torque_begin_nm"]} for control in trajectory["controls"]
    ]
    _, states = fly({**document, "start": begin}, {"trajectory": {"controls": torques}})
    complaints = [complaint(state[:4], end) for state, end in zip(states[[0, -1]], asked["ends"])]
    return found["time_s"], taken, "; ".join(filter(None, complaints))


def complaint(attitude, end):
    """What is wrong with an attitude at an end; nothing where it is that of the end."""
    attitude = attitude / np.linalg.norm(attitude)
    missed = pointing_peer.off(attitude, end)
    if missed > MOST_MISS:
        return f"the direction is missed by {missed:.1e} rad"
    rolled = product(end["attitude"] * np.array([-1, -1, -1, 1.0]), attitude)
    roll = 2 * np.arctan2(rolled[:3] @ unit(end["axis"]), rolled[3])
    low, high = end["range"] or (0.0, 0.0)
    if low == -np.inf:
        return ""
    away = abs((roll - (low + high) / 2 + np.pi) % (2 * np.pi) - np.pi) - (high - low) / 2
    return f"the roll is {np.degrees(away):.6f} degrees outside" if away > ROLL_FLOOR else ""


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--binary", help="slewplan")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--starts", type=int, default=12, help="of each slew by the peer; 0 without it")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--judge", action="store_true")
    arguments = parser.parse_args()
    program = slewplan.binary(arguments.binary)
    ratios, times, failed = [], [], 0
    for number in range(arguments.count):
        scenario, asked = slew(arguments.seed, number)
        duration, taken, complaint = flown(program, scenario, asked)
        failed += bool(complaint)
        kind = ("every roll", "limited", "between directions")[number % 3]
        stored = ", stored momentum" if any(asked["speeds"]) else ""
        text = f"{number:2} {kind}, {len(asked['speeds'])} wheels{stored}: {duration or np.nan:.4f} s {complaint}"
        if arguments.starts:
            peer = pointing_peer.best(asked, arguments.starts, arguments.seed)
            if peer["duration_s"] and duration:
                ratios.append(duration / peer["duration_s"])
                times.append([*taken, peer["wall_s"], peer["cpu_s"]])
                text += f", peer {peer['duration_s']:.4f} s of {peer['solved']}, ratio {ratios[-1]:.6f}"
                text += f", {1e3 * taken[1]:.0f} and {1e3 * peer['cpu_s']:.0f} ms"
            else:
                text += ", the peer found nothing"
        print(text, flush=True)
    print(f"{arguments.count} slews, {failed} not solved or missed")
    if not ratios:
        return failed
    wall, cpu, peer_wall, peer_cpu = np.mean(times, axis=0)
    verdicts = [
        (f"worst ratio {max(ratios):.6f} <= {WORST_RATIO}", max(ratios) <= WORST_RATIO),
        (f"median ratio {np.median(ratios):.6f} <= {MEDIAN_RATIO}", np.median(ratios) <= MEDIAN_RATIO),
        (
            f"as fast as one solve, by processors {peer_cpu / cpu:.1f} >= {LEAST_SPEED} (on the clock "
            f"{peer_wall / wall:.1f})",
            peer_cpu / cpu >= LEAST_SPEED,
        ),
    ]
    for text, met in verdicts:
        print(f"{'pass' if met else 'FAIL'}: {text}")
    return failed or (arguments.judge and not all(met for _, met in verdicts))


if __name__ == "__main__":
    sys.exit(int(bool(main())))
