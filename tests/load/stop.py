"""Stop returns the best plan with its bound, cancel frees the core; both at random moments.

One that comes too late, after the job has ended, counts for nothing but the check that the plan is
there; rounds go on until enough have come in time.
"""

import random
import sys
import tempfile
import time
from pathlib import Path

from service import Service, Table, fixture

GOAL_MS = 250.0
# Latest stop or cancel, s after the first tour or the begin of a solve, and rounds at most for every one
# that is wanted.
LATEST_S = 0.15
MOST_ROUNDS = 5


def scenario(number, name):
    document = fixture(name)
    for target in document["targets"]:
        target["attitude"]["roll_pitch_yaw_deg"][1] += 0.01 * (number + 1)
    return document


def stopped(service, number, random_state, name):
    """Milliseconds until the answer, whether it was a plan with a bound, and whether it came in time."""
    job = service.submit(scenario(number, name))
    service.wait(job, lambda job: job["incumbent_s"] is not None or job["state"] not in ("queued", "running"))
    time.sleep(random_state.uniform(0.0, LATEST_S))
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
    return took, good, answer["state"] == "stopped"


def cancelled(service, number, random_state, name):
    """Milliseconds until the job had ended, and until the next one ran; whether the job ended as
    promised, and whether the cancel came in time."""
    job = service.submit(scenario(number, name))
    successor = service.submit(fixture("two-targets"))
    service.wait(job, lambda job: job["state"] == "running")
    time.sleep(random_state.uniform(0.0, LATEST_S))
    begin = time.monotonic()
    status, answer = service.request("POST", f"/v1/plans/{job}/cancel")
    took = 1e3 * (time.monotonic() - begin)
    service.wait(successor, lambda job: job["state"] != "queued")
    freed = 1e3 * (time.monotonic() - begin)
    service.wait_end(successor)
    good = status == 200 and answer["state"] in ("cancelled", "succeeded")
    return took, freed, good, answer["state"] == "cancelled"


def in_time(wanted, attempt):
    """The attempts, of which the last value says whether they came in time, until enough did."""
    attempts = []
    while sum(one[-1] for one in attempts) < wanted and len(attempts) < MOST_ROUNDS * wanted:
        attempts.append(attempt(len(attempts)))
    return attempts


def main(wanted, name):
    table = Table()
    random_state = random.Random(2)
    with tempfile.TemporaryDirectory() as folder, Service(Path(folder) / "stop.db", "--log", "warn", "--jobs", "1") as service:
        stops = in_time(wanted, lambda number: stopped(service, number, random_state, name))
        later = len(stops)
        cancels = in_time(wanted, lambda number: cancelled(service, later + number, random_state, name))
    early = sum(hit for *_, hit in stops)
    table.row("stops during a solve", str(early), str(wanted), early == wanted)
    good = sum(good for _, good, _ in stops)
    table.row("stops that gave a verified plan with its bound", str(good), str(len(stops)), good == len(stops))
    worst = max(took for took, _, _ in stops)
    table.timed("slowest stop", f"{worst:.0f} ms", f"{GOAL_MS:.0f} ms", worst < GOAL_MS)
    early = sum(hit for *_, hit in cancels)
    table.row("cancels during a solve", str(early), str(wanted), early == wanted)
    good = sum(good for *_, good, _ in cancels)
    table.row("jobs that ended cancelled, or were done", str(good), str(len(cancels)), good == len(cancels))
    worst = max(took for took, *_ in cancels)
    table.timed("slowest cancel", f"{worst:.0f} ms", f"{GOAL_MS:.0f} ms", worst < GOAL_MS)
    worst = max(freed for _, freed, *_ in cancels)
    table.timed("slowest start of the next job after a cancel", f"{worst:.0f} ms", f"{GOAL_MS:.0f} ms", worst < GOAL_MS)
    table.exit()


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else 20,
        sys.argv[2] if len(sys.argv) > 2 else "olivares-c",
    )
