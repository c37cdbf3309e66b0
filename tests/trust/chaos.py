"""Several processes and a Postgres under everything at once: kills, ends of the server, a bad network."""

import http.client
import json
import random
import signal
import threading
import time
from collections import Counter
from contextlib import ExitStack
from dataclasses import dataclass, field

from harness import Postgres, Row, UntilLeft, fixture, gate, service, until, variant
from proxy import Proxy
from service import FINAL
from systems import SERVICES, WORKERS, ServerDatabase

CLIENTS = 3
# Longest pause of a process that is stopped and goes on, s: longer than a claim.
SLEEP_S = 14.0
# Time for all jobs to end once nothing is disturbed any more, s.
PATIENCE_S = 300.0
FAILURES = (OSError, http.client.HTTPException, ValueError)


@dataclass
class Told:
    """What clients have been told: jobs that were acknowledged, keys with the jobs that were answered to
    them, and events by job and number."""

    acknowledged: set = field(default_factory=set)
    of_key: dict = field(default_factory=dict)
    events: dict = field(default_factory=dict)
    statuses: Counter = field(default_factory=Counter)


class Clients(UntilLeft):
    """Threads that submit through any service, stop, cancel and follow jobs, whatever happens."""

    def __init__(self, running, seed):
        self.running, self.seed, self.told, self.guard = running, seed, Told(), threading.Lock()
        submitting = [threading.Thread(target=self.submit, args=(number,)) for number in range(CLIENTS)]
        super().__init__([*submitting, threading.Thread(target=self.follow)])

    def asked(self, *request):
        """Status and document of an answer; a status of 0 where there was none."""
        try:
            status, document = self.running.request(*request)
        except FAILURES:
            status, document = 0, None
        with self.guard:
            self.told.statuses[status] += 1
        return status, document

    def scenario(self, state, number):
        """Mostly small ones, some of which no leg is known of, and now and then one of a few seconds."""
        if state.random() < 0.1:
            scenario = fixture("olivares-c")
            scenario["name"] = f"long-{number}"
            scenario["options"] = {"time_limit_s": state.uniform(1.0, 4.0)}
            for target in scenario["targets"]:
                target["attitude"]["roll_pitch_yaw_deg"][1] += 0.01 * state.random()
            return scenario
        return variant(state.randrange(50) if state.random() < 0.5 else number)

    def submit(self, number):
        state, count = random.Random(f"{self.seed}-{number}"), 0
        while not self.ending.is_set():
            count += 1
            scenario = self.scenario(state, 1000 * number + count)
            key = f"key-{number}-{count}" if state.random() < 0.5 else None
            headers = {"Idempotency-Key": key} if key else {}
            status, job = self.asked("POST", "/v1/plans", scenario, headers)
            # Who has a key asks until there is an answer.
            while key and status != 202 and not self.ending.is_set():
                time.sleep(0.2)
                status, job = self.asked("POST", "/v1/plans", scenario, headers)
            if status == 202:
                with self.guard:
                    self.told.acknowledged.add(job["id"])
                    if key:
                        self.told.of_key.setdefault(key, set()).add(job["id"])
                if state.random() < 0.1:
                    time.sleep(state.uniform(0.0, 0.5))
                    self.asked("POST", f"/v1/plans/{job['id']}/{state.choice(['stop', 'cancel'])}")
            time.sleep(state.uniform(0.1, 0.8))

    def follow(self):
        """Reads the events of one job after another, of each to its end, at whichever service there is."""
        while not self.ending.is_set():
            with self.guard:
                fresh = [job for job in self.told.acknowledged if job not in self.told.events]
            if not fresh:
                time.sleep(0.1)
                continue
            self.follow_to_the_end(min(fresh))

    def follow_to_the_end(self, job):
        seen = self.told.events.setdefault(job, [])
        while not self.ending.is_set():
            service = self.running.next()
            connection = http.client.HTTPConnection(service.host, service.port, timeout=20)
            try:
                headers = {"Last-Event-ID": str(seen[-1][0])} if seen else {}
                connection.request("GET", f"/v1/plans/{job}/events", headers=headers)
                answer = connection.getresponse()
                if answer.status == 204:
                    return
                for identifier, kind, data in events_of(answer):
                    if kind == "state" or kind == "progress":
                        seen.append((identifier, data))
                    if kind == "state" and json.loads(data)["state"] in FINAL:
                        return
            except FAILURES:
                pass
            finally:
                connection.close()
            time.sleep(0.1)


