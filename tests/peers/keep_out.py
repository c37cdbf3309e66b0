#!/usr/bin/env python3
"""Random slews in the way of cones: slewplan beside CasADi + IPOPT, and every flight judged.

    python3 tests/peers/keep_out.py [--count 120] [--peers 60] [--starts 12] [--cache FILE] [--judge]

The suite is that of keep_out_suite.py. Each plan's torques are integrated here (motion.py), and the
least angle between boresight and cone, between the steps too, has to be that of the promise, 1e-6 rad
inside at most; `slewplan verify --strict` has to pass. IPOPT (keep_out_peer.py: 40 intervals, cones at
nodes and half-way, the best of so many starts through random attitudes) solves every second slew; it may
cut a cone by half a degree between its nodes, which is shown. Times are those of slewplan's process and
of its statement, all its starts included, beside that of one IPOPT solve without the building of its
program.

--cache keeps what the peers found in a file, so that another run need not repeat it: --peers 0 leaves
them out. --write keeps the scenarios in a folder. SLEWPLAN names a built binary; CasADi is installed
where it is not there (environment.py). Ends with code 1 when a slew is not solved, not clear or not
verified, and with --judge also when durations or times do not meet the demands that the end lists.
"""

import os

# IPOPT's linear algebra in one thread, as slewplan's.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import environment  # noqa: E402

if __name__ == "__main__":
    environment.enter()

import argparse  # noqa: E402
import hashlib  # noqa: E402
import json  # noqa: E402
import multiprocessing  # noqa: E402
import sys  # noqa: E402
from concurrent.futures import ThreadPoolExecutor  # noqa: E402
from functools import partial  # noqa: E402
from pathlib import Path  # noqa: E402

import numpy as np  # noqa: E402

import keep_out_peer  # noqa: E402
import slewplan  # noqa: E402
from cones import all_out, free, spelled  # noqa: E402
from flown import run  # noqa: E402
from keep_out_suite import slew  # noqa: E402

WORST_RATIO, MEDIAN_RATIO, LEAST_SPEED = 1.003, 1.000, 8.0


class Cache:
    """What peers found, by what they were asked."""

    def __init__(self, path):
        self.path, self.known = path and Path(path), {}
        if self.path and self.path.exists():
            self.known = json.loads(self.path.read_text(encoding="utf-8"))

    @staticmethod
    def key(scenario, starts):
        asked = {name: value for name, value in all_out(scenario).items() if name != "name"}
        text = json.dumps([asked, starts, keep_out_peer.INTERVALS], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:24]

    def put(self, key, name, found):
        self.known[key] = {"name": name} | found
        if self.path:
            self.path.write_text(json.dumps(self.known, indent=1, default=float), encoding="utf-8")


def by_peers(suite, starts, jobs, cache):
    """Results of the peer, in the order of the suite, as far as they are not known."""
    asked = [(Cache.key(scenario, starts), scenario) for scenario in suite]
    new = [(key, scenario) for key, scenario in asked if key not in cache.known]
    if new:
        with multiprocessing.get_context("fork").Pool(jobs) as pool:
            solve = partial(keep_out_peer.best, starts=starts)
            for (key, scenario), found in zip(new, pool.imap(solve, [each for _, each in new])):
                cache.put(key, scenario["name"], found)
                print(f"peer, {scenario['name']}: {shown(found['duration_s'])} s", flush=True)
    return [cache.known[key] for key, _ in asked]


def shown(seconds):
    return "not found" if seconds is None else f"{seconds:.3f}"


def kind(scenario):
    craft, inside = scenario["spacecraft"], len(scenario["keep_in"])
    stored = "stored" if any(scenario["start"]["wheel_speed_rad_s"]) else "      "
    count = len(scenario["keep_out"]) + inside
    return (
        f"{len(craft['wheels'])} wheels {stored} {count} cones {'in' if inside else '  '} "
        f"{len(craft['boresights'])} boresights"
    )


def fly(program, suite, jobs):
    """The runs of slewplan with and without the cones."""

    def both(scenario):
        without = run(program, free(scenario), "--threads", "1", judge=False)
        return run(program, scenario, "--threads", "1"), without

    with ThreadPoolExecutor(jobs) as pool:
        for scenario, (found, without) in zip(suite, pool.map(both, suite)):
            figures = f"{shown(found.duration)} s, without {shown(without.duration)} s"
            least = np.degrees(found.clearance) if found.planned else np.nan
            print(
                f"{scenario['name']:18s} {kind(scenario)}: {figures}, clear by {least:.6f} deg, "
                f"{1e3 * found.wall:.0f} ms {found.complaint() and 'FAIL: ' + found.complaint()}",
                flush=True,
            )
            yield found


