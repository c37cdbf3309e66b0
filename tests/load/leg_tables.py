#!/usr/bin/env python3
"""Tables of leg times: how fast cached ones are answered, what a certified one takes, and what `kill -9`
costs one that is being made.

    python3 tests/load/leg_tables.py [LARGE [CERTIFIED [KILLED]]]

The numbers of attitudes are 300, 1000 and 100 by default. The cached table of LARGE attitudes is made by a
job first, which solves every leg.
"""

import http.client
import json
import re
import sys
import tempfile
import threading
import time
from pathlib import Path

from service import Service, Table, fixture

SMALL = 100
# Legs that may be lost with a killed process: what it solves between two commits.
IN_FLIGHT = 100


def matrix(count, **more):
    """A query for the full matrix of attitudes spread over all rotations."""

    def attitude(number):
        return {"roll_pitch_yaw_deg": [number * 137.508 % 360, number * 73.1 % 160 - 80, number * 31.7 % 360]}

    return {"spacecraft": fixture("two-targets")["spacecraft"], "attitudes": list(map(attitude, range(count))), **more}


def streamed(service, query, accept):
    """Seconds and bytes of an answer, read piece by piece."""
    connection = http.client.HTTPConnection(service.host, service.port, timeout=600)
    headers = {"Content-Type": "application/json", "Accept": accept}
    begin, size, lines = time.monotonic(), 0, 0
    connection.request("POST", "/v1/legs/query", json.dumps(query), headers)
    answer = connection.getresponse()
    assert answer.status == 200, answer.read()
    while piece := answer.read(1 << 16):
        size += len(piece)
        lines += piece.count(b"\n")
    connection.close()
    return time.monotonic() - begin, size, lines


def made(service, query, patience=3600):
    """A table of a job that has ended."""
    status, job = service.request("POST", "/v1/leg-tables", query)
    assert status == 202, job
    return ended(service, job["id"], patience)


def ended(service, identifier, patience=3600, until=None):
    end = time.monotonic() + patience
    while time.monotonic() < end:
        job = service.request("GET", f"/v1/leg-tables/{identifier}")[1]
        if job["state"] not in ("queued", "running") or (until and until(job)):
            return job
        time.sleep(0.02)
    raise RuntimeError(f"the table {identifier} is not done after {patience} s")


class Peak:
    """The largest resident memory of a process while this runs, beyond that at its begin, MB."""

    def __init__(self, process):
        self.path = Path(f"/proc/{process.pid}/status")
        self.begin = self.peak = self.now()
        self.over = threading.Event()
        self.thread = threading.Thread(target=self.watch)

    def now(self):
        return int(re.search(r"VmRSS:\s+(\d+)", self.path.read_text())[1]) / 1e3

    def watch(self):
        while not self.over.wait(0.02):
            self.peak = max(self.peak, self.now())

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.over.set()
        self.thread.join()


def solved(service):
    """Number of legs that the process has solved."""
    text = service.request("GET", "/metrics")[1].decode()
    return int(re.search(r"slewplan_legs_solved_total (\d+)", text)[1])


def stored(service):
    """Number of cached legs."""
    text = service.request("GET", "/metrics")[1].decode()
    return int(re.search(r"slewplan_cached_legs (\d+)", text)[1])


def cached(table, folder, large):
    with Service(folder / "cached.db", "--log", "warn") as service:
        for count in sorted({min(SMALL, large), large}):
            job = made(service, matrix(count))
            legs = count * (count - 1)
            print(f"{count} attitudes: {job['computed']} legs solved, {job['solved_s']:.1f} s")
            for accept in ("application/json", "application/x-ndjson", "text/csv"):
                query = matrix(count, mode="cached_only")
                seconds = min(streamed(service, query, accept)[0] for _ in range(3))
                what = f"{count} x {count} cached, {accept.split('/')[1]}"
                if count == SMALL:
                    table.timed(what, f"{1e3 * seconds:.0f} ms", "150 ms", seconds <= 0.15)
                else:
                    rate = legs / seconds
                    table.timed(what, f"{rate:,.0f} legs/s", "100,000", rate >= 1e5)


def certified(table, folder, count):
    with Service(folder / "certified.db", "--log", "warn") as service, Peak(service.process) as memory:
        query = matrix(count, mode="compute", kind="certified")
        seconds, size, lines = streamed(service, query, "application/x-ndjson")
    complete = lines == count * (count - 1)
    table.row(f"{count} x {count} certified: rows, {size / 1e6:.0f} MB", str(lines), "all", complete)
    table.timed("the same: time", f"{seconds:.1f} s", "30 s", seconds <= 30)
    table.row("the same: memory of the service", f"{memory.peak:.0f} MB", "200 MB", memory.peak <= 200)


def killed(table, folder, count):
    database = folder / "killed.db"
    query, legs = matrix(count), count * (count - 1)
    with Service(database, "--log", "warn") as service:
        job = service.request("POST", "/v1/leg-tables", query)[1]
        half = ended(service, job["id"], until=lambda job: job["done"] >= legs // 2)
        assert half["state"] == "running", half
        before = solved(service)
        service.kill()
    with Service(database, "--log", "warn") as service:
        # The job begins again at once: nothing is solved before the legs that are stored are known.
        job = ended(service, job["id"])
        status, _ = service.request("GET", f"/v1/leg-tables/{job['id']}/result?format=csv")
        after, distinct = solved(service), stored(service)
    print(f"{distinct} different legs: {before} solved before the kill, {after} after it")
    table.row("the job goes on to its end", f"{job['done']} of {legs}", "all", job["done"] == legs)
    table.row("its table can be read", str(status), "200", status == 200)
    # Those that were solved but not yet stored, some hundredths of a second of work.
    twice = before + after - distinct
    table.row("legs solved twice", str(twice), f"{IN_FLIGHT}", twice <= IN_FLIGHT)


def main(large=300, many=1000, half=100):
    table = Table()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        cached(table, folder, large)
        certified(table, folder, many)
        killed(table, folder, half)
    table.exit()


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
