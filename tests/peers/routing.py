#!/usr/bin/env python3
"""Orders of many targets at rest: slewplan, and OR-Tools routing on the full table of leg times.

    python3 tests/peers/routing.py [--targets 100 200] [--limits 10 60] [--tables FOLDER] [--judge]

The random schedules of tests/src/schedules.rs, from a start through all targets at rest to an end.
With every target at rest the legs are independent of each other, and the best order is the shortest
path through a table of numbers. OR-Tools gets the whole table for nothing: its time begins with the
search (cheapest arcs first, then guided local search, one thread, whole microseconds). slewplan gets
the scenario, and the same limit for legs, bounds, search, and for the verification of its plan; its
wall time is that of the whole process. The two run one after the other, each alone.

Both tours are measured in the table (`slewplan legs`, the accuracy of the plans), where slewplan's has
to be as long as its plan says. --tables keeps the tables for the next run: that of 500 targets has
251,000 rows. SLEWPLAN names a built binary, SCENARIOS the built example; without them they are built.

Ends with code 1 when a plan is missing or is not what the table says, and with --judge also when
slewplan's tour is longer.
"""

import environment

if __name__ == "__main__":
    environment.ROUTING.enter()

import argparse  # noqa: E402
import csv  # noqa: E402
import json  # noqa: E402
import os  # noqa: E402
import statistics  # noqa: E402
import subprocess  # noqa: E402
import sys  # noqa: E402
import tempfile  # noqa: E402
import time  # noqa: E402
from dataclasses import dataclass  # noqa: E402
from pathlib import Path  # noqa: E402

from ortools.constraint_solver import pywrapcp, routing_enums_pb2  # noqa: E402

import slewplan  # noqa: E402

REGIONS = ("sphere", "strip")
# Units of a second in the table of OR-Tools, and a leg that no tour has.
UNIT = 1e-6
NO_LEG = 10**12
# Relative difference above which a tour is longer, and a plan not what the table says.
LONGER = 1e-6


@dataclass(frozen=True)
class Case:
    """A schedule."""

    targets: int
    region: str
    seed: int

    def name(self):
        return f"{self.region}-{self.targets}-{self.seed}"

    def scenario(self, scenarios):
        words = ["schedule", self.region, "rest", str(self.targets), str(self.seed)]
        printed = subprocess.run([scenarios, *words], stdout=subprocess.PIPE, check=True)
        return json.loads(printed.stdout)


def table(program, scenario, kept, threads):
    """Leg times, s, as rows of the places in their order: start, targets, end.

    `kept` is the file of the table, which is written where it is not there.
    """
    if not kept.exists():
        given, made = kept.with_suffix(".json"), kept.with_suffix(".part")
        unlimited = scenario | {"options": {"time_limit_s": None}}
        given.write_text(json.dumps(unlimited), encoding="utf-8")
        line = [program, "legs", given, "--format", "csv", "-o", made, "--progress", "none"]
        subprocess.run([*line, "--threads", str(threads)], check=True)
        made.rename(kept)
    names = places(scenario)
    index = {name: number for number, name in enumerate(names)}
    times = [[None] * len(names) for _ in names]
    with kept.open(encoding="utf-8", newline="") as rows:
        for row in csv.DictReader(rows):
            times[index[row["from"]]][index[row["to"]]] = float(row["duration_s"])
    return times


def places(scenario):
    return ["start", *(target["id"] for target in scenario["targets"]), "end"]


def length(times, tour):
    """Sum of the legs, s, of a tour of the places by their numbers."""
    return sum(times[one][other] for one, other in zip(tour, tour[1:]))


def routing_model(times):
    """Manager, model and evaluator of the legs, whose times in units are their costs: first to last place."""
    manager = pywrapcp.RoutingIndexManager(len(times), 1, [0], [len(times) - 1])
    model = pywrapcp.RoutingModel(manager)
    whole = [[NO_LEG if leg is None else round(leg / UNIT) for leg in row] for row in times]
    transit = model.RegisterTransitMatrix(whole)
    # Guided local search adds penalties to legs that cost something.
    model.SetArcCostEvaluatorOfAllVehicles(transit)
    return manager, model, transit


