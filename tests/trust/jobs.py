"""Promises about jobs."""

import math
import random
import re
import signal
import sqlite3
import subprocess
import threading
import time

from harness import (
    Row,
    Service,
    binary,
    fixture,
    gate,
    long_running,
    percentile,
    rows_of,
    service,
    sound,
    timed,
    unit_test,
    variant,
)


@gate("J1")
def acknowledged_jobs_survive(scale):
    """Kills at random times under submissions; every acknowledged job is there after each."""
    kills, random_state = scale.of(200, 5), random.Random(1)
    database = scale.database("j1")
    acknowledged, number, unsound = set(), 0, 0
    for _ in range(kills):
        with service(database, "--queue-limit", "100000") as running:
            ended = threading.Event()

            def submit():
                nonlocal number
                while not ended.is_set():
                    number += 1
                    try:
                        acknowledged.add(running.submit(variant(number)))
                    except (OSError, RuntimeError, ValueError, EOFError):
                        return
                    except Exception:  # an answer that was cut off is none
                        return

            threads = [threading.Thread(target=submit) for _ in range(4)]
            for thread in threads:
                thread.start()
            time.sleep(random_state.uniform(0.05, 0.5))
            running.kill()
            ended.set()
            for thread in threads:
                thread.join()
        unsound += not sound(database)
    stored = {identifier for (identifier,) in rows_of(database, "SELECT id FROM jobs")}
    lost = len(acknowledged - stored)
    return [
        Row("J1", f"jobs lost, of {len(acknowledged)} acknowledged, {kills} kills", str(lost), "0", lost == 0 and len(acknowledged) > kills),
        Row("J1", "databases that failed integrity_check", str(unsound), "0", unsound == 0),
    ]


@gate("J2")
def orphans_are_found_at_once(scale):
    database = scale.database("j2")
    waits, attempts = [], []
    for number in range(scale.of(20, 2)):
        with service(database) as running:
            job = running.submit(long_running(number))
            running.wait(job, lambda job: job["state"] == "running")
            running.kill()
        begin = time.monotonic()
        with service(database) as running:
            state = running.wait(job, lambda job: job["attempt"] == 2)
            waits.append(time.monotonic() - begin)
            attempts.append(state["attempt"])
            running.request("DELETE", f"/v1/plans/{job}")
    worst = max(waits)
    return [Row("J2", "restart until the orphan runs again, slowest", f"{worst:.2f} s", "1 s", worst <= 1.0, timed=True)]


