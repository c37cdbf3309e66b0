#!/usr/bin/env python3
"""Small tours in the way of cones: the order that the search finds beside all orders, one by one.

    python3 tests/peers/keep_out_orders.py [--count 20] [--seed 0] [--jobs 1]

Random spacecraft (keep_out_suite.py) and four or five targets that are clear of one or two cones by 2
degrees, while the plan without the cones is not. Rests and free rates at targets, half with an end.
Every order is solved as a scenario of its own, whose targets all have a `position`, and the best has
to be the search's: the same order, or one as short. A plan that claims to be optimal must not have a
bound above the best.

SLEWPLAN names a built binary. Ends with code 1 when the search was beaten, or a plan is missing or not
clear.
"""

import environment

if __name__ == "__main__":
    environment.enter()

import argparse  # noqa: E402
import itertools  # noqa: E402
import sys  # noqa: E402
from concurrent.futures import ThreadPoolExecutor  # noqa: E402

import numpy as np  # noqa: E402

import slewplan  # noqa: E402
from cones import attitude, between, cones, free, least, product, turn, unit  # noqa: E402
from detour import detour  # noqa: E402
from flown import run  # noqa: E402
from keep_out_suite import ROOM, VIOLATED, WAY_ROOM, cone, rounded, spacecraft  # noqa: E402

# Totals of one order from two runs agree to this share.
SAME = 1e-5
# Largest angle between the attitudes of a tour and their middle, rad.
WIDEST = 1.2


def place(generator, middle, name=None):
    axis = unit(generator.normal(size=3))
    there = product(middle, turn(axis * generator.uniform(0.3, WIDEST)))
    made = {"attitude": {"quaternion": dict(zip("xyzw", rounded(there, 12)))}}
    return made if name is None else {"id": name} | made


def posed(generator, number):
    """A tour whose turns about the eigenaxes are in the way of its cones, or none."""
    craft, speeds = spacecraft(generator, 3 + number % 2, number % 4 in (1, 2))
    axis = rounded(unit(generator.normal(size=3)))
    craft["boresights"] = [{"name": "camera", "axis": axis}]
    middle = unit(generator.normal(size=4))
    start = place(generator, middle) | {"wheel_speed_rad_s": speeds}
    targets = [place(generator, middle, name) for name in "abcde"[: 4 + (number // 2) % 2]]
    if number % 3:
        for target in targets:
            target["zero_rate_axes"] = ["z"] if number % 3 == 1 else []
    scenario = {"spacecraft": craft, "start": start, "targets": targets}
    if number % 2:
        scenario["end"] = {"attitude": start["attitude"]}
    attitudes = np.array([attitude(each) for each in [start, *targets]])
    for _ in range(200):
        pair = attitudes[generator.permutation(len(attitudes))[:2]]
        path = between(*pair, 100)
        made = [cone(generator, ("camera", unit(axis)), path, False) for _ in range(1 + (number // 4) % 2)]
        if None in made:
            continue
        scenario["keep_out"] = made
        if least(cones(scenario), attitudes) > ROOM and least(cones(scenario), path) < -VIOLATED:
            return scenario
    return None


def reachable(scenario, generator):
    """Whether clear ways from the start to every target are known, and with them between all."""
    limits, start = cones(scenario), attitude(scenario["start"])
    goals = [attitude(target) for target in scenario["targets"]]
    return all(detour(limits, start, goal, generator, WAY_ROOM) is not None for goal in goals)


def tour(program, seed, number):
    """A tour whose plan without the cones is more than a degree inside one of them."""
    for attempt in itertools.count():
        generator = np.random.default_rng([seed, number, attempt])
        scenario = posed(generator, number)
        if scenario is None:
            continue
        without = run(program, free(scenario), "--threads", "1", limits=cones(scenario))
        in_the_way = without.planned and without.clearance < -VIOLATED
        if in_the_way and reachable(scenario, generator):
            return {"name": f"seed {seed}, tour {number}"} | scenario


def fixed(scenario, order):
    """The same with this order only."""
    places = {name: index + 1 for index, name in enumerate(order)}
    targets = [target | {"position": places[target["id"]]} for target in scenario["targets"]]
    return scenario | {"targets": targets}


def judge(program, scenario, pool):
    """Prints a line; whether the search was right."""
    found = run(program, scenario, "--threads", "1")
    names = [target["id"] for target in scenario["targets"]]
    orders = list(itertools.permutations(names))
    runs = pool.map(lambda order: run(program, fixed(scenario, order), "--threads", "1"), orders)
    flown, faults = [], [found.complaint()] if found.complaint() else []
    for order, each in zip(orders, runs):
        if each.complaint():
            faults.append(f"{' '.join(order)}: {each.complaint()}")
        elif each.plan["sequence"] != list(order):
            faults.append(f"{' '.join(order)}: flown {' '.join(each.plan['sequence'])}")
        else:
            flown.append((each.duration, order))
    if not flown or not found.planned:
        print(f"{scenario['name']}: FAIL: {'; '.join(faults[:3])}", flush=True)
        return False
    flown.sort()
    best, order = flown[0]
    if found.duration > best * (1 + SAME):
        faults.append(f"{found.duration / best - 1:.4%} longer than the best order")
    if found.plan["status"] == "optimal" and found.plan["lower_bound_s"] > best * (1 + 1e-9):
        faults.append(f"bound {found.plan['lower_bound_s']:.6f} s above the best order")
    same = "the same order" if found.plan["sequence"] == list(order) else " ".join(order)
    second = f", second {flown[1][0] / best - 1:+.3%}" if len(flown) > 1 else ""
    print(
        f"{scenario['name']}: {found.duration:.4f} s by {' '.join(found.plan['sequence'])} "
        f"({found.plan['status']}); best of {len(flown)} orders {best:.4f} s, {same}{second}"
        f"{' FAIL: ' + '; '.join(faults[:3]) if faults else ''}",
        flush=True,
    )
    return not faults


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--binary", help="slewplan")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    program = slewplan.binary(arguments.binary)
    right = 0
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for number in range(arguments.count):
            right += judge(program, tour(program, arguments.seed, number), pool)
    print(f"{right} of {arguments.count} tours: the search finds the best of all orders")
    return right < arguments.count


if __name__ == "__main__":
    sys.exit(int(main()))
