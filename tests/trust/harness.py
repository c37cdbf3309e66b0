"""What the gates share: rows of the table, clients that misbehave, faults of the disk."""

import mmap
import os
import random
import socket
import sqlite3
import struct
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "load"))

from service import FIXTURES, ROOT, Service, binary, fixture, percentile  # noqa: E402, F401


@dataclass
class Row:
    """One line of the table. `holds` is None for what is shown but not judged."""

    gate: str
    promise: str
    measured: str
    goal: str
    holds: bool | None
    timed: bool = False


@dataclass
class Scale:
    """How much is done: the full number of repetitions, or a taste of it."""

    short: bool
    work: Path

    def of(self, full, short):
        return short if self.short else full

    def database(self, name):
        return self.work / f"{name}.db"


GATES = {}


def gate(name):
    """Registers a function that measures a gate and gives its rows."""

    def register(measure):
        GATES[name] = measure
        return measure

    return register


def elsewhere(name, promise, goal, where):
    """A gate that another command measures."""
    GATES[name] = lambda _: [Row(name, promise, f"see {where}", goal, None)]


def example(name):
    """A program of tests/examples: built now, or of the folder SLEWPLAN_EXAMPLES."""
    given = os.environ.get("SLEWPLAN_EXAMPLES")
    if given:
        return Path(given) / name
    build = ["cargo", "build", "--quiet", "--locked", "--package", "slewplan-tests", "--example", name]
    subprocess.run(build, cwd=ROOT, check=True)
    return Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug" / "examples" / name


def unit_test(name, **settings):
    """What a test of the server's own says while it passes; of one that fails, nothing."""
    command = ["cargo", "test", "--quiet", "--locked", "--package", "slewplan-server", "--lib", name, "--", "--nocapture"]
    environment = {**os.environ, **{key: str(value) for key, value in settings.items()}}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else ""


def variant(number):
    """The small scenario, new to the cache of legs for every number."""
    scenario = fixture("two-targets")
    scenario["name"] = f"variant-{number}"
    for target in scenario["targets"]:
        target["attitude"]["roll_pitch_yaw_deg"][1] += 0.001 * (number + 1)
    return scenario


def long_running(number=0):
    """A scenario that goes on until it is stopped."""
    scenario = fixture("olivares-c")
    scenario["options"] = {"time_limit_s": None}
    # Many targets near each other: good orders abound, and short legs couple most.
    scenario["targets"] = [
        {
            "id": f"t{i}",
            "attitude": {"roll_pitch_yaw_deg": [7.3 * (i % 8) - 25, 11.9 * (i // 8) - 30, 3.7 * (i % 5)]},
            "zero_rate_axes": ["z"],
        }
        for i in range(48)
    ]
    for target in scenario["targets"]:
        target["attitude"]["roll_pitch_yaw_deg"][1] += 0.01 * (number + 1)
    return scenario


def strip(targets, shift=0.0):
    """Clusters of targets in a strip below an orbit, the rate about one axis zero: some ten seconds
    of processor time for sixteen targets, all of it in the search."""
    scenario, state, middle = fixture("olivares-a"), random.Random(1), (0.0, 0.0)
    scenario["targets"] = []
    for number in range(targets):
        if number % 5 == 0:
            middle = (state.uniform(-25, 25), state.uniform(-50, 50))
        angles = [middle[0] + state.uniform(-6, 6), middle[1] + state.uniform(-6, 6) + shift, state.uniform(-10, 10)]
        attitude = {"roll_pitch_yaw_deg": angles}
        scenario["targets"].append({"id": f"t{number}", "attitude": attitude, "zero_rate_axes": ["z"]})
    scenario["options"] = {"time_limit_s": None}
    return scenario


def rows_of(database, query, *parameters):
    """The rows of a query, from outside of the service."""
    connection = sqlite3.connect(f"file:{database}?mode=ro", uri=True, timeout=10)
    try:
        return connection.execute(query, parameters).fetchall()
    finally:
        connection.close()


def sound(database):
    return rows_of(database, "PRAGMA integrity_check") == [("ok",)]


def timed(action):
    """Seconds that an action takes, and what it gives."""
    begin = time.monotonic()
    result = action()
    return time.monotonic() - begin, result


def resident_kib(pid, field="VmRSS"):
    for line in Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith(field + ":"):
            return int(line.split()[1])
    return 0


def connect(service, timeout=60.0):
    connection = socket.create_connection((service.host, service.port), timeout=timeout)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection


def exchange(service, request, timeout=60.0):
    """The raw answer to a raw request."""
    with connect(service, timeout) as connection:
        try:
            connection.sendall(request)
        except (BrokenPipeError, ConnectionResetError):
            pass
        answer = b""
        while True:
            try:
                part = connection.recv(65536)
            except ConnectionResetError:
                break
            if not part:
                break
            answer += part
        return answer


def post(body, path="/v1/plans", *headers):
    """A raw request with a body."""
    lines = [
        f"POST {path} HTTP/1.1",
        "Host: localhost",
        "Connection: close",
        f"Content-Length: {len(body)}",
        *(headers or ["Content-Type: application/json"]),
    ]
    return "\r\n".join([*lines, "", ""]).encode() + body


class Background:
    """Calls an action over and over on threads of its own until it is left."""

    def __init__(self, threads, action):
        self.ending = threading.Event()
        self.threads = [threading.Thread(target=self.run, args=(action, index)) for index in range(threads)]

    def run(self, action, index):
        count = 0
        while not self.ending.is_set():
            action(index, count)
            count += 1

    def __enter__(self):
        for thread in self.threads:
            thread.start()
        return self

    def __exit__(self, *_):
        self.ending.set()
        for thread in self.threads:
            thread.join()


def interposed(work, name):
    """One of the C sources here as a library that comes between a service and the system; built once."""
    library = work / f"{name}.so"
    if not library.exists():
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", library, HERE / f"{name}.c", "-ldl"], check=True)
    return library


class Faults:
    """Makes the writes and syncs of a service's database fail."""

    FAULT = struct.Struct("iiii")

    def __init__(self, work, database):
        library = interposed(work, "shim")
        self.requests = work / f"{database.name}.faults"
        self.requests.write_bytes(bytes(2 * self.FAULT.size))
        self.file = open(self.requests, "r+b")
        self.map = mmap.mmap(self.file.fileno(), 0)
        self.environment = {
            "LD_PRELOAD": str(library),
            "TRUST_SHIM": str(self.requests),
            "TRUST_MATCH": database.name,
        }

    def fail(self, what, after, error, sticky=False):
        place = 0 if what == "write" else self.FAULT.size
        _, _, _, calls = self.FAULT.unpack_from(self.map, place)
        # The countdown last: the fault is complete when it begins to count.
        self.FAULT.pack_into(self.map, place, 0, error, int(sticky), calls)
        struct.pack_into("i", self.map, place, after)

    def clear(self):
        for place in (0, self.FAULT.size):
            struct.pack_into("i", self.map, place, 0)

    def pending(self, what):
        place = 0 if what == "write" else self.FAULT.size
        return struct.unpack_from("i", self.map, place)[0] > 0


def service(database, *arguments, environment=None):
    """The service with a quiet log, and with further variables in its environment."""
    before = dict(os.environ)
    os.environ.update(environment or {})
    try:
        return Service(database, "--log", "warn", *arguments)
    finally:
        os.environ.clear()
        os.environ.update(before)
