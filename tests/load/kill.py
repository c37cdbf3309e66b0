#!/usr/bin/env python3
"""`kill -9` during a solve, again and again on one database: the job runs again and finishes.

Every round submits jobs, kills the service at a random moment while the first one runs, starts it
again and waits for all of them. A kill that comes too late, after the first job has ended, counts
for nothing but the check that nothing is lost; rounds go on until enough have come in time.
"""

import random
import sys
import tempfile
import time
from pathlib import Path

from service import Service, Table, fixture

WAITING_BEHIND = 2
# Latest kill after the begin of a solve, s, and rounds at most for every kill that is wanted.
LATEST_S = 0.2
MOST_ROUNDS = 5


def round_of(database, random_state, number, name):
    """Whether the kill came in time, the seconds until the restarted service answered, the jobs that
    were acknowledged, as they ended, and the statuses of their results."""
    with Service(database, "--log", "warn") as service:
        acknowledged = []
        for job in range(1 + WAITING_BEHIND):
            scenario = fixture(name if job == 0 else "two-targets")
            for target in scenario["targets"]:
                # New legs in every round, so that there is something to interrupt.
                target["attitude"]["roll_pitch_yaw_deg"][1] += 0.01 * (number + 1)
            acknowledged.append(service.submit(scenario))
        service.wait(acknowledged[0], lambda job: job["state"] == "running")
        time.sleep(random_state.uniform(0.0, LATEST_S))
        service.kill()
    begin = time.monotonic()
    with Service(database, "--log", "warn") as service:
        restart = time.monotonic() - begin
        jobs = [service.wait_end(identifier) for identifier in acknowledged]
        results = [service.request("GET", f"/v1/plans/{job['id']}/result")[0] for job in jobs]
    # The solve was over when its job needed one attempt only.
    return jobs[0]["attempt"] > 1, restart, jobs, results


def main(kills, name):
    table = Table()
    random_state = random.Random(1)
    interrupted, restarts, unfinished, everything = 0, [], 0, []
    with tempfile.TemporaryDirectory() as folder:
        database = Path(folder) / "kill.db"
        for number in range(MOST_ROUNDS * kills):
            if interrupted == kills:
                break
            hit, restart, jobs, results = round_of(database, random_state, number, name)
            interrupted += hit
            restarts.append(restart)
            everything += [job["id"] for job in jobs]
            unfinished += sum(job["state"] != "succeeded" for job in jobs)
            unfinished += results.count(404)
        with Service(database, "--log", "warn") as service:
            lost = sum(service.request("GET", f"/v1/plans/{job}")[0] != 200 for job in everything)
    table.row("kills during a solve", str(interrupted), str(kills), interrupted == kills)
    table.row(f"acknowledged jobs lost, of {len(everything)}", str(lost), "0", lost == 0)
    table.row("jobs that did not run again or did not finish", str(unfinished), "0", unfinished == 0)
    table.timed("longest restart", f"{max(restarts):.2f} s", "1 s", max(restarts) < 1.0)
    table.exit()


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else 20,
        sys.argv[2] if len(sys.argv) > 2 else "olivares-a",
    )
