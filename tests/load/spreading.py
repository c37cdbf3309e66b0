#!/usr/bin/env python3
"""What `--spread-legs` gains: a plan and a table of legs with one worker, and with an idle one beside it.

    python3 tests/load/spreading.py [TARGETS [ATTITUDES]]

36 targets and 150 attitudes by default, none of whose legs is known; a worker has one thread. Of the plan only the
stage of the legs is timed.
"""

import sys
import time
from contextlib import ExitStack

from leg_tables import made, matrix
from postgres import Postgres
from service import FINAL, Service, Table, fixture
from worker import Worker

# The stages of a plan after that of its legs.
LATER = ("search", "verify")


def scenario(count):
    """Targets over all rotations."""
    attitudes = matrix(count)["attitudes"]
    targets = [{"id": f"T{number}", "attitude": attitude} for number, attitude in enumerate(attitudes)]
    return {**fixture("two-targets"), "targets": targets, "keep_out": []}


def legs_s(service, targets):
    """Time until a plan has all its legs, s; stops it then."""
    begin = time.monotonic()
    identifier = service.submit(scenario(targets))
    service.wait(identifier, lambda job: job["stage"] in LATER or job["state"] in FINAL, patience=1200.0)
    took = time.monotonic() - begin
    service.request("POST", f"/v1/plans/{identifier}/stop")
    service.wait_end(identifier)
    return took


def table_s(service, attitudes):
    """Time of a table, s."""
    job = made(service, matrix(attitudes + 1, kind="rest_to_rest"))
    if (job["state"], job["missing"]) != ("succeeded", 0):
        raise RuntimeError(f"the table has not all its legs: {job}")
    return job["solved_s"]


def legs_solved(worker):
    """Number of legs that a worker has solved."""
    _, told = worker.request("GET", "/metrics")
    lines = told.decode().splitlines()
    return int(float(next(line for line in lines if line.startswith("slewplan_legs_solved_total ")).split()[1]))


def measured(workers, targets, attitudes):
    """Times of plan and table with a number of workers, s, and the legs of each worker after both."""
    with ExitStack() as stack:
        postgres = stack.enter_context(Postgres())
        service = stack.enter_context(Service(postgres.url(), "--no-worker"))
        crew = [stack.enter_context(Worker(postgres.url(), "--spread-legs")) for _ in range(workers)]
        plan_s = legs_s(service, targets)
        of_plan = [legs_solved(worker) for worker in crew]
        took_s = table_s(service, attitudes)
        of_both = [legs_solved(worker) for worker in crew]
        return plan_s, of_plan, took_s, of_both


def legs_of(side, after, before):
    """Legs that each worker has solved between two counts."""
    earlier = side[before] if before is not None else [0] * len(side[after])
    return [late - early for late, early in zip(side[after], earlier)]


def main(targets, attitudes):
    table = Table()
    alone = measured(1, targets, attitudes)
    helped = measured(2, targets, attitudes)
    for what, time_at, legs_at, before_at in [("plan", 0, 1, None), ("table", 2, 3, 1)]:
        times = [f"{side[time_at]:.1f} s" for side in (alone, helped)]
        table.row(f"legs of a {what} with one worker, with two", ", ".join(times), "", True)
        one, two = (legs_of(side, legs_at, before_at) for side in (alone, helped))
        table.row(f"solved by each of two, of {sum(one)} by one", " + ".join(map(str, two)), "", all(two))
    table.exit()


if __name__ == "__main__":
    numbers = [int(text) for text in sys.argv[1:]]
    main(*numbers, *[36, 150][len(numbers) :])