def events_of(answer):
    """Number, kind and data of the events of a stream; one that was cut off is none."""
    event = {}
    for line in answer:
        name, _, value = line.decode().rstrip("\n").partition(": ")
        if name:
            event[name] = value
        else:
            if "id" in event and "data" in event:
                yield int(event["id"]), event.get("event"), event["data"]
            event = {}


class Chaos:
    """What is done to processes, server and network, one thing a round."""

    def __init__(self, running, server, proxies, seed):
        self.running, self.server, self.proxies = running, server, proxies
        self.database = running.database
        self.state, self.asleep, self.done = random.Random(seed), [], Counter()

    def kinds(self):
        """What can happen, with its weight."""
        return {
            self.kill_of_a_process: 4,
            self.sleep_of_a_process: 1,
            self.end_of_a_process: 1,
            self.kill_of_a_backend: 1,
            self.end_of_connections: 1,
            self.end_of_the_server: 1,
            self.cut: 3,
            self.half_close: 3,
            self.delay: 3,
            self.partition: 1,
        }

    def round(self):
        """One of them, and a while without."""
        self.wake(time.monotonic())
        kinds = self.kinds()
        [act] = self.state.choices(list(kinds), weights=list(kinds.values()))
        self.done[act.__name__] += 1
        act()
        time.sleep(self.state.uniform(0.2, 1.2))
        self.revive()

    def calm(self):
        """Nothing is disturbed from here on."""
        self.wake(float("inf"))
        self.revive()

    def wake(self, now):
        """Stopped processes go on whose time has come."""
        for until_s, one in [entry for entry in self.asleep if entry[0] <= now]:
            one.process.send_signal(signal.SIGCONT)
            self.asleep.remove((until_s, one))

    def revive(self):
        """Starts what has ended, as those do that watch over it."""
        if not self.server.answers():
            self.server.restart()
        for number, one in enumerate(self.running.processes):
            if one.process.poll() is not None:
                until(lambda: self.started(number), 60.0)

    def started(self, number):
        try:
            self.running.restart(number)
            return True
        except RuntimeError:  # the server is not there yet
            return False

    def a_process(self):
        awake = [one for one in self.running.processes if one not in [entry[1] for entry in self.asleep]]
        return self.state.choice(awake)

    def a_proxy(self):
        return self.state.choice(self.proxies)

    def kill_of_a_process(self):
        self.a_process().kill()

    def end_of_a_process(self):
        one = self.a_process()
        one.process.terminate()
        one.process.wait(60)

    def sleep_of_a_process(self):
        one = self.a_process()
        if len(self.asleep) < 2:
            one.process.send_signal(signal.SIGSTOP)
            self.asleep.append((time.monotonic() + self.state.uniform(1.0, SLEEP_S), one))

    def kill_of_a_backend(self):
        """The server ends all others then, and begins again."""
        self.database.kill_backend()

    def end_of_connections(self):
        self.database.end_connections()

    def end_of_the_server(self):
        self.server.kill()
        time.sleep(self.state.uniform(0.0, 3.0))
        self.server.start()

    def cut(self):
        self.a_proxy().cut(self.state.choice([0.3, 1.0]))

    def half_close(self):
        self.a_proxy().half_close(self.state.choice([0.3, 1.0]))

    def delay(self):
        self.a_proxy().delay(self.state.uniform(0.1, 3.0), self.state.choice([0.3, 1.0]))

    def partition(self):
        proxy = self.a_proxy()
        proxy.refuse(True)
        time.sleep(self.state.uniform(0.5, 3.0))
        proxy.refuse(False)


def not_ended(database):
    """Number of jobs that wait or run."""
    [(count,)] = database.rows("SELECT count(*) FROM jobs WHERE state IN ('queued', 'running')")
    return count


