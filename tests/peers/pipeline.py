#!/usr/bin/env python3
"""Experiment C: the pipeline of slewplan built on CasADi, and slewplan, in one run.

    python3 tests/peers/pipeline.py [--binary target/release/slewplan] [--rounds 3] [--every-leg]

The peer does what slewplan does, without its bounds and proofs:

1. a table of all legs with the rates at targets free but for z, by CasADi and fatrop in the best
   formulation (rest_to_rest.py), one start each, in two processes;
2. the shortest tour through the table by dynamic programming over subsets;
3. the tours of the --orders best orders by one nonlinear program of all phases (tours.py). Without
   total momentum an order and its reverse take the same time, so only one of them is flown.

Legs that are equal but for their frame, or flown backwards, are solved once, as slewplan does;
--every-leg solves all. Every interval is of equal length; there are as many as bring the median leg
and the tour to within 0.1 % of slewplan's, which the output shows.

slewplan is timed twice: as it comes, until it has proved that no order is better, and with the limit
of one node, which ends it when it has done what the peer does (and a little more: the first of the
nodes, the certified bounds, the verification).

Each side's time is that of the whole process: the peer's with the start of Python and the building of
its programs, of which the output shows the parts. Medians of --rounds rounds, in turn. Ends with
code 1 when slewplan is not ten times as fast with the limit, or its plan more than 0.1 % longer.
"""

import argparse
import functools
import heapq
import itertools
import json
import multiprocessing
import statistics
import sys
import time

import environment
import slewplan
from legs import classes

SCENARIO = "olivares-c"
PROCESSES = 2
LEG_INTERVALS, TOUR_INTERVALS = 30, 24
LEAST_RATIO = 10
MOST_LONGER = 1.001
# Rates that vanish: at start and end, and at targets.
REST, STOP = (0, 1, 2), (2,)


@functools.cache
def program(begin):
    """Legs with these rates zero at their beginning, built once in a process, when first needed."""
    from rest_to_rest import Legs

    craft = slewplan.fixture(SCENARIO)["spacecraft"]
    return Legs(craft, "fatrop", LEG_INTERVALS, begin, STOP)


def fly(leg):
    """Duration, s; none when it failed."""
    start, goal, begin = leg
    return program(begin).fly(start, goal)[2]


def table(places, every_leg):
    """Durations between targets and from the start, the last place, as a symmetric matrix."""
    import numpy as np

    count = len(places) - 1
    pairs = list(itertools.combinations(range(count), 2))
    groups = [[index] for index in range(len(pairs))] if every_leg else classes(places[:-1])
    jobs = [[(count, target)] for target in range(count)]
    jobs += [[pairs[index] for index in group] for group in groups]
    legs = [(places[a], places[b], REST if a == count else STOP) for (a, b), *_ in jobs]
    durations = np.full((count + 1, count + 1), np.inf)
    with multiprocessing.get_context("fork").Pool(PROCESSES) as pool:
        for ends, duration in zip(jobs, pool.imap(fly, legs)):
            for a, b in ends:
                durations[a, b] = durations[b, a] = np.inf if duration is None else duration
    return durations


def shortest(durations, orders):
    """The so many shortest tours through a table, one of each pair of reverses.

    `rest[places, at]` is the least time from `at` through all of `places` to the end (Held and Karp),
    and thereby the exact bound by which tours are then taken in the order of their length. Where
    `at` is one of `places` it means nothing, and is not read.
    """
    import numpy as np

    count = len(durations) - 1
    between, home = durations[:count, :count], durations[count, :count]
    rest = np.full((1 << count, count), np.inf)
    rest[0] = home
    size = np.array([place.bit_count() for place in range(1 << count)])
    for visited in range(1, count):
        subsets = np.flatnonzero(size == visited)
        for first in range(count):
            chosen = subsets[subsets >> first & 1 == 1]
            after = rest[chosen ^ (1 << first), first]
            rest[chosen] = np.minimum(rest[chosen], between[first] + after[:, None])
    everything = (1 << count) - 1
    begun = [
        (home[first] + rest[everything ^ (1 << first), first], home[first], (first,))
        for first in range(count)
    ]
    heapq.heapify(begun)
    found = []
    while begun and len(found) < orders:
        _, spent, tour = heapq.heappop(begun)
        left = [place for place in range(count) if place not in tour]
        if not left and tour[::-1] not in found:
            found.append(tour)
        for place in left:
            others = sum(1 << other for other in left if other != place)
            here = spent + between[tour[-1], place]
            heapq.heappush(begun, (here + rest[others, place], here, (*tour, place)))
    return found


