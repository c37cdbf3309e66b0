#!/usr/bin/env python3
"""Several services and workers on one Postgres: what they promise, and what they ask of it.

Starts a Postgres, two services without a worker and some workers. Tiny jobs go in through both; every one
must be solved once. Then jobs are stopped through the service that did not take them, while events are
followed there. Last, everything is idle. Statements are counted in the log of the server.
"""

import calendar
import http.client
import json
import re
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path

from service import FINAL, ROOT, Service, Table, binary, fixture, percentile

IDLE_S = 20.0
STOPS = 20
GOAL_STOP_MS, GOAL_EVENT_MS = 500.0, 250.0
EXECUTED = re.compile(r"LOG:  (?:execute [^:]*|statement): +(.*)")


class Postgres:
    """A server of its own, which ends with this process."""

    def __init__(self):
        script = [str(ROOT / "tests" / "postgres.sh"), "-c", "log_statement=all", "-c", "max_connections=400"]
        self.script = subprocess.Popen(script, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.folder = self.script.stdout.readline().strip()
        if not self.folder:
            raise RuntimeError("Postgres is not installed")
        self.url = f"postgres://slewplan@localhost/postgres?host={self.folder}"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.script.stdin.close()
        self.script.wait(30)

    def statements(self):
        """All that were executed so far, in order."""
        lines = (Path(self.folder) / "server.log").read_text(errors="replace").splitlines()
        return [found.group(1) for line in lines if (found := EXECUTED.search(line))]


class Worker:
    """`slewplan work` with one thread."""

    def __init__(self, url):
        command = [binary(), "work", "--log", "error", "--threads", "1", "--database", url]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        if "working on" not in self.process.stdout.readline():
            raise RuntimeError("the worker did not start")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(30)


def kind(statement):
    """What a statement is counted as: its verb and its table."""
    words = statement.replace("(", " ").split()
    verb = words[0].upper()
    names = {"INSERT": "INTO", "UPDATE": "UPDATE", "DELETE": "FROM", "SELECT": "FROM"}
    if "pg_notify" in statement:
        return "NOTIFY"
    if "pg_advisory" in statement:
        return "SELECT lock"
    after = names.get(verb)
    if after in words and words.index(after) + 1 < len(words):
        return f"{verb} {words[words.index(after) + 1]}"
    return verb


def tiny_jobs(services, count):
    """Submits jobs through all services at once; the jobs as they ended, and the seconds it took."""
    identifiers, begin = [], time.monotonic()

    def submit(service, share):
        for _ in range(share):
            identifiers.append(service.submit(fixture("two-targets")))

    threads = [
        threading.Thread(target=submit, args=(services[number % len(services)], count // 4)) for number in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    submitted = time.monotonic() - begin
    ended = [services[0].wait_end(identifier, 300.0) for identifier in identifiers]
    return ended, submitted, time.monotonic() - begin


def follow(service, identifier, arrivals):
    """Reads the events of a job, and notes for how long each was on its way."""
    connection = http.client.HTTPConnection(service.host, service.port, timeout=120)
    connection.request("GET", f"/v1/plans/{identifier}/events")
    answer = connection.getresponse()
    for line in answer:
        if line.startswith(b"data: "):
            at = json.loads(line[6:])["at"]
            whole, _, part = at.removesuffix("Z").partition(".")
            stamp = time.strptime(whole, "%Y-%m-%dT%H:%M:%S")
            told = calendar.timegm(stamp) + float(f"0.{part or 0}")
            arrivals.append(1e3 * (time.time() - told))
    connection.close()


def stopped(services, number):
    """Milliseconds of a stop through the other service, and of the events on their way."""
    taking, other = services[number % 2], services[1 - number % 2]
    scenario = fixture("olivares-c")
    for target in scenario["targets"]:
        target["attitude"]["roll_pitch_yaw_deg"][1] += 0.01 * (number + 1)
    identifier = taking.submit(scenario)
    taking.wait(identifier, lambda job: job["state"] == "running")
    arrivals = []
    following = threading.Thread(target=follow, args=(other, identifier, arrivals))
    following.start()
    taking.wait(identifier, lambda job: job["incumbent_s"] is not None or job["state"] in FINAL)
    begin = time.monotonic()
    other.request("POST", f"/v1/plans/{identifier}/stop")
    other.wait_end(identifier)
    took = 1e3 * (time.monotonic() - begin)
    following.join(30)
    # The first ones were there before the stream.
    return took, arrivals[2:]


def main(jobs, workers):
    table = Table()
    with Postgres() as postgres:
        services = [Service(postgres.url, "--no-worker", "--log", "error") for _ in range(2)]
        crew = [Worker(postgres.url) for _ in range(workers)]
        # Legs are solved once, before anything is measured.
        services[0].wait_end(services[0].submit(fixture("two-targets")))
        before = len(postgres.statements())
        ended, submitted, took = tiny_jobs(services, jobs)
        during = Counter(map(kind, postgres.statements()[before:]))
        good = sum(job["state"] == "succeeded" and job["attempt"] == 1 for job in ended)
        table.row("tiny jobs solved, each once", str(good), str(len(ended)), good == len(ended))
        table.row("accepted a second", f"{len(ended) / submitted:.0f}", "", True)
        table.row("solved a second", f"{len(ended) / took:.0f}", "", True)
        results = [stopped(services, number) for number in range(STOPS)]
        slowest = percentile([took for took, _ in results], 0.99)
        table.timed("stop through another process, p99", f"{slowest:.0f} ms", f"{GOAL_STOP_MS:.0f} ms", slowest < GOAL_STOP_MS)
        arrivals = [late for _, late in results for late in late]
        slowest = percentile(arrivals, 0.99)
        table.timed(f"event at another process, p99 of {len(arrivals)}", f"{slowest:.0f} ms", f"{GOAL_EVENT_MS:.0f} ms", slowest < GOAL_EVENT_MS)
        before = len(postgres.statements())
        time.sleep(IDLE_S)
        idle = Counter(map(kind, postgres.statements()[before:]))
        rate = sum(idle.values()) / IDLE_S / (workers + len(services))
        table.row("idle statements of a process a second", f"{rate:.2f}", "", True)
        for process in crew:
            process.__exit__()
        for service in services:
            service.__exit__()
    for name, counts, share in [("tiny job", during, len(ended)), ("idle process and minute", idle, (workers + len(services)) * IDLE_S / 60)]:
        print(f"\nstatements of a {name}: {sum(counts.values()) / share:.1f}")
        for what, count in counts.most_common():
            print(f"  {count / share:8.2f}  {what}")
    table.exit()


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else 400,
        int(sys.argv[2]) if len(sys.argv) > 2 else 3,
    )
