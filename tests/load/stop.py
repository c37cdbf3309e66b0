#!/usr/bin/env python3
"""Stop returns the best plan with its bound, cancel frees the core; both at random moments."""

import random
import sys
import tempfile
import time
from pathlib import Path

from service import Service, Table, fixture

GOAL_MS = 250.0


def scenario(number, name):
    document = fixture(name)
    for target in document["targets"]:
        target["attitude"]["roll_pitch_yaw_deg"][1] += 0.01 * (number + 1)
    return document


def stopped(service, number, random_state, name):
    """Milliseconds until the answer, and whether it was a plan with a bound."""
    job = service.submit(scenario(number, name))
    service.wait(job, lambda job: job["incumbent_s"] is not None or job["state"] != "running" and job["state"] != "queued")
    time.sleep(random_state.uniform(0.0, 0.3))
    begin = time.monotonic()
    status, answer = service.request("POST", f"/v1/plans/{job}/stop")
    took = 1e3 * (time.monotonic() - begin)
    _, plan = service.request("GET", f"/v1/plans/{job}/result")
    good = (
        status == 200
        and answer["state"] in ("stopped", "succeeded")
        and plan["verification"]["passed"]
        and 0.0 < plan["lower_bound_s"] <= plan["total_time_s"]
    )
    return took, good, answer["state"]


def cancelled(service, number, random_state, name):
    """Milliseconds until the job had ended, and until the next one ran."""
    job = service.submit(scenario(number, name))
    successor = service.submit(fixture("two-targets"))
    service.wait(job, lambda job: job["state"] == "running")
    time.sleep(random_state.uniform(0.0, 0.5))
    begin = time.monotonic()
    status, answer = service.request("POST", f"/v1/plans/{job}/cancel")
    took = 1e3 * (time.monotonic() - begin)
    service.wait(successor, lambda job: job["state"] != "queued")
    freed = 1e3 * (time.monotonic() - begin)
    service.wait_end(successor)
    return took, freed, status == 200 and answer["state"] == "cancelled"


def main(rounds, name):
    table = Table()
    random_state = random.Random(2)
    with tempfile.TemporaryDirectory() as folder, Service(Path(folder) / "stop.db", "--log", "warn") as service:
        stops = [stopped(service, number, random_state, name) for number in range(rounds)]
        cancels = [cancelled(service, rounds + number, random_state, name) for number in range(rounds)]
    early = sum(state == "stopped" for _, _, state in stops)
    table.row(f"stops that gave a verified plan with its bound ({early} early)", str(sum(good for _, good, _ in stops)), str(rounds), all(good for _, good, _ in stops))
    worst = max(took for took, _, _ in stops)
    table.timed("slowest stop", f"{worst:.0f} ms", f"{GOAL_MS:.0f} ms", worst < GOAL_MS)
    table.row("cancelled jobs that ended so", str(sum(good for _, _, good in cancels)), str(rounds), all(good for _, _, good in cancels))
    worst = max(took for took, _, _ in cancels)
    table.timed("slowest cancel", f"{worst:.0f} ms", f"{GOAL_MS:.0f} ms", worst < GOAL_MS)
    worst = max(freed for _, freed, _ in cancels)
    table.timed("slowest start of the next job after a cancel", f"{worst:.0f} ms", f"{GOAL_MS:.0f} ms", worst < GOAL_MS)
    table.exit()


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else 20,
        sys.argv[2] if len(sys.argv) > 2 else "olivares-c",
    )
