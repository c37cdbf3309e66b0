#!/usr/bin/env python3
"""Speed of legs from rest to rest: slewplan, CasADi + fatrop and CasADi + IPOPT in one run.

    python3 tests/peers/legs.py [--rounds 3] [--targets 18] [--judge]

All pairs of the start and the targets of the published experiment C: 171, or fewer with fewer
targets. Every round flies them with fatrop, slewplan, IPOPT and slewplan again, so that whatever
else the machine does meets all alike. A peer's time of a leg is that of its solve alone, without
the building of its program; slewplan's is that of the whole process, `slewplan legs --threads 1`,
by the number of pairs, and `solve_time_s` is what it states for a leg, with all its starts. It
solves legs that are equal but for their frame once; the table says how many it solved.

SLEWPLAN names a built binary; without it the binary is built. The peers are installed first where
they are not there (see environment.py). Ends with code 1 when a leg of slewplan failed. With all
targets the demands on slewplan are listed last; they are judged with --judge only, which also ends
with code 1 when one is not met.
"""

import argparse
import itertools
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import environment
from slewplan import ROOT, binary, fixture

ALL_TARGETS = 18
PEERS = ["fatrop", "ipopt"]
# The demands: fatrop's times by slewplan's, the sum of all 171 durations, s, and memory, MB.
LEAST_MEAN_RATIO = 8
LEAST_MEDIAN_RATIO = 10
MOST_SUM = 18_525.0
MOST_MEMORY = 64
# Durations of legs of one class agree to this share.
SAME_DURATION = 1e-5


class Slewplan:
    """Runs of the whole process."""

    def __init__(self, program, scenario, names):
        self.command = [program, "legs", scenario, "--threads", "1", "--progress", "none"]
        self.pairs = list(itertools.combinations(names, 2))
        self.wall, self.cpu, self.memory, self.solve_times = [], [], [], []
        self.durations, self.solves = [], 0

    def fly(self):
        with tempfile.TemporaryFile() as output:
            begin = time.perf_counter()
            process = subprocess.Popen(self.command, stdout=output)
            # The resources of this one process. This script imports little, because a child
            # inherits the largest memory of its parent at the moment of its birth.
            _, status, used = os.wait4(process.pid, 0)
            self.wall.append(time.perf_counter() - begin)
            process.returncode = os.waitstatus_to_exitcode(status)
            # With legs that failed it ends with 1, and the table names them.
            if process.returncode not in (0, 1):
                sys.exit(f"slewplan ended with code {process.returncode}")
            output.seek(0)
            table = json.load(output)
        self.cpu.append(used.ru_utime + used.ru_stime)
        self.memory.append(used.ru_maxrss / 1024)
        rows = {(row["from"], row["to"]): row for row in table["legs"]}
        legs = [rows[pair] for pair in self.pairs]
        self.solve_times += [leg["solve_time_s"] for leg in legs]
        # No two solves take the same time to the last digit.
        self.solves = len({leg["solve_time_s"] for leg in legs})
        self.durations = [
            leg["duration_s"] if leg["status"] == "converged" else None for leg in legs
        ]


