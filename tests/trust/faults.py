"""Promises about what panics and crashes cost, measured with a build that fails on purpose."""

import http.client
import os
import random
import re
import shutil
import subprocess
import time
from pathlib import Path

from harness import HTTP_ALIKE, ROOT, Row, exchange, fixture, gate, long_running, resident_kib, service, strip, variant
from service import FINAL


def faulty(scale):
    """The binary with the feature `faults`: SLEWPLAN_FAULTS, or one that is built for it."""
    given = os.environ.get("SLEWPLAN_FAULTS")
    if given:
        return given
    copy = scale.work / "slewplan-faults"
    if not copy.exists():
        # The target folder holds one binary of this name: afterwards it is the usual one again.
        build = ["cargo", "build", "--quiet", "--locked", "--package", "slewplan-server"]
        target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
        subprocess.run([*build, "--features", "faults"], cwd=ROOT, check=True)
        shutil.copy(target / "debug" / "slewplan", copy)
        subprocess.run(build, cwd=ROOT, check=True)
    return str(copy)


def named(name, number=0):
    scenario = variant(number)
    scenario["name"] = name
    return scenario


@gate("H5", of_a_file=HTTP_ALIKE)
def a_panic_costs_one_job_or_one_request(scale):
    database, rounds = scale.database("h5"), scale.of(1000, 40)
    kinds, states, statuses = ["fault:panic", "fault:pool", "fault:drop"], {}, {}
    with service(database, "--queue-limit", "100000", environment={"SLEWPLAN": faulty(scale)}) as running:
        process = running.process

        def panics(count):
            for number in range(count):
                status = int(exchange(running, b"GET /v1/version HTTP/1.1\r\nHost: localhost\r\nX-Fault: 1\r\nConnection: close\r\n\r\n")[9:12])
                statuses[status] = statuses.get(status, 0) + 1
                state = running.wait_end(running.submit(named(kinds[number % 3])))["state"]
                states[state] = states.get(state, 0) + 1

        panics(scale.of(100, 10))
        threads, memory = len(os.listdir(f"/proc/{process.pid}/task")), resident_kib(process.pid)
        panics(rounds)
        grown = (resident_kib(process.pid) - memory) / 1024
        spawned = len(os.listdir(f"/proc/{process.pid}/task")) - threads
        good = running.wait_end(running.submit(variant(0)))["state"]
        alive = process.poll() is None
    return [
        Row("H5", f"answers of handlers that panicked: {statuses}", str(set(statuses)), "500", set(statuses) == {500}),
        Row("H5", f"jobs that panicked, ended as {states}; the next one {good}", str(set(states)), "failed", set(states) == {"failed"} and good == "succeeded" and alive),
        Row("H5", f"memory after {2 * rounds} panics", f"{grown:+.1f} MB", "+10 MB", grown <= 10.0),
        # Threads that wait for blocking work come and go.
        Row("H5", "threads more than before", str(spawned), "2", spawned <= 2),
    ]


def estimated(scale, scenario):
    """What a service with little memory says a job may need, KiB; 0 when it is little enough."""
    with service(scale.database("h6-estimates"), "--job-memory", "16") as running:
        status, answer = running.request("POST", "/v1/plans", scenario)
        if status == 202:
            running.request("DELETE", f"/v1/plans/{answer['id']}")
            return 16 * 1024
        return int(re.search(r"may need (\d+) bytes", answer["detail"])[1]) / 1024


@gate("H6", of_a_file=HTTP_ALIKE)
def memory_of_a_job_is_bounded(scale):
    """Estimates against peaks of solves, and a job that takes all it can get."""
    shares, counts = [], scale.of([1, 5, 10, 16, 20, 40, 80], [1, 10])
    state = random.Random(6)
    for count in counts:
        apart = fixture("olivares-a")
        apart["targets"] = [
            {"id": f"t{number}", "attitude": {"roll_pitch_yaw_deg": [state.uniform(-180, 180) for _ in range(3)]}}
            for number in range(count)
        ]
        for number, scenario in enumerate((apart, strip(count))):
            scenario["options"] = {"time_limit_s": scale.of(30, 5)}
            with service(scale.database(f"h6-{count}-{number}"), "--job-memory", "4096") as running:
                running.wait_end(running.submit(variant(0)))
                before = resident_kib(running.process.pid)
                running.wait_end(running.submit(scenario), patience=300.0)
                peak = resident_kib(running.process.pid, "VmHWM") - before
            estimate = estimated(scale, scenario)
            print(f"    {count} targets, kind {number}: estimate {estimate / 1024:.1f} MB, peak {peak / 1024:.1f} MB")
            shares.append((estimate, estimate / max(peak, 1)))
    least, most = min(share for _, share in shares), max(share for _, share in shares)
    worth = max((share for estimate, share in shares if estimate > 16 * 1024), default=1.0)
    with service(scale.database("h6"), "--job-memory", "64", environment={"SLEWPLAN": faulty(scale)}) as running:
        before = resident_kib(running.process.pid)
        job = running.wait_end(running.submit(named("fault:memory")))
        peak = (resident_kib(running.process.pid, "VmHWM") - before) / 1024
        after = running.wait_end(running.submit(variant(0)))["state"]
    return [
        Row("H6", f"estimate over peak, least of {len(shares)} problems", f"{least:.1f}", "1", least >= 1.0),
        Row("H6", "most, of estimates above 16 MB", f"{worth:.1f}", "4", worth <= 4.0),
        Row("H6", "most of all", f"{most:.1f}", "-", None),
        Row("H6", f"job over 64 MB: {job['state']}, {job['detail']}"[:78], f"{peak:.0f} MB", "80 MB", "memory" in str(job["detail"]) and peak <= 80 and after == "succeeded"),
    ]


@gate("J4")
def poison_ends_dead(scale):
    """A job that ends its process, which is started again each time: after three it is given up, and the
    rest goes on."""
    database, deaths = scale.database("j4"), 0
    with service(database, "--jobs", "1", environment={"SLEWPLAN": faulty(scale)}) as running:
        # Until both are queued, nobody is free.
        before = [running.submit(long_running(number)) for number in range(len(running.workers))]
        for job in before:
            running.wait(job, lambda job: job["state"] == "running")
        poison, innocent = running.submit(named("fault:abort")), running.submit(variant(0))
        for job in before:
            try:
                running.request("POST", f"/v1/plans/{job}/cancel")
            except (OSError, http.client.HTTPException):
                pass

        def states():
            query = "SELECT state FROM jobs WHERE id IN (?, ?)"
            return {state for (state,) in database.rows(query, poison, innocent)}

        end = time.monotonic() + 120.0
        while not states() <= FINAL and time.monotonic() < end:
            for number, one in enumerate(running.processes):
                if one.process.poll() is not None:
                    deaths += 1
                    try:
                        running.restart(number)
                    except RuntimeError:
                        pass  # it has met the job before it was ready
            time.sleep(0.05)
        [(other,)] = database.rows("SELECT state FROM jobs WHERE id = ?", innocent)
    [(state, attempts)] = database.rows("SELECT state, attempt FROM jobs WHERE id = ?", poison)
    return [
        Row("J4", f"a job that aborts its process ends {state} after attempts", str(attempts), "3", state == "dead" and attempts == 3),
        Row("J4", f"processes that ended, until the job behind it had {other}", str(deaths), "3", deaths == 3 and other == "succeeded"),
    ]
