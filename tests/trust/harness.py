"""What the gates share: rows of the table, clients that misbehave, faults of the disk."""

import os
import random
import socket
import subprocess
import threading
import time
from dataclasses import dataclass
from pathlib import Path

from systems import FileDatabase, ServerDatabase, System

from postgres import Postgres  # isort: skip
from service import FIXTURES, ROOT, Service, binary, fixture, percentile  # noqa: F401  # isort: skip

HERE = Path(__file__).resolve().parent


@dataclass
class Row:
    """One line of the table. `holds` is None for what is shown but not judged."""

    gate: str
    promise: str
    measured: str
    goal: str
    holds: bool | None
    timed: bool = False


class Server:
    """The Postgres that gates share which do not harm it, started for the first of them."""

    def __init__(self):
        self.started = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.started:
            self.started.__exit__()

    def __call__(self):
        self.started = self.started or Postgres()
        return self.started


@dataclass
class Scale:
    """How much is done, and on which database: the full number of repetitions, a taste of it, or so
    many rounds as are asked for."""

    short: bool
    work: Path
    asked_rounds: int | None = None
    server: Server | None = None

    def of(self, full, short):
        return short if self.short else full

    def rounds(self, full, short):
        """The same of repetitions that take long each."""
        return self.asked_rounds or self.of(full, short)

    @property
    def shared(self):
        """Whether several processes on a Postgres are measured, not one on a file."""
        return self.server is not None

    def database(self, name):
        """A new database."""
        if self.shared:
            return ServerDatabase(self.server(), self.work / name)
        return FileDatabase(self.file(name))

    def file(self, name):
        """The path of a new file of SQLite."""
        return self.work / f"{name}.db"


GATES = {}
# Why gates are not measured on several processes and a Postgres.
OF_A_FILE = {}
HTTP_ALIKE = "the same program, whatever the database: measured on a file"


def gate(name, of_a_file=None):
    """Registers a function that measures a gate and gives its rows; for one that has no meaning on a
    Postgres, or no other one than on a file, the reason."""

    def register(measure):
        GATES[name] = measure
        if of_a_file:
            OF_A_FILE[name] = of_a_file
        return measure

    return register


def elsewhere(name, promise, goal, where, of_a_file=None):
    """A gate that another command measures."""
    gate(name, of_a_file)(lambda _: [Row(name, promise, f"see {where}", goal, None)])


def example(name):
    """A program of tests/examples: built now, or of the folder SLEWPLAN_EXAMPLES."""
    given = os.environ.get("SLEWPLAN_EXAMPLES")
    if given:
        return Path(given) / name
    build = ["cargo", "build", "--quiet", "--locked", "--package", "slewplan-tests", "--example", name]
    subprocess.run(build, cwd=ROOT, check=True)
    return Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug" / "examples" / name


def cargo_test(*which, **settings):
    """What tests of the server say while they pass; of some that fail, nothing."""
    command = ["cargo", "test", "--quiet", "--locked", "--package", "slewplan-server", *which, "--", "--nocapture"]
    environment = {**os.environ, **{key: str(value) for key, value in settings.items()}}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else ""


def unit_test(name, **settings):
    """The same of a test beside the code."""
    return cargo_test("--lib", name, **settings)


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


def until(condition, patience):
    """Seconds until a condition holds; `None` when it does not in time."""
    begin = time.monotonic()
    while time.monotonic() - begin < patience:
        if condition():
            return time.monotonic() - begin
        time.sleep(0.02)
    return None


def ready(running):
    return running.request("GET", "/health/ready")[0]


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
    connection = socket.create_connection(service.address, timeout=timeout)
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


class UntilLeft:
    """Threads that run until they are left, which `ending` tells them."""

    def __init__(self, threads):
        self.ending, self.threads = threading.Event(), threads

    def __enter__(self):
        for thread in self.threads:
            thread.start()
        return self

    def __exit__(self, *_):
        self.ending.set()
        for thread in self.threads:
            thread.join()


class Background(UntilLeft):
    """Calls an action over and over on threads of its own until it is left."""

    def __init__(self, threads, action):
        super().__init__([threading.Thread(target=self.run, args=(action, index)) for index in range(threads)])

    def run(self, action, index):
        count = 0
        while not self.ending.is_set():
            action(index, count)
            count += 1


def interposed(work, name):
    """One of the C sources here as a library that comes between a service and the system; built once."""
    library = work / f"{name}.so"
    if not library.exists():
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", library, HERE / f"{name}.c", "-ldl"], check=True)
    return library


def service(database, *arguments, **settings):
    """The running system on a database, with a quiet log."""
    database = FileDatabase(database) if isinstance(database, Path) else database
    return System(database, *arguments, **settings)
