#!/usr/bin/env python3
"""Twenty scenarios at once with 64 readers: in order, each once, and nobody waits long.

Readers ask for the state of random jobs at a fixed rate each; the time counts from the moment
when a request was due, so that a stalled service is seen.
"""

import asyncio
import random
import sys
import tempfile
import time
from pathlib import Path

from service import FINAL, Service, Table, fixture, percentile

JOBS = 20
READERS = 64
PAUSE_S = 0.25
GOAL_P99_MS = 50.0


async def read_until(service, identifiers, done, seed):
    """Latencies, s, and errors of one reader."""
    random_state = random.Random(seed)
    reader, writer = await asyncio.open_connection(service.host, service.port)
    latencies, errors = [], 0
    due = time.monotonic() + random_state.random() * PAUSE_S
    while not done.is_set():
        await asyncio.sleep(max(0.0, due - time.monotonic()))
        path = f"/v1/plans/{random_state.choice(identifiers)}"
        writer.write(f"GET {path} HTTP/1.1\r\nHost: {service.host}\r\n\r\n".encode())
        head = (await reader.readuntil(b"\r\n\r\n")).decode().lower()
        length = next(
            int(line.split(":")[1]) for line in head.splitlines() if line.startswith("content-length")
        )
        await reader.readexactly(length)
        latencies.append(time.monotonic() - due)
        errors += " 200 " not in head.splitlines()[0]
        due += PAUSE_S
    writer.close()
    return latencies, errors


async def measure(service, identifiers):
    done = asyncio.Event()
    readers = [
        asyncio.create_task(read_until(service, identifiers, done, seed)) for seed in range(READERS)
    ]
    while True:
        _, page = await asyncio.to_thread(service.request, "GET", "/v1/plans?limit=100")
        if all(job["state"] in FINAL for job in page["plans"]):
            break
        await asyncio.sleep(0.2)
    done.set()
    results = await asyncio.gather(*readers)
    latencies = [latency for found, _ in results for latency in found]
    return latencies, sum(errors for _, errors in results)


def scenario(number, name):
    """The same targets turned a little, so that no leg is known from another job."""
    document = fixture(name)
    document["name"] = f"load-{number}"
    for target in document["targets"]:
        target["attitude"]["roll_pitch_yaw_deg"][1] += 0.1 * (number + 1)
    return document


def main(name):
    table = Table()
    with tempfile.TemporaryDirectory() as folder, Service(Path(folder) / "load.db", "--log", "warn", "--jobs", "1") as service:
        identifiers = [service.submit(scenario(number, name)) for number in range(JOBS)]
        begin = time.monotonic()
        latencies, errors = asyncio.run(measure(service, identifiers))
        took = time.monotonic() - begin
        jobs = [service.job(identifier) for identifier in identifiers]
    states = [job["state"] for job in jobs]
    starts = [job["started_at"] for job in jobs]
    ends = [job["finished_at"] for job in jobs]
    once = all(job["attempt"] == 1 for job in jobs)
    no_overlap = all(end <= start for end, start in zip(ends, starts[1:]))
    p99 = 1e3 * percentile(latencies, 0.99)
    table.row(f"{JOBS} scenarios finish ({took:.1f} s)", f"{states.count('succeeded')}", f"{JOBS}", states.count("succeeded") == JOBS)
    table.row("in order of submission, one after the other", str(no_overlap), "True", starts == sorted(starts) and no_overlap)
    table.row("each is solved once", str(once), "True", once)
    table.row(f"errors seen by {READERS} readers ({len(latencies)} reads)", str(errors), "0", errors == 0)
    table.timed("p99 of their reads", f"{p99:.1f} ms", f"{GOAL_P99_MS:.0f} ms", p99 < GOAL_P99_MS)
    table.exit()


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "olivares-a")