def compare(suite, runs, peers):
    """Prints the slews that the peers solved too; the demands, and whether they hold."""
    ratios, pairs = [], []
    for scenario, found, peer in zip(suite, runs, peers):
        solved = [each for each in peer["durations_s"] if each]
        text = f"{scenario['name']:18s} peer {shown(peer['duration_s'])} s, {len(solved)} starts solved"
        if found.clear:
            pairs.append((found, peer))
        if peer["duration_s"] and found.clear:
            ratios.append(found.duration / peer["duration_s"])
            text += f", cut {peer['cut_deg']:.4f} deg, ratio {ratios[-1]:.5f}"
        print(text)
    if not ratios:
        return
    cuts = [peer["cut_deg"] for peer in peers if peer["duration_s"]]
    print(
        f"{len(ratios)} of {len(peers)} slews solved by both: ratio at most {max(ratios):.5f}, median "
        f"{np.median(ratios):.5f}, least {min(ratios):.5f}; the peer's deepest cut {max(cuts):.3f} deg"
    )
    solve = [np.mean([peer[name] for _, peer in pairs]) for name in ("wall_s", "cpu_s")]
    process = [np.mean([getattr(found, name) for found, _ in pairs]) for name in ("wall", "cpu")]
    stated = np.mean([found.plan["statistics"]["wall_time_s"] for found, _ in pairs])
    print(
        f"mean of one IPOPT solve {1e3 * solve[0]:.1f} ms (processor {1e3 * solve[1]:.1f}); slewplan "
        f"states {1e3 * stated:.1f} ms, process {1e3 * process[0]:.1f} ms (processor "
        f"{1e3 * process[1]:.1f}): {solve[0] / stated:.1f}, {solve[0] / process[0]:.1f} and by "
        f"processors {solve[1] / process[1]:.1f} times as fast"
    )
    yield f"worst ratio {max(ratios):.5f} <= {WORST_RATIO}", max(ratios) <= WORST_RATIO
    yield f"median ratio {np.median(ratios):.6f} <= {MEDIAN_RATIO}", np.median(ratios) <= MEDIAN_RATIO
    # What else the machine did, perhaps when the peers' results were kept, counts for neither.
    speed = solve[1] / process[1]
    yield f"times as fast as one solve, by processors {speed:.1f} >= {LEAST_SPEED}", speed >= LEAST_SPEED


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--binary", help="slewplan")
    parser.add_argument("--count", type=int, default=120, help="slews of the suite")
    parser.add_argument("--peers", type=int, default=60, help="every second of them, so many")
    parser.add_argument("--starts", type=int, default=12, help="of each slew by the peer")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1, help="processes at once; more disturb the times")
    parser.add_argument("--cache", help="JSON file of the peers' results")
    parser.add_argument("--write", type=Path, help="folder for the scenarios")
    parser.add_argument("--judge", action="store_true")
    arguments = parser.parse_args()
    program = slewplan.binary(arguments.binary)
    with ThreadPoolExecutor(arguments.jobs) as pool:
        suite = list(pool.map(partial(slew, program, arguments.seed), range(arguments.count)))
    if arguments.write:
        arguments.write.mkdir(parents=True, exist_ok=True)
        for number, scenario in enumerate(suite):
            text = json.dumps(spelled(program, scenario), indent=1) + "\n"
            path = arguments.write / f"{arguments.seed}-{number:03}.json"
            path.write_text(text, encoding="utf-8")
    runs = list(fly(program, suite, arguments.jobs))
    failed = sum(bool(found.complaint()) for found in runs)
    print(f"{len(runs)} slews, {failed} not solved, not clear or not verified", flush=True)
    chosen = slice(0, 2 * arguments.peers, 2)
    cache = Cache(arguments.cache)
    peers = by_peers(suite[chosen], arguments.starts, arguments.jobs, cache)
    verdicts = list(compare(suite[chosen], runs[chosen], peers))
    for text, met in verdicts:
        print(f"{'pass' if met else 'FAIL'}: {text}")
    return failed or (arguments.judge and not all(met for _, met in verdicts))


if __name__ == "__main__":
    sys.exit(int(bool(main())))
