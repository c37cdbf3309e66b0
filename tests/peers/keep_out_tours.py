#!/usr/bin/env python3
"""Experiment C with a Sun: each body axis in turn as boresight, and random directions of the Sun.

    python3 tests/peers/keep_out_tours.py [--suns 20] [--axes xyz] [--seed 0] [--targets 18]

The cone has 30 degrees, and start, end and all targets are clear of it by 5 more. Every plan's torques
are integrated here (motion.py) and have to be clear within the service's promise; `slewplan verify
--strict` has to pass. Shown beside each other: duration of the plan and of the one without a Sun, of
which it is said whether it is clear by chance, and the times of the whole processes, in turn.

SLEWPLAN names a built binary. Ends with code 1 when a plan is missing, not clear or not verified;
times are shown, not judged.
"""

import environment

if __name__ == "__main__":
    environment.enter()

import argparse  # noqa: E402
import sys  # noqa: E402

import numpy as np  # noqa: E402

import slewplan  # noqa: E402
from cones import attitude, cones, free, least, unit  # noqa: E402
from flown import run  # noqa: E402

HALF_ANGLE_DEG, ROOM_DEG = 30.0, 5.0
AXES = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}
MOST_TIMES = 5.0


def with_sun(scenario, axis, direction):
    """The scenario with a camera along a body axis that must not see the Sun."""
    craft = scenario["spacecraft"] | {"boresights": [{"name": "camera", "axis": AXES[axis]}]}
    cone = {"boresight": "camera", "direction": direction, "half_angle_deg": HALF_ANGLE_DEG}
    return scenario | {"spacecraft": craft, "keep_out": [cone]}


def suns(scenario, axis, generator, count):
    """Scenarios with random Suns that no place looks at."""
    places = [scenario["start"], scenario["end"], *scenario["targets"]]
    attitudes = np.array([attitude(place) for place in places])
    while count:
        direction = np.round(unit(generator.normal(size=3)), 9).tolist()
        made = with_sun(scenario, axis, direction)
        if least(cones(made), attitudes) > np.radians(ROOM_DEG):
            count -= 1
            yield made


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--binary", help="slewplan")
    parser.add_argument("--suns", type=int, default=20, help="of each axis")
    parser.add_argument("--axes", default="xyz")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--targets", type=int, default=18, help="the first so many")
    arguments = parser.parse_args()
    program = slewplan.binary(arguments.binary)
    scenario = slewplan.fixture("olivares-c")
    scenario["targets"] = scenario["targets"][: arguments.targets]
    failed, ratios, longer, in_the_way = 0, [], [], 0
    for axis in arguments.axes:
        generator = np.random.default_rng([arguments.seed, ord(axis)])
        for number, posed in enumerate(suns(scenario, axis, generator, arguments.suns)):
            without = run(program, free(posed), limits=cones(posed))
            found = run(program, posed)
            failed += bool(found.complaint()) or not without.planned
            if not (found.planned and without.planned):
                print(f"{axis} {number:2d}: FAIL: {found.complaint() or without.complaint()}", flush=True)
                continue
            ratios.append(found.wall / without.wall)
            longer.append(found.duration / without.duration - 1)
            in_the_way += without.clearance < 0
            print(
                f"{axis} {number:2d} Sun {np.round(posed['keep_out'][0]['direction'], 3)}: "
                f"{found.duration:.3f} s ({found.plan['status']}, gap "
                f"{found.plan['relative_gap']:.3%}), free {without.duration:.3f} s "
                f"({longer[-1]:+.3%}); clear by {np.degrees(found.clearance):.6f} deg, free by "
                f"{np.degrees(without.clearance):.2f}; {found.wall:.2f} s and {without.wall:.2f} s "
                f"({ratios[-1]:.2f} times) {found.complaint() and 'FAIL: ' + found.complaint()}",
                flush=True,
            )
    print(f"{len(ratios)} plans, {failed} missing, not clear or not verified")
    if ratios:
        print(
            f"{in_the_way} free plans meet the Sun; plans are longer by {np.mean(longer):.3%} in the "
            f"mean, {max(longer):.3%} at most; processes take {np.mean(ratios):.2f} times the free "
            f"one's in the mean, {max(ratios):.2f} at most (wanted: {MOST_TIMES:.0f})"
        )
    return failed > 0


if __name__ == "__main__":
    sys.exit(int(main()))
