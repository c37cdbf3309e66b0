#!/usr/bin/env python3
"""The scheduling paper's own transcription, flown, and its table of results, corrected.

    python3 tests/peers/paper.py [--binary target/release/slewplan] [--time-limit 60]

A. Olivares and E. Staffetti, "Time-optimal attitude scheduling of a spacecraft equipped with reaction
wheels" (2018), transcribe legs by fifth-degree Gauss-Lobatto collocation with two intervals. This
script solves their best order of experiment A in that way (lobatto.py), in each way of reading what
they leave open, and flies every solution by the full equations of motion (flight.py). Then it holds
the published durations of the first leg against bounds that slewplan proves, and prints experiments
A, B and C in the meaning of the paper, quaternions with their signs, and in that of attitudes: what
is published, what the published order takes on 40 intervals a leg with torque limits everywhere
(tours.py), and what slewplan finds, with its status and gap.

Only published figures are written down here. Without --binary, SLEWPLAN names the program, or it is
built; CasADi is installed first where it is not there (see environment.py).
"""

import argparse
import multiprocessing

import environment
import slewplan

PUBLISHED = {
    "A": ("olivares-a", "afedcb", 592.49, 19.70),
    "B": ("olivares-b", "abhcdeflkjig", 744.03, 17.07),
    "C": ("olivares-c", "gmnopkeflrqdjichba", 897.46, 39.57),
}
LEG = ("a", "b", 57.0503)
MEANINGS = ("quaternion", "rotation")
STARTS = 4
PROCESSES = 2
# Of a leg of the published orders, and of the one leg.
INTERVALS, LEG_INTERVALS = 40, 50


def places(scenario, order):
    """Attitudes from the start through the targets of this order to the end, signs as given."""
    from rest_to_rest import quaternion

    targets = {target["id"]: target for target in scenario["targets"]}
    tour = [scenario["start"], *(targets[name] for name in order), scenario["end"]]
    return [quaternion(place["attitude"]) for place in tour]


def readings():
    from lobatto import Reading

    for continuous in ("tour", "leg", "interval"):
        for unit_norm in (False, True):
            yield Reading(continuous, True, unit_norm)
    # Joined between intervals parabolas lack freedom: 64 s for the leg that can be flown in 58.
    for unit_norm in (False, True):
        yield Reading("interval", False, unit_norm)


def transcribe(reading):
    """Duration of the one leg, and the best solution of experiment A of several starts."""
    import numpy as np

    from lobatto import Program

    scenario = slewplan.fixture("olivares-a-quaternion")
    craft = scenario["spacecraft"]
    generators = [None, *(np.random.default_rng(seed) for seed in range(1, STARTS))]
    leg = places(scenario, LEG[:2])[1:-1]
    legs = [Program(craft, leg, reading).solve(each) for each in generators]
    tour = places(scenario, PUBLISHED["A"][1])
    tours = [Program(craft, tour, reading).solve(each) for each in generators]
    best = [min(filter(None, found), key=lambda one: one[0], default=None) for found in (legs, tours)]
    return reading, best[0] and best[0][0], best[1]