def peer(every_leg, orders):
    """The whole pipeline; prints its result as JSON."""
    clock = [time.perf_counter()]
    from rest_to_rest import quaternion
    from tours import Tours, shorter_way

    scenario = slewplan.fixture(SCENARIO)
    targets = scenario["targets"]
    places = [quaternion(each["attitude"]) for each in [*targets, scenario["start"]]]
    clock.append(time.perf_counter())
    durations = table(places, every_leg)
    clock.append(time.perf_counter())
    candidates = shortest(durations, orders)
    clock.append(time.perf_counter())
    tours = Tours(scenario["spacecraft"], len(targets) + 1, TOUR_INTERVALS, STOP)
    flown = []
    for order in candidates:
        chain = shorter_way([places[-1], *(places[index] for index in order), places[-1]])
        flown.append((tours.fly(chain) or float("inf"), order))
    clock.append(time.perf_counter())
    duration, order = min(flown)
    names = [target["id"] for target in targets] + ["start"]
    found = {
        "duration": duration,
        "order": [names[index] for index in order],
        "parts": [end - begin for begin, end in itertools.pairwise(clock)],
        "legs": [
            (names[a], names[b], durations[a, b])
            for a, b in itertools.permutations(range(len(names)), 2)
        ],
    }
    print(json.dumps(found))


def run_peer(every_leg, orders):
    flags = ["--peer", "--orders", str(orders), *(["--every-leg"] if every_leg else [])]
    ran, taken = slewplan.timed([sys.executable, __file__, *flags])
    if ran.returncode:
        sys.exit(f"the peer ended with code {ran.returncode}")
    return json.loads(ran.stdout), taken


def compare(binary, rounds, every_leg, orders):
    scenario = slewplan.fixture(SCENARIO)
    unproved = {**scenario, "options": {**scenario.get("options", {}), "node_limit": 1}}
    ours, same, peers = [], [], []
    for _ in range(rounds):
        peers.append(run_peer(every_leg, orders))
        ours.append(slewplan.solve(binary, scenario))
        same.append(slewplan.solve(binary, unproved))
    rows = slewplan.legs(binary, scenario, "lower_bound")
    found, plan, first = peers[0][0], ours[0][0], same[0][0]
    apart = sorted(
        (duration / rows[a, b]["duration_s"] - 1)
        for a, b, duration in found["legs"] if (a, b) in rows
    )
    names = ("import", "legs", "orders", "tour")
    parts = [statistics.median(run["parts"][k] for run, _ in peers) for k in range(len(names))]
    print(
        f"CasADi: {found['duration']:.3f} s by {' '.join(found['order'])}; no bound, no proof\n"
        f"  {LEG_INTERVALS} intervals a leg, {statistics.median(apart):+.3%} from slewplan's in the "
        f"median, {apart[-1]:+.2%} at worst; {TOUR_INTERVALS} a leg of the tour\n"
        f"  " + ", ".join(f"{name} {part:.2f} s" for name, part in zip(names, parts))
    )
    for name, found_plan in (("slewplan", plan), ("after a node", first)):
        print(
            f"{name}: {found_plan['total_time_s']:.3f} s by {' '.join(found_plan['sequence'])}; "
            f"{found_plan['status']}, gap {found_plan['relative_gap']:.3%} "
            f"({found_plan['lower_bound_kind']})"
        )
    walls, cpus = (
        [statistics.median(taken[kind] for _, taken in runs) for runs in (peers, ours, same)]
        for kind in range(2)
    )
    ratio, longer = walls[0] / walls[2], first["total_time_s"] / found["duration"]
    print(
        f"whole processes, median of {rounds}: CasADi {walls[0]:.2f} s, slewplan {walls[1]:.2f} s with "
        f"its proof ({walls[0] / walls[1]:.1f} times as fast) and {walls[2]:.2f} s after a node; "
        f"processor time {cpus[0]:.2f}, {cpus[1]:.2f} and {cpus[2]:.2f} s"
    )
    verdicts = [
        (f"ratio of times {ratio:.2f} >= {LEAST_RATIO}", ratio >= LEAST_RATIO),
        (f"slewplan's duration / the peer's {longer:.6f} <= {MOST_LONGER}", longer <= MOST_LONGER),
    ]
    for text, met in verdicts:
        print(f"{'pass' if met else 'FAIL'}: {text}")
    return not all(met for _, met in verdicts)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--binary", help="slewplan")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--orders", type=int, default=1, help="to fly as whole tours")
    parser.add_argument("--every-leg", action="store_true", help="solve equal legs too")
    parser.add_argument("--peer", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.peer:
        return peer(arguments.every_leg, arguments.orders)
    binary = slewplan.binary(arguments.binary)
    return compare(binary, arguments.rounds, arguments.every_leg, arguments.orders)


if __name__ == "__main__":
    environment.enter()
    sys.exit(int(main() or 0))
