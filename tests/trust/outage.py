"""Promises about a Postgres that is away, hangs, only reads, lets nobody in, or has a newer schema."""

import os
import signal
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

from harness import Postgres, Row, binary, gate, long_running, service, until, variant
from systems import ServerDatabase

# Longer than a claim, s: nobody may take the running job for abandoned because nobody could prolong it.
OUTAGE_S = 12.0
# Longest wait for a connection to the server, s, and what a busy machine adds.
REFUSED_S = 5.0 + 1.0


@dataclass
class Outage:
    """How it begins and ends, and what is still answered then."""

    name: str
    begin: Callable
    end: Callable
    read: int = 503


def settings(server, *changes):
    """Changes settings of a running server."""
    server.execute("postgres", *changes, "SELECT pg_reload_conf()")


def processes_of(server):
    """The server with all that it has started."""
    main = int((Path(server.folder) / "data" / "postmaster.pid").read_text().split()[0])
    children = Path(f"/proc/{main}/task/{main}/children").read_text().split()
    return [main, *map(int, children)]


def outages(server, database):
    """All of them."""

    def all_processes(which):
        for pid in processes_of(server):
            os.kill(pid, which)

    def let_in(whether):
        server.execute("postgres", f"ALTER DATABASE {database.name} ALLOW_CONNECTIONS {whether}")

    def nobody():
        let_in("false")
        database.end_connections()

    return [
        Outage("ended", server.kill, server.start),
        Outage("that hangs", lambda: all_processes(signal.SIGSTOP), lambda: all_processes(signal.SIGCONT)),
        Outage(
            "that only reads",
            lambda: settings(server, "ALTER SYSTEM SET default_transaction_read_only = on"),
            lambda: settings(server, "SET default_transaction_read_only = off", "ALTER SYSTEM RESET default_transaction_read_only"),
            read=200,
        ),
        Outage("that lets nobody in", nobody, lambda: let_in("true")),
    ]


def told(running, job):
    """What every process answers: by request status, code, whether it says when to come back, and seconds."""

    def ask(one, method, path, body=None):
        begin = time.monotonic()
        status, headers, document = one.exchange(method, path, body)
        code = document.get("code") if isinstance(document, dict) else None
        return status, code, "Retry-After" in headers, time.monotonic() - begin

    with ThreadPoolExecutor(max_workers=20) as asking:
        submit = [asking.submit(ask, one, "POST", "/v1/plans", variant(0)) for one in running.services]
        read = [asking.submit(ask, one, "GET", f"/v1/plans/{job}") for one in running.services]
        ready = [asking.submit(ask, one, "GET", "/health/ready") for one in running.processes]
        live = [asking.submit(ask, one, "GET", "/health/live") for one in running.processes]
    kinds = {"submit": submit, "read": read, "ready": ready, "live": live}
    return {kind: [one.result() for one in answers] for kind, answers in kinds.items()}


def survived(running, job, outage):
    """The rows of an outage, while a job runs."""
    outage.begin()
    try:
        begin = time.monotonic()
        # Positive answers of before are given for a second.
        time.sleep(1.5)
        answers = told(running, job)
        time.sleep(max(0.0, OUTAGE_S - (time.monotonic() - begin)))
    finally:
        outage.end()
    begin = time.monotonic()
    until(lambda: running.request("POST", "/v1/plans", variant(0))[0] == 202, 30.0)
    back = time.monotonic() - begin
    healthy = until(lambda: all(one.request("GET", "/health/ready")[0] == 200 for one in running.processes), 30.0)
    attempts = attempt(running, job)
    statuses = {kind: {status for status, *_ in given} for kind, given in answers.items()}
    expected = {"submit": {503}, "read": {outage.read}, "ready": {503}, "live": {200}}
    refused = [one for given in answers.values() for one in given if one[0] != 200]
    unnamed = [code for _, code, later, _ in refused if code not in ("database_unavailable", "not_ready", "busy") or not later]
    slowest = max(seconds for *_, seconds in refused)
    shown = " ".join("/".join(map(str, sorted(found))) for found in statuses.values())
    wanted = " ".join(str(*one) for one in expected.values())
    return [
        Row("P2", f"server {outage.name}: submit, read, readiness, liveness of all", shown, wanted, statuses == expected),
        Row("P2", "  refusals without a code of it or without Retry-After", str(len(unnamed)), "0", not unnamed),
        Row("P2", "  slowest refusal", f"{slowest:.1f} s", f"{REFUSED_S:.0f} s", slowest <= REFUSED_S, timed=True),
        Row("P2", "  submissions are taken again after", f"{back:.1f} s", "5 s", back <= 5.0 and healthy is not None, timed=True),
        Row("P2", f"  job that ran through {OUTAGE_S:.0f} s of it: attempts", str(attempts), "1", attempts == 1),
    ]


def attempt(running, job):
    """How often it was begun, once every process had the time to look for expired claims."""
    time.sleep(6.0)
    return running.wait(job, lambda job: job["state"] == "running")["attempt"]


def newer_schema(running, database):
    """Processes of before go on, and others say why they do not start."""
    database.server.execute(
        database.name,
        "INSERT INTO _sqlx_migrations SELECT 9999, 'newer', installed_on, success, checksum, execution_time "
        "FROM _sqlx_migrations ORDER BY version LIMIT 1",
    )
    state = running.wait_end(running.submit(variant(1)))["state"]
    codes, said = [], 0
    for command in (["serve", "--listen", "127.0.0.1:0", "--no-worker"], ["work"]):
        done = subprocess.run([binary(), *command, "--database", str(database)], capture_output=True, text=True, timeout=60)
        codes.append(done.returncode)
        said += "newer version of slewplan" in done.stderr and "9999" in done.stderr
    return [
        Row("P2", "newer schema: a job with the processes of before", state, "succeeded", state == "succeeded"),
        Row("P2", f"  others that do not start and say why, of 2 (exit codes {codes})", str(said), "2", said == 2 and codes == [1, 1]),
    ]


@gate("P2")
def outages_are_told(scale):
    """What services and workers answer while the server cannot be used, and what becomes of a job."""
    if not scale.shared:
        return [Row("P2", "several processes on a Postgres: --database postgres", "-", "-", None)]
    rows = []
    with Postgres() as server:
        database = ServerDatabase(server, scale.work / "p2")
        with service(database) as running:
            job = running.submit(long_running())
            running.wait(job, lambda job: job["state"] == "running")
            for outage in outages(server, database)[: scale.of(None, 1)]:
                rows += survived(running, job, outage)
            rows += newer_schema(running, database)
            running.request("POST", f"/v1/plans/{job}/stop")
            end = running.wait_end(job)
            verified = running.request("GET", f"/v1/plans/{job}/result")[1]["verification"]["passed"]
            rows.append(Row("P2", "the job of all of it, stopped in the end", end["state"], "stopped", end["state"] == "stopped" and verified))
    return rows