def faults_of_ends(database):
    """Jobs whose end is not exactly one: of their final events, which has to be the last one, and of their
    results, which are plans of those that have one."""
    finals = "('succeeded', 'stopped', 'infeasible', 'failed', 'cancelled', 'dead')"
    return database.rows(
        f"""SELECT j.id, j.state, count(r.job) AS results, e.finals, e.events, e.last FROM jobs j
        LEFT JOIN results r ON r.job = j.sequence
        LEFT JOIN (SELECT job, count(*) AS events, max(id) AS last,
                count(*) FILTER (WHERE kind = 'state' AND data::json ->> 'state' IN {finals}) AS finals,
                max(id) FILTER (WHERE kind = 'state' AND data::json ->> 'state' IN {finals}) AS final
            FROM events GROUP BY job) e ON e.job = j.sequence
        GROUP BY j.sequence, e.finals, e.events, e.last, e.final
        HAVING j.state NOT IN {finals} OR e.finals IS DISTINCT FROM 1 OR e.events <> e.last OR e.final <> e.last
            OR (j.state = 'succeeded' AND count(r.job) <> 1) OR (j.state = 'cancelled' AND count(r.job) <> 0)"""
    )


def faults_of_streams(database, followed):
    """Jobs of whose events a client that came back each time saw other ones than there are, or one twice."""
    wrong = []
    for job, seen in followed.items():
        stored = database.rows(
            "SELECT e.id, e.data FROM events e JOIN jobs j ON e.job = j.sequence WHERE j.id = ? ORDER BY e.id", job
        )
        # Who was still reading at the end has seen a beginning.
        if seen != stored[: len(seen)]:
            wrong.append(job)
    return wrong


@gate("P1")
def chaos_loses_nothing(scale):
    """Kills of processes, of the server and of its connections, and a network that cuts, delays and
    half-closes, while clients submit, stop, cancel and follow; then everything has to come to its end."""
    if not scale.shared:
        return [Row("P1", "several processes on a Postgres: --database postgres", "-", "-", None)]
    rounds, seed = scale.rounds(200, 8), 25
    with ExitStack() as stack:
        server = stack.enter_context(Postgres())
        database = ServerDatabase(server, scale.work / "p1")
        count = SERVICES + WORKERS
        proxies = [stack.enter_context(Proxy(server.socket, f"{seed}-{number}")) for number in range(count)]
        addresses = [server.url(database.name, f"127.0.0.1:{proxy.port}") for proxy in proxies]
        running = stack.enter_context(service(database, "--queue-limit", "100000", addresses=addresses))
        with Clients(running, seed) as clients:
            chaos = Chaos(running, server, proxies, seed)
            for _ in range(rounds):
                chaos.round()
            chaos.calm()
            # All of them find each other again while there are still submissions.
            time.sleep(2.0)
        told = clients.told
        waited = until(lambda: not_ended(database) == 0, PATIENCE_S)
        readiness = {one.request("GET", "/health/ready")[0] for one in running.processes}
        states = database.rows("SELECT state, code, count(*) FROM jobs GROUP BY state, code ORDER BY state, code")
        stored = {job for (job,) in database.rows("SELECT id FROM jobs")}
        ends, streams = faults_of_ends(database), faults_of_streams(database, told.events)
        running.terminate()
        sound, log = database.sound(), running.told()
    lost, twice = told.acknowledged - stored, [key for key, jobs in told.of_key.items() if len(jobs) > 1]
    events = sum(map(len, told.events.values()))
    print(f"    {dict(chaos.done)}; answers {dict(told.statuses)}; jobs {states}", flush=True)
    for fault in [*ends, *streams, *twice, *lost]:
        print(f"    {fault}", flush=True)
    strange = {status for status in told.statuses if status not in (0, 200, 202, 404, 409, 503)}
    return [
        Row("P1", f"acknowledged jobs lost, of {len(told.acknowledged)}, in {rounds} rounds", str(len(lost)), "0", not lost and len(told.acknowledged) >= rounds),
        Row("P1", f"jobs with other than one end, of {len(stored)}", str(len(ends)), "0", not ends and waited is not None),
        Row("P1", f"keys with more than one job, of {len(told.of_key)}", str(len(twice)), "0", not twice),
        Row("P1", f"streams with a gap or a double, of {len(told.events)} with {events} events", str(len(streams)), "0", not streams and events > 0),
        Row("P1", f"answers of other statuses than 2xx, 404, 409 and 503 {sorted(strange)}", str(len(strange)), "0", not strange),
        Row("P1", "calm until the last job has ended", "never" if waited is None else f"{waited:.0f} s", f"{PATIENCE_S:.0f} s", waited is not None),
        Row("P1", f"readiness of all afterwards {sorted(readiness)}, panics, damage", str(log.count("panic")), "0", readiness == {200} and "panic" not in log and sound),
    ]