def guided(first, limit):
    """Parameters of guided local search from what a first strategy finds, for some seconds."""
    parameters = pywrapcp.DefaultRoutingSearchParameters()
    parameters.first_solution_strategy = first
    parameters.local_search_metaheuristic = routing_enums_pb2.LocalSearchMetaheuristic.GUIDED_LOCAL_SEARCH
    parameters.time_limit.FromMilliseconds(round(1000 * limit))
    return parameters


def visited(manager, model, value):
    """The places of a tour but the last; `value` gives what a variable is in it."""
    index = model.Start(0)
    while not model.IsEnd(index):
        yield manager.IndexToNode(index)
        index = value(model.NextVar(index))


def by_routing(times, limit):
    """The tour of OR-Tools, and the seconds it took."""
    begin = time.perf_counter()
    manager, model, _ = routing_model(times)
    first = routing_enums_pb2.FirstSolutionStrategy.PATH_CHEAPEST_ARC
    answer = model.SolveWithParameters(guided(first, limit))
    taken = time.perf_counter() - begin
    if answer is None:
        return None, taken
    return [*visited(manager, model, answer.Value), len(times) - 1], taken


@dataclass
class Comparison:
    """The two tours of a schedule with a limit: their lengths, s, and what is wrong with ours."""

    peer: float
    own: float
    fault: str

    def longer(self):
        return self.own > self.peer * (1 + LONGER)


def compare(program, case, scenario, times, limit, threads):
    """Prints a line."""
    words = ["--time-limit", str(limit), "--threads", str(threads)]
    plan, (wall, _) = slewplan.solve(program, scenario, *words)
    tour, peer_wall = by_routing(times, limit)
    numbers = {name: number for number, name in enumerate(places(scenario))}
    own = plan["total_time_s"]
    summed = length(times, [numbers[name] for name in ("start", *plan["sequence"], "end")])
    peer = float("inf") if tour is None else length(times, tour)
    apart = abs(own / summed - 1)
    fault = f"the plan takes {own:.6f} s, its legs {summed:.6f} s" if apart > LONGER else ""
    found = Comparison(peer, own, fault)
    remark = fault or ("longer" if found.longer() else "")
    print(
        f"{case.targets:7d} {case.region:6s} {case.seed:4d} {limit:7.0f} {peer:12.3f} {own:12.3f} "
        f"{own / peer:9.6f} {plan['lower_bound_s']:12.3f} {plan['relative_gap']:8.3%} "
        f"{peer_wall:7.1f} {wall:7.1f}  {plan['status']} {remark}",
        flush=True,
    )
    return found


def parsed():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--targets", type=int, nargs="+", default=[100, 200, 500])
    parser.add_argument("--regions", choices=REGIONS, nargs="+", default=REGIONS)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--limits", type=float, nargs="+", default=[10, 60], help="seconds")
    parser.add_argument("--threads", type=int, default=2, help="of slewplan")
    parser.add_argument("--tables", type=Path, help="folder that keeps the tables")
    parser.add_argument("--judge", action="store_true")
    return parser.parse_args()


def main():
    arguments = parsed()
    program = slewplan.binary()
    scenarios = os.environ.get("SCENARIOS") or slewplan.example("scenarios")
    print(
        "targets region seed limit, s  OR-Tools, s  slewplan, s     ratio     bound, s      gap"
        " wall, s: OR-Tools, slewplan"
    )
    found = []
    with tempfile.TemporaryDirectory() as passing:
        folder = arguments.tables or Path(passing)
        folder.mkdir(parents=True, exist_ok=True)
        for targets in arguments.targets:
            for region in arguments.regions:
                for seed in arguments.seeds:
                    case = Case(targets, region, seed)
                    scenario = case.scenario(scenarios)
                    kept = folder / f"{case.name()}.csv"
                    times = table(program, scenario, kept, arguments.threads)
                    for limit in arguments.limits:
                        given = (program, case, scenario, times, limit, arguments.threads)
                        found.append(compare(*given))
    ratios = [each.own / each.peer for each in found]
    longer = sum(each.longer() for each in found)
    print(
        f"slewplan's tours by those of OR-Tools: {min(ratios):.6f} to {max(ratios):.6f}, "
        f"median {statistics.median(ratios):.6f}; {longer} of {len(found)} longer"
    )
    faults = any(each.fault for each in found)
    return faults or (arguments.judge and longer > 0)


if __name__ == "__main__":
    sys.exit(int(main()))
