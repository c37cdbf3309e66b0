#!/usr/bin/env python3
"""The hard scenarios of tests/fixtures/keep-out: their geometry, and what slewplan makes of them.

    python3 tests/peers/keep_out_hard.py [NAME...] [--starts 12]

For each: start and goal are clear, the turn about the eigenaxis is not, and a clear way is shown by a
search of trees (detour.py) with its length; or none exists, since cones without a gap between them
separate the directions. Then slewplan solves it: the plan has to be clear by the integration of
motion.py, or `infeasible` where there is no way. --starts adds the best of so many starts of
CasADi + IPOPT (keep_out_peer.py) to the table.

SLEWPLAN names a built binary. Ends with code 1 when the geometry is not what the fixtures say or
slewplan's answer is neither clear nor rightly infeasible.
"""

import environment

if __name__ == "__main__":
    environment.enter()

import argparse  # noqa: E402
import sys  # noqa: E402

import numpy as np  # noqa: E402

import keep_out_peer  # noqa: E402
import slewplan  # noqa: E402
from cones import attitude, between, cones, free, least, rotated  # noqa: E402
from detour import detour, distance, length  # noqa: E402
from flown import run  # noqa: E402

FOLDER = "keep-out"
INFEASIBLE = 3
# Seeds of the search for a way, and how far the turn has to be on the wrong side, rad.
SEEDS, IN_THE_WAY = range(5), np.radians(5.0)
# Numbers in the fixtures have twelve digits.
EXACT = 1e-9
# Directions of a great circle at which separation is looked at.
LOOKS = 3600


def separated(scenario):
    """Whether the equator lies in the cones of one boresight and start and goal look to its two sides.

    Looks are so close that what is deeper than half of their distance everywhere is so between them.
    """
    limits = cones(scenario)
    if len({tuple(cone.axis) for cone in limits}) != 1 or any(cone.inside for cone in limits):
        return False
    turns = np.linspace(0, 2 * np.pi, LOOKS, endpoint=False)
    circle = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    depths = [cone.half_angle - np.arccos(np.clip(circle @ cone.direction, -1, 1)) for cone in limits]
    covered = np.max(depths, axis=0).min() > np.pi / LOOKS
    ends = (attitude(scenario["start"]), attitude(scenario["targets"][0]))
    sides = [rotated(end, limits[0].axis)[2] for end in ends]
    return bool(covered and sides[0] * sides[1] < 0)


def geometry(scenario):
    """Text about the scenario's geometry, whether a way exists, and what is wrong."""
    limits = cones(scenario)
    start, goal = attitude(scenario["start"]), attitude(scenario["targets"][0])
    path = between(start, goal, 2000)
    inside, faults = -least(limits, path / np.linalg.norm(path, axis=1)[:, None]), []
    if min(least(limits, start), least(limits, goal)) < -EXACT:
        faults.append("start or goal is not clear")
    if inside < IN_THE_WAY:
        faults.append("the turn about the eigenaxis is not in the way")
    text = f"turn {np.degrees(distance(start, goal)):.1f} deg, {np.degrees(inside):.1f} inside; "
    if separated(scenario):
        return text + "no way: cones separate the directions", False, faults
    for seed in SEEDS:
        way = detour(limits, start, goal, np.random.default_rng(seed), -EXACT)
        if way is not None:
            return text + f"a way of {np.degrees(length(way)):.0f} deg", True, faults
    return text + "no way found", True, faults + ["no way found"]


def answer(program, scenario, exists):
    """Text about slewplan's answer, and what is wrong."""
    found = run(program, scenario)
    if not exists:
        right = found.code == INFEASIBLE and not found.planned
        return f"slewplan ended with {found.code}", [] if right else ["not infeasible"]
    if found.complaint():
        return "slewplan", [found.complaint()]
    without = run(program, free(scenario), judge=False)
    text = (
        f"slewplan {found.duration:.3f} s (free {without.duration:.3f}), clear by "
        f"{np.degrees(found.clearance):.6f} deg, {1e3 * found.wall:.0f} ms"
    )
    return text, []


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", help="of fixtures")
    parser.add_argument("--binary", help="slewplan")
    parser.add_argument("--starts", type=int, default=0, help="of the peer")
    arguments = parser.parse_args()
    program = slewplan.binary(arguments.binary)
    every = sorted(path.stem for path in (slewplan.FIXTURES / FOLDER).glob("*.json"))
    failed = 0
    for name in arguments.names or every:
        scenario = slewplan.fixture(f"{FOLDER}/{name}")
        shape, exists, faults = geometry(scenario)
        said, wrong = answer(program, scenario, exists)
        peer = ""
        if arguments.starts and exists:
            best = keep_out_peer.best(scenario, arguments.starts)
            found = best["duration_s"]
            peer = "; peer " + (f"{found:.3f} s" if found else "found nothing")
        faults += wrong
        failed += bool(faults)
        text = "; ".join(faults)
        print(f"{name}: {shape}; {said}{peer}{' FAIL: ' + text if text else ''}", flush=True)
    return failed > 0


if __name__ == "__main__":
    sys.exit(int(main()))
