"""Promises about jobs that are ended: by a cancel, and by processes that shut down."""

import json
import random
import signal
import threading
import time

from harness import Row, gate, long_running, percentile, ready, service, timed, variant
from service import FINAL


@gate("J7")
def cancel_frees_the_core(scale):
    """Every solver has a job; one of them is cancelled, and the next job has to wait for that."""
    database, random_state = scale.database("j7"), random.Random(7)
    ends, freed, wrong = [], [], 0
    with service(database, "--jobs", "1") as running:
        for number in range(len(running.workers) - 1):
            other = running.submit(long_running(10_000 + number))
            running.wait(other, lambda job: job["state"] == "running")
        for number in range(scale.rounds(500, 10)):
            job = running.submit(long_running(number))
            after = running.submit(variant(0))
            running.wait(job, lambda job: job["state"] == "running")
            time.sleep(random_state.uniform(0.0, 0.3))
            asked = time.time_ns() // 1000
            running.request("POST", f"/v1/plans/{job}/cancel")
            wrong += running.wait_end(job)["state"] != "cancelled"
            running.wait_end(after)
            [(end,)] = database.rows("SELECT finished_us FROM jobs WHERE id = ?", job)
            [(start,)] = database.rows("SELECT started_us FROM jobs WHERE id = ?", after)
            ends.append((end - asked) / 1e3)
            freed.append((start - end) / 1e3)
            running.request("DELETE", f"/v1/plans/{job}")
            running.request("DELETE", f"/v1/plans/{after}")
    slow, worst, next_job = percentile(ends, 0.99), max(ends), max(freed)
    return [
        Row("J7", f"jobs not cancelled, of {len(ends)}", str(wrong), "0", wrong == 0),
        Row("J7", "cancel until the job has ended, p99", f"{slow:.0f} ms", "250 ms", slow <= 250.0, timed=True),
        Row("J7", "slowest", f"{worst:.0f} ms", "1000 ms", worst <= 1000.0, timed=True),
        Row("J7", "end until the next job runs, slowest", f"{next_job:.0f} ms", "100 ms", next_job <= 100.0, timed=True),
        *races(scale),
    ]


def ends_of(database, job):
    """Number of results and of final events of a job."""
    [(results,)] = database.rows("SELECT count(*) FROM results r JOIN jobs j ON r.job = j.sequence WHERE j.id = ?", job)
    events = database.rows(
        "SELECT e.data FROM events e JOIN jobs j ON e.job = j.sequence WHERE j.id = ? AND e.kind = 'state'", job
    )
    return results, sum(json.loads(data)["state"] in FINAL for (data,) in events)


def races(scale):
    """Cancel against finish: one final state, one final event, a plan only if it was not cancelled."""
    database, random_state = scale.database("j7-races"), random.Random(8)
    wrong, count, states = 0, scale.rounds(1000, 20), {}
    with service(database) as running:
        running.wait_end(running.submit(variant(0)))
        for _ in range(count):
            job = running.submit(variant(0))
            time.sleep(random_state.uniform(0.0, 0.08))
            running.request("POST", f"/v1/plans/{job}/cancel")
            state = running.wait_end(job)["state"]
            states[state] = states.get(state, 0) + 1
            wrong += ends_of(database, job) != (0 if state == "cancelled" else 1, 1)
    shares = ", ".join(f"{count} {state}" for state, count in sorted(states.items()))
    return [Row("J7", f"races with two ends, of {count} ({shares})", str(wrong), "0", wrong == 0)]


@gate("J8")
def drain_is_graceful(scale):
    """SIGTERM with open streams and a running job."""
    database, rows = scale.database("j8"), []
    with service(database) as running:
        job = running.submit(long_running())
        waiting = running.submit(long_running(1))
        running.wait(job, lambda job: job["state"] == "running")
        streams, told = [], []

        def follow(identifier):
            try:
                told.append(running.request("GET", f"/v1/plans/{identifier}/events")[1].decode())
            except Exception as error:  # a stream that broke tells so
                told.append(repr(error))

        for number in range(50):
            streams.append(threading.Thread(target=follow, args=(waiting if number % 2 else job,)))
            streams[-1].start()
        time.sleep(1.0)
        begin = time.monotonic()
        running.signal(signal.SIGTERM)
        time.sleep(0.1)
        try:
            status = ready(running)
        except OSError:
            status = 0
        codes = running.wait_exit()
        took = time.monotonic() - begin
        for stream in streams:
            stream.join()
    closed = sum("event: closing" in text for text in told)
    states = database.rows("SELECT state, attempt FROM jobs ORDER BY sequence")
    rows.append(Row("J8", "ready 100 ms after SIGTERM (0: refuses connections)", str(status), "not 200", status != 200))
    rows.append(Row("J8", "streams that ended with a last event, of 50", str(closed), "50", closed == 50))
    rows.append(Row("J8", f"exit codes other than 0, of {len(codes)}", str(sum(map(bool, codes))), "0", not any(codes)))
    rows.append(Row("J8", "SIGTERM until the exit", f"{took:.1f} s", "25 s", took <= 25.0))
    rows.append(Row("J8", "interrupted job: state and attempts", str(states[0]), "queued, 0", states[0] == ("queued", 0)))
    with service(database) as running:
        running.wait(job, lambda job: job["state"] == "running")
        if scale.shared:
            rows.append(handed_on(running, job))
        for _ in range(5):
            running.signal(signal.SIGTERM)
        took, codes = timed(running.wait_exit)
    harmless = database.sound() and database.rows("SELECT count(*) FROM jobs") == [(2,)] and not any(codes)
    rows.append(Row("J8", f"five SIGTERM: exit codes {sorted(set(codes))}, nothing lost", "yes" if harmless else "no", "yes", harmless))
    rows.append(Row("J8", "five SIGTERM until the exit", f"{took:.2f} s", "1 s", took <= 1.0, timed=True))
    return rows


def handed_on(running, job):
    """Another worker takes the job at once of one that ends."""
    worker = running.solver_of(job)
    worker.process.send_signal(signal.SIGTERM)
    took, code = timed(lambda: worker.process.wait(60))
    begin = time.monotonic()
    now = running.wait(job, lambda job: job["state"] == "running")
    waited = time.monotonic() - begin
    running.restart(running.processes.index(worker))
    holds = code == 0 and now["attempt"] == 1 and took + waited <= 1.0
    return Row("J8", "SIGTERM of one worker until another has its job, no attempt lost", f"{took + waited:.2f} s", "1 s", holds, timed=True)