@gate("J6")
def one_key_makes_one_job(scale):
    """Parallel submissions with one key and a kill in the middle."""
    database = scale.database("j6")
    scenario, changed = fixture("two-targets"), fixture("two-targets")
    changed["name"] = "another"
    identifiers, total = set(), scale.of(500, 40)

    def storm(running, count):
        def submit():
            for _ in range(count // 20):
                try:
                    identifiers.add(running.submit(scenario, **{"Idempotency-Key": "same"}))
                except Exception:  # the service is killed meanwhile
                    pass

        threads = [threading.Thread(target=submit) for _ in range(20)]
        for thread in threads:
            thread.start()
        return threads

    with service(database) as running:
        threads = storm(running, total)
        time.sleep(0.1)
        running.kill()
        for thread in threads:
            thread.join()
    with service(database) as running:
        for thread in storm(running, total):
            thread.join()
        status, _ = running.request("POST", "/v1/plans", changed, {"Idempotency-Key": "same"})
    jobs = rows_of(database, "SELECT count(*) FROM jobs")[0][0]
    return [
        Row("J6", f"jobs of {2 * total} submissions with one key, a kill between", str(jobs), "1", jobs == 1 and len(identifiers) == 1),
        Row("J6", "status of another body under the same key", str(status), "422", status == 422),
    ]


@gate("J7")
def cancel_frees_the_core(scale):
    database, random_state = scale.database("j7"), random.Random(7)
    ends, freed, wrong = [], [], 0
    with service(database) as running:
        for number in range(scale.of(500, 10)):
            job = running.submit(long_running(number))
            after = running.submit(variant(0))
            running.wait(job, lambda job: job["state"] == "running")
            time.sleep(random_state.uniform(0.0, 0.3))
            asked = time.time_ns() // 1000
            running.request("POST", f"/v1/plans/{job}/cancel")
            wrong += running.wait_end(job)["state"] != "cancelled"
            running.wait_end(after)
            (end,) = rows_of(database, "SELECT finished_us FROM jobs WHERE id = ?", job)[0]
            (start,) = rows_of(database, "SELECT started_us FROM jobs WHERE id = ?", after)[0]
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


def races(scale):
    """Cancel against finish: one final state, one final event, a plan only if it was not cancelled."""
    database, random_state = scale.database("j7-races"), random.Random(8)
    wrong, count, states = 0, scale.of(1000, 20), {}
    with service(database) as running:
        running.wait_end(running.submit(variant(0)))
        for _ in range(count):
            job = running.submit(variant(0))
            time.sleep(random_state.uniform(0.0, 0.08))
            running.request("POST", f"/v1/plans/{job}/cancel")
            state = running.wait_end(job)["state"]
            states[state] = states.get(state, 0) + 1
            results = rows_of(database, "SELECT count(*) FROM results r JOIN jobs j ON r.job = j.sequence WHERE j.id = ?", job)[0][0]
            finals = rows_of(
                database,
                "SELECT count(*) FROM events e JOIN jobs j ON e.job = j.sequence WHERE j.id = ? AND e.kind = 'state' "
                "AND json_extract(e.data, '$.state') NOT IN ('queued', 'running')",
                job,
            )[0][0]
            wrong += finals != 1 or results != (0 if state == "cancelled" else 1)
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
        running.process.send_signal(signal.SIGTERM)
        time.sleep(0.1)
        try:
            status, _ = running.request("GET", "/health/ready")
        except OSError:
            status = 0
        code = running.process.wait(60)
        took = time.monotonic() - begin
        for stream in streams:
            stream.join()
    closed = sum("event: closing" in text for text in told)
    states = rows_of(database, "SELECT state, attempt FROM jobs ORDER BY sequence")
    rows.append(Row("J8", "ready 100 ms after SIGTERM (0: refuses connections)", str(status), "not 200", status != 200))
    rows.append(Row("J8", "streams that ended with a last event, of 50", str(closed), "50", closed == 50))
    rows.append(Row("J8", "exit code", str(code), "0", code == 0))
    rows.append(Row("J8", "SIGTERM until the exit", f"{took:.1f} s", "25 s", took <= 25.0))
    rows.append(Row("J8", "interrupted job: state and attempts", str(states[0]), "queued, 0", states[0] == ("queued", 0)))
    with service(database) as running:
        running.wait(job, lambda job: job["state"] == "running")
        for _ in range(5):
            running.process.send_signal(signal.SIGTERM)
        took, code = timed(lambda: running.process.wait(60))
    harmless = sound(database) and rows_of(database, "SELECT count(*) FROM jobs")[0][0] == 2
    rows.append(Row("J8", f"five SIGTERM: exit code {code}, nothing lost, after", f"{took:.2f} s", "1 s", took <= 1.0 and harmless))
    return rows


@gate("J11")
def a_one_shot_job_writes_everything_or_nothing(scale):
    """`slewplan solve` killed and terminated at random moments: the output is never a part."""
    random_state, torn, codes = random.Random(11), 0, {}
    output = scale.work / "j11.json"
    scenario = scale.work / "j11-scenario.json"
    import json

    scenario.write_text(json.dumps(fixture("olivares-a")))
    for number in range(scale.of(100, 8)):
        output.unlink(missing_ok=True)
        process = subprocess.Popen([binary(), "solve", scenario, "-o", output, "--progress", "none"], stderr=subprocess.DEVNULL)
        time.sleep(random_state.uniform(0.0, 1.5))
        process.send_signal(signal.SIGKILL if number % 2 else signal.SIGTERM)
        code = process.wait(60)
        codes[code] = codes.get(code, 0) + 1
        whole = None
        if output.exists():
            try:
                whole = json.loads(output.read_text())["verification"]["passed"]
            except (ValueError, KeyError):
                whole = False
        torn += whole is False or (code in (0, 4)) != (whole is True and code != -9) and code != -9
    allowed = set(codes) <= {0, 4, 143, -9, -15}
    text = ", ".join(f"{code}: {count}" for code, count in sorted(codes.items()))
    return [Row("J11", f"torn or missing outputs (exit codes {text})", str(torn), "0", torn == 0 and allowed)]


def record(database, job):
    """Everything that is stored of a job."""
    tables = ["SELECT * FROM jobs WHERE id = ?"]
    tables += [
        f"SELECT t.* FROM {name} t JOIN jobs j ON t.job = j.sequence WHERE j.id = ? ORDER BY t.rowid"
        for name in ("incumbents", "results", "segments")
    ]
    tables.append("SELECT e.* FROM events e JOIN jobs j ON e.job = j.sequence WHERE j.id = ? ORDER BY e.id")
    return [rows_of(database, query, job) for query in tables]


def worker_that_slept(scale):
    """A worker is stopped in the middle of a solve, another one takes its job, and it goes on: whether it
    wrote nothing more, how long until it took the next job, and how often it was tried."""
    database, random_state = scale.database("j3"), random.Random(3)
    untouched, waits, rounds = 0, [], scale.of(10, 1)
    with service(database) as running:
        for number in range(rounds):
            job = running.submit(long_running(number))
            running.wait(job, lambda job: job["stage"] == "search")
            time.sleep(random_state.uniform(0.0, 1.0))
            after = running.submit(variant(number))
            connection = sqlite3.connect(database, timeout=10.0, isolation_level=None)
            # Nobody is stopped while he writes: that would be a lock that is never given back.
            connection.execute("BEGIN IMMEDIATE")
            running.process.send_signal(signal.SIGSTOP)
            connection.execute(
                "UPDATE jobs SET fence = fence + 1, attempt = attempt + 1, boot_id = 'another' WHERE id = ?", (job,)
            )
            connection.execute("COMMIT")
            connection.close()
            before = record(database, job)
            begin = time.monotonic()
            running.process.send_signal(signal.SIGCONT)
            running.wait_end(after)
            waits.append(time.monotonic() - begin)
            untouched += record(database, job) == before
            running.request("DELETE", f"/v1/plans/{job}")
    return untouched, max(waits), rounds


@gate("J3")
def one_end_per_job(scale):
    """Two processes that both take themselves for the owner of a job end it at the same time; and one that
    has lost its job without having noticed."""
    count = scale.of(1000, 40)
    told = unit_test("a_job_that_two_workers_end_has_one_end", SLEWPLAN_RACES=count)
    won = re.search(r"(\d+) races, (\d+) won by the rescuer", told)
    measured = f"{won[2]} rescued" if won else "failed"
    holds = bool(won) and int(won[1]) == count and 0 < int(won[2]) < count
    untouched, wait, rounds = worker_that_slept(scale)
    return [
        Row("J3", f"races with other than one end, of {count} ({measured})", "0" if won else "some", "0", holds),
        Row("J3", f"jobs to which a worker wrote that had lost them, of {rounds}", str(rounds - untouched), "0", untouched == rounds),
        Row("J3", "until it does the next job, slowest", f"{wait:.1f} s", "15 s", wait <= 15.0, timed=True),
    ]


@gate("H9")
def nothing_that_is_read_panics(scale):
    """Documents that are almost right, through decoder, validator and verifier."""
    rows = []
    for name, test in (("scenarios", "scenarios_that_are_almost_right"), ("plans", "plans_that_are_almost_right")):
        count = scale.of(20_000, 300)
        told = unit_test(test, SLEWPLAN_MUTATIONS=count)
        found = re.search(name + r": (\d+) documents, (\d+) taken, slowest ([\d.]+) ms", told)
        rows.append(Row("H9", f"{name} that caused a panic, of {count}", "0" if found else "some", "0", bool(found)))
        slowest = float(found[3]) if found else math.inf
        rows.append(Row("H9", f"slowest of them ({found[2] if found else 0} taken)", f"{slowest:.0f} ms", "1000 ms", slowest <= 1000.0, timed=True))
    return rows