def fly_readings():
    """Prints a line for every reading; the nearest to the published figures is shown in full."""
    from flight import Flights

    scenario = slewplan.fixture("olivares-a-quaternion")
    order, published = PUBLISHED["A"][1:3]
    tour = places(scenario, order)
    flights = [Flights(scenario["spacecraft"], limited) for limited in (False, True)]
    print(
        f"Fifth-degree Gauss-Lobatto collocation, two intervals a leg, best of {STARTS} starts:\n"
        f"published are {LEG[2]} s for {LEG[0]} to {LEG[1]} and {published} s for {' '.join(order)}.\n"
        "Torques joined over the tour, a leg or an interval, at inner points free or on a parabola;\n"
        "unit norm of quaternions imposed or free. Flown with the torques of the solution: largest\n"
        "torque and wheel speed by their limits; last by wheels that obey these.\n"
        "joined   inner    norm   leg, s  tour, s  miss, deg  torque   speed  limited, deg"
    )
    solutions = []
    with multiprocessing.get_context("spawn").Pool(PROCESSES) as pool:
        for reading, leg, found in pool.imap(transcribe, list(readings())):
            if not (leg and found):
                print(f"{reading} no solution found", flush=True)
                continue
            free, limited = (flight.fly(tour, found[1]) for flight in flights)
            off = max(abs(leg / LEG[2] - 1), abs(found[0] / published - 1))
            solutions.append((off, reading, free, limited))
            miss, bounded = (max(each.miss_deg for each in flown[0]) for flown in (free, limited))
            print(
                f"{reading} {leg:8.3f} {found[0]:8.2f} {miss:10.2f} {free[1]:7.0%} {free[2]:7.0%} "
                f"{bounded:13.1f}", flush=True,
            )
    _, reading, free, limited = min(solutions, key=lambda one: one[0])
    print(
        f"\nNearest to both published figures ({' '.join(str(reading).split())}), by target:\n"
        "            s  miss, deg  rate z, rad/s   limited: miss, deg  rate z, rad/s"
    )
    for name, one, other in zip([*order, "end"], free[0], limited[0]):
        print(
            f"{name:4s}{one.seconds:9.2f} {one.miss_deg:10.3f} {one.rates[2]:14.6f} "
            f"{other.miss_deg:20.2f} {other.rates[2]:14.6f}"
        )


def first_legs(program):
    """Prints the published durations of first legs beside what is proved about them."""
    scenario = slewplan.fixture("olivares-c")
    table = slewplan.legs(program, scenario, "lower_bound")
    print("\nFirst legs, from rest, rates at the target free but for z:")
    for name, (_, order, _, seconds) in PUBLISHED.items():
        row = table["start", order[0]]
        bound = row["certified_lower_bound_s"]
        verdict = "impossible" if seconds < bound else "not refuted"
        print(
            f"{name}: start to {order[0]} published {seconds:.2f} s, proved to take at least "
            f"{bound:.2f} s ({verdict}), found {row['duration_s']:.2f} s"
        )


def experiments(program, time_limit):
    """Prints the table of experiments."""
    from tours import Tours, shorter_way

    print(
        "\nexperiment  meaning     published  its order flown  slewplan, s  published/slewplan"
        "  status, gap, order"
    )
    for name, (file, order, published, _) in PUBLISHED.items():
        scenario = slewplan.fixture(file)
        tours = Tours(scenario["spacecraft"], len(order) + 1, INTERVALS)
        for meaning in MEANINGS:
            options = scenario.get("options", {}) | {"attitude_equivalence": meaning}
            limit = ["--time-limit", str(time_limit)]
            plan, _ = slewplan.solve(program, scenario | {"options": options}, *limit)
            tour = places(scenario, order)
            flown = tours.fly(tour if meaning == "quaternion" else shorter_way(tour))
            best, gap = plan["total_time_s"], plan["relative_gap"]
            print(
                f"{name:10s}  {meaning:10s}  {published:9.2f}  "
                f"{f'{flown:.2f}' if flown else 'not found':>15s}  {best:11.2f}  "
                f"{published / best:18.3f}  {plan['status']}, {gap:.2%}, {' '.join(plan['sequence'])}",
                flush=True,
            )
    scenario = slewplan.fixture("olivares-c")
    leg = places(scenario, LEG[:2])[1:-1]
    flown = Tours(scenario["spacecraft"], 1, LEG_INTERVALS).fly(leg)
    row = slewplan.legs(program, scenario, "rest_to_rest")[LEG[:2]]
    print(
        f"leg {LEG[0]} to {LEG[1]}, rest to rest: published {LEG[2]} s, on {LEG_INTERVALS} intervals "
        f"{flown:.3f} s, slewplan {row['duration_s']:.3f} s"
    )


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--binary", help="slewplan")
    parser.add_argument("--time-limit", type=float, default=60, help="of each plan, s")
    arguments = parser.parse_args()
    program = slewplan.binary(arguments.binary)
    fly_readings()
    first_legs(program)
    experiments(program, arguments.time_limit)


if __name__ == "__main__":
    environment.enter()
    main()
