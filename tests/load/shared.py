#!/usr/bin/env python3
"""Several services and workers on one Postgres: what they promise, and what they ask of it.

Starts a Postgres, two services without a worker and some workers. Tiny jobs go in through both; every one
must be solved once. First some are counted, by the statements in the log of the server; then ten times as many
are timed, by the stamps in the database, without that log: as they come, and from a queue that is full when the
workers begin. Where the processor time went is told for each kind of process, this script among them. Then jobs
are stopped through the service that did not take them, while events are followed there. Last, everything is idle.
"""

import calendar
import http.client
import json
import os
import re
import sys
import threading
import time
from collections import Counter
from contextlib import ExitStack
from pathlib import Path

from postgres import Postgres
from service import FINAL, Service, Table, fixture, percentile
from worker import Worker

DATABASE = "postgres"
# A tiny job: a single turn, from rest to rest, whose leg is known.
TINY = "quarter-turn"
IDLE_S = 20.0
STOPS = 20
TIMED = 10
SENDERS = 4
GOAL_STOP_MS, GOAL_EVENT_MS = 500.0, 250.0
GOAL_RATE = 300.0
EXECUTED = re.compile(r"LOG:  (?:execute [^:]*|statement): +(.*)")
TICK_S = 1.0 / os.sysconf("SC_CLK_TCK")
FINAL_STATES = ", ".join(f"'{state}'" for state in sorted(FINAL))


class Log:
    """The statements of a server, written to its log while it is asked for them."""

    def __init__(self, postgres):
        self.postgres = postgres
        self.path = Path(postgres.folder) / "server.log"

    def __enter__(self):
        self._set("all")
        self.begin = self.path.stat().st_size
        return self

    def __exit__(self, *_):
        self._set("none")

    def _set(self, what):
        self.postgres.execute(DATABASE, f"ALTER SYSTEM SET log_statement = '{what}'", "SELECT pg_reload_conf()")
        time.sleep(0.3)

    def kinds(self):
        """How many there were of each kind."""
        with self.path.open(errors="replace") as log:
            log.seek(self.begin)
            found = [match.group(1) for line in log if (match := EXECUTED.search(line))]
        # Those of this script, which are not prepared, name what it looks for.
        return Counter(kind(statement) for statement in found if "/* load */" not in statement)


def processor_s(pid):
    """Processor time of a process, s; none of one that has just ended."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except (FileNotFoundError, ProcessLookupError):
        return 0.0
    return TICK_S * (int(fields[11]) + int(fields[12]))


def children(pid):
    """The processes that a process has started."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                fields = (entry / "stat").read_text().rsplit(")", 1)[1].split()
            except OSError:
                continue
            if int(fields[1]) == pid:
                found.append(int(entry.name))
    return found


class Processors:
    """Processor time by kind of process; that of backends which end meanwhile is lost."""

    def __init__(self, postgres, services, crew):
        server = int((Path(postgres.folder) / "data" / "postmaster.pid").read_text().split()[0])
        self.groups = {
            "services": lambda: [service.process.pid for service in services],
            "workers": lambda: [worker.process.pid for worker in crew],
            "postgres": lambda: [server, *children(server)],
            "this script": lambda: [os.getpid()],
        }
        self.before = self.now()

    def now(self):
        return {name: sum(map(processor_s, pids())) for name, pids in self.groups.items()}

    def per_job_ms(self, jobs):
        """Milliseconds of a job, by kind of process."""
        return {name: 1e3 * (time_s - self.before[name]) / jobs for name, time_s in self.now().items()}


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


class Sender(threading.Thread):
    """Submits the same scenario again and again, on one connection."""

    def __init__(self, service, count):
        super().__init__()
        self.connection = http.client.HTTPConnection(service.host, service.port, timeout=120)
        self.body = json.dumps(fixture(TINY)).encode()
        self.count = count
        self.refused = 0

    def run(self):
        for _ in range(self.count):
            headers = {"Content-Type": "application/json"}
            self.connection.request("POST", "/v1/plans", self.body, headers)
            answer = self.connection.getresponse()
            answer.read()
            self.refused += answer.status != 202
        self.connection.close()


