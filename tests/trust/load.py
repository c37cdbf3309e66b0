"""Promises about throughput, start-up and overload."""

import json
import random
import statistics
import subprocess
import time

from harness import Row, example, fixture, gate, long_running, service


def load(running, mode, amount, seconds, path, body=None, scale=None):
    host, port = running.address
    command = [example("load"), f"{host}:{port}", mode, str(amount), str(seconds), path]
    if body is not None:
        file = scale.work / "body.json"
        file.write_text(json.dumps(body))
        command.append(file)
    return json.loads(subprocess.run(command, capture_output=True, check=True).stdout)


def stored_plan(running):
    job = running.submit(fixture("two-targets"))
    running.wait_end(job)
    return f"/v1/plans/{job}/result"


def only(result, *allowed):
    return set(result["statuses"]) <= {str(status) for status in allowed}


@gate("L1")
def reads_are_fast(scale):
    seconds = scale.of(10, 2)
    with service(scale.database("l1")) as running:
        path = stored_plan(running)
        runs = [load(running, "closed", 32, seconds, path) for _ in range(scale.of(3, 1))]
        paced = load(running, "open", 1000, seconds, path)
    rate = statistics.median(run["per_second"] for run in runs)
    clean = all(only(run, 200) for run in [*runs, paced])
    p99, p999 = paced["accepted_ms"]["p99"], paced["accepted_ms"]["p999"]
    return [
        Row("L1", "stored plans read per second, 32 clients", f"{rate:.0f}", "4000", rate >= 4000 and clean, timed=True),
        Row("L1", "at 1000/s: p99", f"{p99:.1f} ms", "15 ms", p99 <= 15, timed=True),
        Row("L1", "at 1000/s: p999", f"{p999:.1f} ms", "50 ms", p999 <= 50, timed=True),
    ]


@gate("L2")
def submissions_are_fast(scale):
    seconds, body = scale.of(10, 2), fixture("two-targets")
    with service(scale.database("l2"), "--queue-limit", "1000000") as running:
        # The solver is busy meanwhile.
        running.submit(long_running())
        runs, paced = (
            [load(running, mode, amount, seconds, "/v1/plans", body, scale) for _ in range(scale.of(3, 1))]
            for mode, amount in (("closed", 8), ("open", 50))
        )
    rate = statistics.median(run["per_second"] for run in runs)
    p99 = max(run["accepted_ms"]["p99"] for run in runs)
    clean = all(only(run, 202) for run in [*runs, *paced])
    # Of one run a single slow sync of the disk is the hundredth part.
    calm = statistics.median(run["accepted_ms"]["p99"] for run in paced)
    return [
        Row("L2", "durable submissions per second, 8 clients, solver busy", f"{rate:.0f}", "300", rate >= 300 and clean, timed=True),
        Row("L2", "p99", f"{p99:.0f} ms", "100 ms", p99 <= 100, timed=True),
        Row("L2", "at 50/s, solver busy: p99", f"{calm:.0f} ms", "60 ms", calm <= 60, timed=True),
    ]


def filled(database, jobs, legs):
    """Copies a job and a leg as often as it is said."""
    job_columns = "state, name, scenario, targets, submitted_us, started_us, finished_us"
    leg_columns = ", ".join(name for name in database.columns("legs") if name not in ("sequence", "key"))
    with database.alone() as execute:
        for count, table, key, columns in ((jobs, "jobs", "id", job_columns), (legs, "legs", "key", leg_columns)):
            execute(
                f"WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < {count}) "
                f"INSERT INTO {table} ({key}, {columns}) "
                f"SELECT 'copy-' || i, {columns} FROM n, (SELECT * FROM {table} LIMIT 1) AS one"
            )


@gate("L3")
def starts_at_once(scale):
    """With many jobs and legs, and after a kill with a long write-ahead log: of a server too."""
    database, jobs, legs = scale.database("l3"), scale.of(100_000, 5_000), scale.of(1_000_000, 20_000)
    with service(database) as running:
        stored_plan(running)
    filled(database, jobs, legs)

    def start():
        begin = time.monotonic()
        database.recover()
        running = service(database, "--queue-limit", "1000000")
        while any(one.request("GET", "/health/ready")[0] != 200 for one in running.services):
            time.sleep(0.005)
        return time.monotonic() - begin, running

    cold, running = start()
    big, state = fixture("two-targets"), random.Random(3)
    with database.long_log():
        while database.log_bytes() < scale.of(64, 8) << 20:
            big["name"] = state.randbytes(500_000).hex()
            running.submit(big)
        running.kill()
        size = database.log_bytes() / 2**20
        database.crash()
    running.__exit__()
    after, running = start()
    running.kill()
    running.__exit__()
    return [
        Row("L3", f"start until ready, {jobs} jobs and {legs} legs", f"{cold:.2f} s", "1 s", cold <= 1.0, timed=True),
        Row("L3", f"the same after SIGKILL with a log of {size:.0f} MB", f"{after:.2f} s", "3 s", after <= 3.0, timed=True),
    ]


@gate("H3")
def overload_is_refused_politely(scale):
    """Five times what the service can take, with a short queue."""
    seconds, body = scale.of(20, 3), fixture("two-targets")
    database = scale.database("h3")
    with service(database, "--queue-limit", "50") as running:
        calm = load(running, "open", 20, seconds / 2, "/v1/plans", body, scale)
        first = running.submit(long_running())
        running.wait(first, lambda job: job["state"] == "running")
        for number in range(80):
            running.request("POST", "/v1/plans", long_running(number + 1))
        [(waiting,)] = database.rows("SELECT count(*) FROM jobs WHERE state = 'queued'")
        flood = load(running, "open", 1500, seconds, "/v1/plans", body, scale)
        live = load(running, "open", 50, 2, "/health/live")
        cancelled = running.request("GET", "/v1/plans?state=queued&limit=100")[1]["plans"]
        for job in cancelled:
            running.request("DELETE", f"/v1/plans/{job['id']}")
    with service(scale.database("h3-zero"), "--queue-limit", "0") as running:
        zero = running.request("POST", "/v1/plans", body)[0]
    other = sum(count for status, count in flood["statuses"].items() if status not in ("202", "429", "503"))
    total = sum(flood["statuses"].values())
    refusal = flood["refused_ms"]["p99"]
    return [
        Row("H3", f"answers other than 202, 429 and 503, of {total}", str(other), "1 %", other <= 0.01 * total),
        Row("H3", "refusals without Retry-After", str(flood["impolite"]), "0", flood["impolite"] == 0 and total > 0),
        Row("H3", "refusal, p99", f"{refusal:.0f} ms", "20 ms", refusal <= 20, timed=True),
        Row("H3", "jobs waiting at the limit of 50", str(waiting), "50", waiting == 50),
        Row("H3", "liveness meanwhile, p99", f"{live['accepted_ms']['p99']:.0f} ms", "50 ms", live["accepted_ms"]["p99"] <= 50, timed=True),
        Row("H3", "queue of length 0", str(zero), "503", zero == 503),
        Row("H3", "submissions before the flood, p99", f"{calm['accepted_ms']['p99']:.0f} ms", "-", None),
    ]
