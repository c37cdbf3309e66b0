#!/usr/bin/env python3
"""Short jobs beside a long one in one process: how soon they are answered, and what the long one loses.

A job of 200 targets runs; for a while it is alone, then experiment A is submitted again and again, each
time turned a little, so that none of its legs are known. The two take turns, several times. What each job
gets is the processor time of its threads, which does not depend on what else the machine does. Then the
long job runs for as long without A, for a look at the plans of both runs.
"""

import os
import random
import sys
import tempfile
import time
from pathlib import Path

from service import Service, Table, fixture, percentile

TARGETS = 200
GOAL_S = 2.0
# Two jobs get half each while both have work for all threads.
LEAST_SHARE = 0.45
ROUNDS = 4
TICKS = os.sysconf("SC_CLK_TCK")


def long_scenario():
    """Targets all over the sphere."""
    state = random.Random(25)
    document = fixture("olivares-c")
    document["name"] = "200 targets"
    document["targets"] = [
        {
            "id": f"t{number}",
            "attitude": {"roll_pitch_yaw_deg": [state.uniform(-180, 180), state.uniform(-80, 80), state.uniform(-180, 180)]},
        }
        for number in range(TARGETS)
    ]
    document["options"] = {"time_limit_s": None}
    return document


def short_scenario(number):
    document = fixture("olivares-a")
    for target in document["targets"]:
        target["attitude"]["roll_pitch_yaw_deg"][1] += 0.003 * (number + 1)
    return document


def processor_s(service):
    """Processor time so far of the threads of each pool of the solver: that of requests, and one a job."""
    threads = []
    for task in sorted(Path(f"/proc/{service.process.pid}/task").iterdir(), key=lambda task: int(task.name)):
        fields = (task / "stat").read_text()
        name, fields = fields[fields.index("(") + 1 : fields.rindex(")")], fields.rpartition(")")[2].split()
        threads.append((name, (int(fields[11]) + int(fields[12])) / TICKS))
    _, limits = service.request("GET", "/v1/limits")
    workers = [used for name, used in threads if name.startswith("slewplan-solver")]
    count = limits["solver_threads"]
    pools = [sum(workers[first : first + count]) for first in range(0, len(workers), count)]
    # The last is the one thread of look-ups. A job has a further one, which does what cannot be shared out.
    jobs = [used for name, used in threads if name.startswith("slewplan-job")]
    return [pool + job for pool, job in zip(pools[1:-1], jobs, strict=True)]


class Window:
    """Processor time of the jobs between begin and end of every `with`, s."""

    def __init__(self, service):
        self.service, self.used = service, [0.0, 0.0]

    def __enter__(self):
        self.begin = processor_s(self.service)

    def __exit__(self, *_):
        change = [now - before for now, before in zip(processor_s(self.service), self.begin)]
        self.used = [total + part for total, part in zip(self.used, change)]


class LongJob:
    """The long job, and what it has after some seconds."""

    def __init__(self, service):
        self.service, self.begin = service, time.monotonic()
        self.id = service.submit(long_scenario())
        service.wait(self.id, lambda job: job["stage"] == "legs")

    def after(self, seconds):
        time.sleep(max(0.0, self.begin + seconds - time.monotonic()))
        job = self.service.job(self.id)
        self.service.request("POST", f"/v1/plans/{self.id}/cancel")
        self.service.wait_end(self.id)
        told = [job["incumbent_s"], job["lower_bound_s"]]
        total, bound = ["none yet" if value is None else f"{value:.1f} s" for value in told]
        return f"{total}, bound {bound}"


def answered(service, number):
    begin = time.monotonic()
    job = service.wait_end(service.submit(short_scenario(number)))
    return time.monotonic() - begin, job["state"] == "succeeded"


def main(seconds):
    table = Table()
    with tempfile.TemporaryDirectory() as folder:
        with Service(Path(folder) / "beside.db", "--log", "warn") as service:
            reference = [answered(service, number)[0] for number in range(-5, -1)]
            long = LongJob(service)
            alone, beside = Window(service), Window(service)
            answers = []
            for _ in range(ROUNDS):
                with alone:
                    time.sleep(seconds)
                with beside:
                    end = time.monotonic() + seconds
                    while time.monotonic() < end:
                        answers.append(answered(service, len(answers)))
            whole = time.monotonic() - long.begin
            with_short_jobs = long.after(whole)
        # Legs that are known already would help.
        with Service(Path(folder) / "alone.db", "--log", "warn") as service:
            without = LongJob(service).after(whole)
    good = sum(solved for _, solved in answers)
    table.row("A beside the long job: solved", f"{good}", f"{len(answers)}", good == len(answers))
    times = [took for took, _ in answers]
    print(f"{'A alone, median':<58} {percentile(reference, 0.5):>14.2f} s")
    print(f"{'A beside the long job, median':<58} {percentile(times, 0.5):>14.2f} s")
    table.timed("A beside the long job, slowest", f"{max(times):.2f} s", f"{GOAL_S:.0f} s", max(times) <= GOAL_S)
    place = alone.used.index(max(alone.used))
    share = beside.used[place] / sum(beside.used)
    table.row("share of the long job while A runs without a pause", f"{share:.2f}", f"{LEAST_SHARE}", share >= LEAST_SHARE)
    print(f"{f'plan of the long job after {whole:.0f} s with A':<42} {with_short_jobs:>32}")
    print(f"{f'plan of the long job after {whole:.0f} s without':<42} {without:>32}")
    table.exit()


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 10.0)