def submit(services, count):
    """Submits jobs through all services at once; jobs a second."""
    begin = time.monotonic()
    senders = [Sender(services[number % len(services)], count // SENDERS) for number in range(SENDERS)]
    for sender in senders:
        sender.start()
    for sender in senders:
        sender.join()
    if any(sender.refused for sender in senders):
        raise RuntimeError("submissions were refused")
    return count / (time.monotonic() - begin)


class Jobs:
    """The jobs that are submitted from here on, by what the database says of them."""

    def __init__(self, postgres):
        self.postgres = postgres
        ((self.last,),) = self._rows("coalesce(max(sequence), 0) AS last")

    def _rows(self, what, condition="true"):
        return self.postgres.rows(DATABASE, f"SELECT /* load */ {what} FROM jobs WHERE {condition}")

    def _of_them(self, what, condition="true"):
        return self._rows(what, f"sequence > {self.last} AND {condition}")[0][0]

    def wait(self, count):
        """Waits until as many have ended."""
        end = time.monotonic() + 300.0
        while self._of_them("count(*) AS ended", f"state IN ({FINAL_STATES})") < count:
            if time.monotonic() > end:
                raise RuntimeError("jobs have not ended")
            time.sleep(1.0)

    def good(self):
        """How many were solved at the first attempt."""
        return self._of_them("count(*) AS good", "state = 'succeeded' AND attempt = 1")

    def rate(self, since):
        """Ends a second, from the first of a stamp to the last end."""
        return self._of_them(f"1e6 * count(*) / (max(finished_us) - min({since})) AS rate")


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


def settled(postgres, count, submit_all):
    """Submits jobs and waits for all of them; rate of the submission, and the jobs."""
    jobs = Jobs(postgres)
    accepted = submit_all(count)
    jobs.wait(count)
    return accepted, jobs


def counted(table, postgres, services, count):
    """Statements of a number of jobs."""
    with Log(postgres) as log:
        _, jobs = settled(postgres, count, lambda count: submit(services, count))
        kinds = log.kinds()
    table.row("tiny jobs solved, each once", str(jobs.good()), str(count), jobs.good() == count)
    return kinds


def timed(table, postgres, services, crew, count):
    """Rates of a number of jobs, and the processor time of each, by kind of process."""
    processors = Processors(postgres, services, crew)
    accepted, jobs = settled(postgres, count, lambda count: submit(services, count))
    spent = processors.per_job_ms(count)
    rate = jobs.rate("submitted_us")
    table.row("accepted a second, while jobs are solved", f"{accepted:.0f}", "", True)
    table.timed("accepted and solved a second", f"{rate:.0f}", f"{GOAL_RATE:.0f}", rate >= GOAL_RATE)
    table.row(f"of {count} timed, solved once", str(jobs.good()), str(count), jobs.good() == count)
    return spent


def drained(table, postgres, services, workers, stack, count):
    """The rate of new workers that find a full queue, and the processor time of a job."""
    jobs = Jobs(postgres)
    accepted = submit(services, count)
    table.row("accepted a second, while nothing else runs", f"{accepted:.0f}", "", True)
    crew = [stack.enter_context(Worker(postgres.url())) for _ in range(workers)]
    processors = Processors(postgres, services, crew)
    jobs.wait(count)
    rate = jobs.rate("started_us")
    table.timed("solved a second, from a full queue", f"{rate:.0f}", f"{GOAL_RATE:.0f}", rate >= GOAL_RATE)
    return crew, processors.per_job_ms(count)


def answered(table, services):
    """Stops through another process, and events at it."""
    results = [stopped(services, number) for number in range(STOPS)]
    slowest = percentile([took for took, _ in results], 0.99)
    table.timed("stop through another process, p99", f"{slowest:.0f} ms", f"{GOAL_STOP_MS:.0f} ms", slowest < GOAL_STOP_MS)
    arrivals = [late for _, late in results for late in late]
    slowest = percentile(arrivals, 0.99)
    table.timed(f"event at another process, p99 of {len(arrivals)}", f"{slowest:.0f} ms", f"{GOAL_EVENT_MS:.0f} ms", slowest < GOAL_EVENT_MS)


def print_times(name, spent):
    print(f"\nprocessor time of a job, {name}: {sum(spent.values()):.2f} ms")
    for who, time_ms in spent.items():
        print(f"  {time_ms:8.2f}  {who}")


def print_kinds(name, kinds, share):
    print(f"\nstatements of a {name}: {sum(kinds.values()) / share:.1f}")
    for what, count in kinds.most_common():
        print(f"  {count / share:8.2f}  {what}")


def main(jobs, workers):
    table = Table()
    with ExitStack() as stack:
        postgres = stack.enter_context(Postgres("max_connections=400"))
        arguments = ["--no-worker", "--log", "error", "--queue-limit", "100000"]
        services = [stack.enter_context(Service(postgres.url(), *arguments)) for _ in range(2)]
        with Worker(postgres.url(), "--log", "error") as one:
            # Legs are solved once, before anything is measured.
            services[0].wait_end(services[0].submit(fixture(TINY)))
            one.process.terminate()
            one.process.wait(30)
        crew, from_queue = drained(table, postgres, services, workers, stack, TIMED * jobs)
        kinds = counted(table, postgres, services, jobs)
        spent = timed(table, postgres, services, crew, TIMED * jobs)
        answered(table, services)
        with Log(postgres) as log:
            time.sleep(IDLE_S)
            idle = log.kinds()
        processes = workers + len(services)
        rate = sum(idle.values()) / IDLE_S / processes
        table.row("idle statements of a process a second", f"{rate:.2f}", "", True)
    print_times("from a full queue", from_queue)
    print_times("with its submission", spent)
    print_kinds("tiny job", kinds, jobs)
    print_kinds("idle process and minute", idle, processes * IDLE_S / 60)
    table.exit()


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else 400,
        int(sys.argv[2]) if len(sys.argv) > 2 else 3,
    )
