"""Promises about jobs that one service took and another one is asked about."""

import calendar
import http.client
import json
import random
import threading
import time

from harness import Row, gate, percentile, service, strip
from service import FINAL


def microseconds(text):
    """A time of a document, microseconds since 1970."""
    whole, _, part = text.removesuffix("Z").partition(".")
    return calendar.timegm(time.strptime(whole, "%Y-%m-%dT%H:%M:%S")) * 1_000_000 + int(part.ljust(6, "0")[:6])


def follow(service, job, seen):
    """Reads the events of a job to its end: which they are, and when they came."""
    connection = http.client.HTTPConnection(service.host, service.port, timeout=120)
    connection.request("GET", f"/v1/plans/{job}/events")
    for line in connection.getresponse():
        if line.startswith(b"data: "):
            seen.append((time.time_ns() // 1000, json.loads(line[6:])))
    connection.close()


@gate("P3")
def other_processes_are_as_good(scale):
    """Jobs are followed, stopped and cancelled through the service that did not take them."""
    if not scale.shared:
        return [Row("P3", "several processes on a Postgres: --database postgres", "-", "-", None)]
    state, ends, late, wrong = random.Random(33), {"stop": [], "cancel": []}, [], 0
    rounds = scale.rounds(200, 10)
    with service(scale.database("p3")) as running:
        for number in range(rounds):
            taking, other = running.services[number % 2], running.services[1 - number % 2]
            what, state_then = ("stop", "stopped") if number % 4 < 2 else ("cancel", "cancelled")
            job = taking.submit(strip(18, 0.01 * number))
            seen = []
            following = threading.Thread(target=follow, args=(other, job, seen))
            following.start()
            # Half of them are asked for as soon as there is a plan.
            taking.wait(job, lambda job: job["incumbent_s"] is not None or job["state"] in FINAL)
            time.sleep(state.uniform(0.0, 0.5) * (number % 2))
            connected = time.time_ns() // 1000
            begin = time.monotonic()
            other.request("POST", f"/v1/plans/{job}/{what}")
            ended = other.wait_end(job)
            ends[what].append(1e3 * (time.monotonic() - begin))
            following.join(30)
            wrong += ended["state"] != state_then or taking.job(job) != ended or seen[-1][1]["state"] != state_then
            # What was written before the stream began has waited for its reader.
            first = seen[0][0] if seen else connected
            late += [(came - microseconds(event["at"])) / 1e3 for came, event in seen if microseconds(event["at"]) > first]
            taking.request("DELETE", f"/v1/plans/{job}")
    stop, cancel, event = (percentile(times, 0.99) for times in (ends["stop"], ends["cancel"], late))
    return [
        Row("P3", f"jobs with other ends than asked for at the other service, of {rounds}", str(wrong), "0", wrong == 0),
        Row("P3", f"stop through another process until the job has ended, p99 of {len(ends['stop'])}", f"{stop:.0f} ms", "500 ms", stop <= 500.0, timed=True),
        Row("P3", f"the same of a cancel, p99 of {len(ends['cancel'])}", f"{cancel:.0f} ms", "500 ms", cancel <= 500.0, timed=True),
        Row("P3", f"event at another process after it was written, p99 of {len(late)}", f"{event:.0f} ms", "250 ms", event <= 250.0, timed=True),
    ]