class Peer:
    """Solves of one peer, in the process that all peers share."""

    def __init__(self, name, process):
        self.name, self.process = name, process
        self.wall, self.cpu, self.durations = [], [], []

    def fly(self):
        self.process.stdin.write(self.name + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            sys.exit(f"the peers ended with code {self.process.wait()}")
        wall, cpu, self.durations = zip(*json.loads(answer))
        self.wall += wall
        self.cpu += cpu


def product(p, q):
    """Hamilton product, scalar last."""
    (a, b, c, s), (x, y, z, t) = p, q
    return (
        s * x + t * a + b * z - c * y,
        s * y + t * b + c * x - a * z,
        s * z + t * c + a * y - b * x,
        s * t - a * x - b * y - c * z,
    )


def quaternion(attitude):
    if "quaternion" in attitude:
        return tuple(attitude["quaternion"][part] for part in "xyzw")
    whole = (0.0, 0.0, 0.0, 1.0)
    for axis, angle in zip((2, 1, 0), reversed(attitude["roll_pitch_yaw_deg"])):
        turn = [0.0, 0.0, 0.0, math.cos(math.radians(angle) / 2)]
        turn[axis] = math.sin(math.radians(angle) / 2)
        whole = product(whole, turn)
    return whole


def classes(places):
    """Pairs of the same turn, by their indices.

    Without total momentum and with equal limits both ways along the principal axes, half turns of
    the body's frame and flying backwards lead from a leg to one as long: these change the signs of
    the quaternion's components, and no more.
    """
    turns = {}
    for index, (start, goal) in enumerate(itertools.combinations(places, 2)):
        x, y, z, w = start
        turn = product((-x, -y, -z, w), goal)
        key = tuple(round(abs(part), 9) for part in turn)
        turns.setdefault(key, []).append(index)
    return list(turns.values())


def spread(durations, groups):
    """Largest relative difference of durations that should be the same."""
    worst = 0.0
    for group in groups:
        found = [durations[i] for i in group if durations[i] is not None]
        if found:
            worst = max(worst, max(found) / min(found) - 1)
    return worst


def p99(values):
    return sorted(values)[math.ceil(0.99 * len(values)) - 1]


def quality(durations, groups):
    failed = durations.count(None)
    total = sum(duration for duration in durations if duration is not None)
    return f"{failed:6d} {total:12.2f} {spread(durations, groups):10.1e}"


def show(slewplan, peers, groups):
    count = len(slewplan.pairs)
    print(f"{count} legs in {len(groups)} classes of equal turns; times in ms")
    print("                 median    mean     p99  mean cpu failed       sum, s  in a class")
    for peer in peers:
        wall = [1e3 * value for value in peer.wall]
        times = (statistics.median(wall), statistics.mean(wall), p99(wall))
        figures = [*times, 1e3 * statistics.mean(peer.cpu)]
        line = " ".join(f"{figure:7.2f}" for figure in figures)
        print(f"casadi + {peer.name:7s}{line}  {quality(peer.durations, groups)}")
    stated = [1e3 * value for value in slewplan.solve_times]
    times = (statistics.median(stated), statistics.mean(stated), p99(stated))
    line = " ".join(f"{figure:7.3f}" for figure in times)
    print(f"slewplan, a leg {line}          {quality(slewplan.durations, groups)}")
    wall = [1e3 * value / count for value in slewplan.wall]
    cpu = 1e3 * statistics.mean(slewplan.cpu) / count
    ratio = 1e3 * statistics.mean(peers[0].cpu) / cpu
    print(
        f"slewplan, process / {count}: mean {statistics.mean(wall):.3f}, best {min(wall):.3f}, "
        f"cpu {cpu:.3f}; {slewplan.solves} solves; {max(slewplan.memory):.1f} MB at most\n"
        f"mean cpu of {peers[0].name} / cpu of the process by leg: {ratio:.1f}"
    )


def demands(slewplan, fatrop, groups):
    """What is asked of slewplan: text, and whether it holds."""
    count = len(slewplan.pairs)
    by_process = statistics.mean(fatrop.wall) / (statistics.mean(slewplan.wall) / count)
    by_leg = statistics.median(fatrop.wall) / statistics.median(slewplan.solve_times)
    apart, memory = spread(slewplan.durations, groups), max(slewplan.memory)
    yield f"mean of fatrop / process by leg {by_process:.1f} >= {LEAST_MEAN_RATIO}", (
        by_process >= LEAST_MEAN_RATIO
    )
    yield f"median of fatrop / of solve_time_s {by_leg:.1f} >= {LEAST_MEDIAN_RATIO}", (
        by_leg >= LEAST_MEDIAN_RATIO
    )
    yield f"durations within a class agree: {apart:.1e} <= {SAME_DURATION}", apart <= SAME_DURATION
    yield f"memory {memory:.1f} MB < {MOST_MEMORY}", memory < MOST_MEMORY
    total = sum(duration or math.inf for duration in slewplan.durations)
    yield f"sum of durations {total:.2f} s <= {MOST_SUM:.0f}", total <= MOST_SUM


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--targets", type=int, default=ALL_TARGETS, help="the first so many")
    parser.add_argument("--judge", action="store_true")
    arguments = parser.parse_args()
    if arguments.judge and arguments.targets != ALL_TARGETS:
        parser.error("the demands are on all targets")
    scenario = fixture("olivares-c")
    scenario["targets"] = scenario["targets"][: arguments.targets]
    # The end of the experiment is its start once more.
    del scenario["end"]
    program, python = binary(), environment.interpreter()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "scenario.json")
        path.write_text(json.dumps(scenario), encoding="utf-8")
        names = ["start", *(target["id"] for target in scenario["targets"])]
        slewplan = Slewplan(program, path, names)
        with subprocess.Popen(
            [python, ROOT / "tests" / "peers" / "rest_to_rest.py", path],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        ) as process:
            peers = [Peer(name, process) for name in PEERS]
            for _ in range(arguments.rounds):
                for peer in peers:
                    peer.fly()
                    slewplan.fly()
            process.stdin.close()
    places = [scenario["start"], *scenario["targets"]]
    groups = classes([quaternion(place["attitude"]) for place in places])
    show(slewplan, peers, groups)
    whole = arguments.targets == ALL_TARGETS
    verdicts = list(demands(slewplan, peers[0], groups)) if whole else []
    for text, met in verdicts:
        print(f"{'pass' if met else 'FAIL'}: {text}")
    failed = None in slewplan.durations
    return failed or (arguments.judge and not all(met for _, met in verdicts))


if __name__ == "__main__":
    sys.exit(int(main()))
