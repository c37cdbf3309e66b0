"""Promises about jobs."""

import math
import random
import re
import signal
import subprocess
import threading
import time

from harness import (
    Row,
    binary,
    fixture,
    gate,
    long_running,
    service,
    unit_test,
    variant,
)


@gate("J1")
def acknowledged_jobs_survive(scale):
    """Kills at random times under submissions; every acknowledged job is there after each."""
    kills, random_state = scale.rounds(200, 5), random.Random(1)
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
        unsound += not database.sound()
    stored = {identifier for (identifier,) in database.rows("SELECT id FROM jobs")}
    lost = len(acknowledged - stored)
    return [
        Row("J1", f"jobs lost, of {len(acknowledged)} acknowledged, {kills} kills", str(lost), "0", lost == 0 and len(acknowledged) > kills),
        Row("J1", "databases that find themselves damaged", str(unsound), "0", unsound == 0),
    ]


@gate("J2")
def orphans_are_found_at_once(scale):
    """A process is killed that solves a job: on a file the next one takes the job as it starts, on a server
    another one when the claim has expired."""
    database, waits = scale.database("j2"), []
    goal = 15.0 if scale.shared else 1.0
    with service(database) as running:
        for number in range(scale.rounds(20, 1 if scale.shared else 2)):
            job = running.submit(long_running(number))
            running.wait(job, lambda job: job["state"] == "running")
            solver = running.solver_of(job)
            solver.kill()
            begin = time.monotonic()
            running.restart(running.processes.index(solver))
            running.wait(job, lambda job: job["attempt"] == 2)
            waits.append(time.monotonic() - begin)
            running.request("DELETE", f"/v1/plans/{job}")
    worst = max(waits)
    return [Row("J2", f"kill until the job runs again, slowest of {len(waits)}", f"{worst:.2f} s", f"{goal:.0f} s", worst <= goal, timed=True)]


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
    [(jobs,)] = database.rows("SELECT count(*) FROM jobs")
    return [
        Row("J6", f"jobs of {2 * total} submissions with one key, a kill between", str(jobs), "1", jobs == 1 and len(identifiers) == 1),
        Row("J6", "status of another body under the same key", str(status), "422", status == 422),
    ]


@gate("J11", of_a_file="a command without a database")
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
        f"SELECT t.* FROM {name} t JOIN jobs j ON t.job = j.sequence WHERE j.id = ?"
        for name in ("incumbents", "results", "segments", "events")
    ]
    return [sorted(database.rows(query, job), key=repr) for query in tables]


def worker_that_slept(scale):
    """A worker is stopped in the middle of a solve, another one takes its job, and it goes on: whether it
    wrote nothing more, how long until it took the next job, and how often it was tried."""
    database, random_state = scale.database("j3"), random.Random(3)
    untouched, waits, rounds = 0, [], scale.rounds(10, 1)
    with service(database, "--jobs", "1", workers=1) as running:
        for number in range(rounds):
            job = running.submit(long_running(number))
            running.wait(job, lambda job: job["stage"] == "search", 600.0)
            time.sleep(random_state.uniform(0.0, 1.0))
            after = running.submit(variant(number))
            worker = running.solver_of(job)
            # Nobody is stopped while he writes: that would be a lock that is not given back in time.
            with database.alone() as execute:
                worker.process.send_signal(signal.SIGSTOP)
                execute(
                    "UPDATE jobs SET fence = fence + 1, attempt = attempt + 1, boot_id = 'another', "
                    "lease_until_us = lease_until_us + 3600000000 WHERE id = ?",
                    (job,),
                )
            before = record(database, job)
            begin = time.monotonic()
            worker.process.send_signal(signal.SIGCONT)
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
    # On a file first, then on a server.
    races = re.findall(r"(\d+) races, (\d+) won by the rescuer", told)[scale.shared :]
    won = [int(won) for told, won in races[:1] if int(told) == count]
    measured = f"{won[0]} rescued" if won else "failed"
    holds = bool(won) and 0 < won[0] < count
    untouched, wait, rounds = worker_that_slept(scale)
    return [
        Row("J3", f"races with other than one end, of {count} ({measured})", "0" if won else "some", "0", holds),
        Row("J3", f"jobs to which a worker wrote that had lost them, of {rounds}", str(rounds - untouched), "0", untouched == rounds),
        Row("J3", "until it does the next job, slowest", f"{wait:.1f} s", "15 s", wait <= 15.0, timed=True),
    ]


@gate("H9", of_a_file="documents, before any database")
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
