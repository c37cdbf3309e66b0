"""The system under test: one process on a file, or services and workers on a database of Postgres."""

import os
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "load"))

from postgres import program, written_out  # noqa: E402
from service import Client, Service  # noqa: E402
from worker import Worker  # noqa: E402

SERVICES, WORKERS = 2, 3
# Options that workers understand too; the others are for services alone.
OF_WORKERS = {"--threads", "--jobs", "--job-memory", "--log", "--log-format"}
# Warnings, and who a process is.
LOG = "warn,slewplan_server::service=info"


class FileDatabase:
    """A file of SQLite."""

    def __init__(self, path):
        self.path = Path(path)
        self.name = self.path.name

    def __str__(self):
        return str(self.path)

    @property
    def log(self):
        """The beginning of the names of logs."""
        return str(self.path)

    def rows(self, query, *parameters):
        """The rows of a query, from outside of the service."""
        connection = sqlite3.connect(f"file:{self.path}?mode=ro", uri=True, timeout=10)
        try:
            return connection.execute(query, parameters).fetchall()
        finally:
            connection.close()

    @contextmanager
    def alone(self):
        """A transaction beside which nobody writes: what is called with its statements."""
        connection = sqlite3.connect(self.path, timeout=10.0, isolation_level=None)
        try:
            connection.execute("BEGIN IMMEDIATE")
            yield connection.execute
            connection.execute("COMMIT")
        finally:
            connection.close()

    def columns(self, table):
        return [name for (_, name, *_) in self.rows(f"PRAGMA table_info({table})")]

    def sound(self):
        """Whether the database finds itself undamaged."""
        return self.rows("PRAGMA integrity_check") == [("ok",)]

    def log_bytes(self):
        """What of the write-ahead log a start has to read."""
        log = self.path.with_name(f"{self.path.name}-wal")
        return log.stat().st_size if log.exists() else 0

    @contextmanager
    def long_log(self):
        """Within it the write-ahead log is not folded into the database."""
        reader = sqlite3.connect(self.path)
        try:
            reader.execute("BEGIN")
            reader.execute("SELECT count(*) FROM readiness").fetchall()
            yield
        finally:
            reader.close()

    def crash(self):
        """Ends what serves it: of a file nothing."""

    def recover(self):
        """Starts that again."""

    def copied(self, name):
        """What a kill has left, once more."""
        copy = FileDatabase(self.path.with_name(f"{name}.db"))
        for part in ("", "-wal"):
            shutil.copy(f"{self.path}{part}", f"{copy.path}{part}")
        return copy

    def removed(self):
        """Nothing of it is left."""
        for part in self.path.parent.glob(f"{self.path.name}*"):
            part.unlink()

    def files(self):
        """Everything that it and its processes have written."""
        return [path for path in self.path.parent.glob(f"{self.path.name}*") if path.is_file()]


class ServerDatabase:
    """A database of a Postgres server."""

    def __init__(self, server, log, name=None, suffix=""):
        self.server, self.log = server, str(log)
        self.name = name or server.new_database(suffix)

    def __str__(self):
        return self.server.url(self.name)

    def rows(self, query, *parameters):
        """The rows of a query, from outside of the services."""
        return self.server.rows(self.name, query, *parameters)

    @contextmanager
    def alone(self):
        """A transaction beside which nobody writes to a job: what is called with its statements."""
        command = [program("psql"), "--no-psqlrc", "--quiet", "--no-align", "--tuples-only", str(self)]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as session:

            def execute(query, parameters=()):
                print(f"{written_out(query, parameters)};\n\\echo done", file=session.stdin, flush=True)
                return list(iter(lambda: session.stdout.readline().strip(), "done"))

            execute("BEGIN")
            execute("LOCK TABLE jobs IN EXCLUSIVE MODE")
            yield execute
            execute("COMMIT")

    def kill_backend(self):
        """Kills one of the processes that serve connections, if there is one."""
        for pid in self.server.backends(self.name)[:1]:
            os.kill(pid, signal.SIGKILL)

    def end_connections(self):
        """Ends those of all others."""
        query = "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = ? AND pid <> pg_backend_pid()"
        self.server.rows("postgres", query, self.name)

    def columns(self, table):
        query = "SELECT column_name FROM information_schema.columns WHERE table_name = ? ORDER BY ordinal_position"
        return [name for (name,) in self.rows(query, table)]

    def sound(self):
        """Whether all tables and indexes are what they should be."""
        where = [f"--host={self.server.folder}", "--username=slewplan", self.name]
        command = [program("pg_amcheck"), "--install-missing", "--parent-check", *where]
        checked = subprocess.run(command, capture_output=True, text=True)
        if checked.returncode != 0:
            print(checked.stdout + checked.stderr, file=sys.stderr)
        return checked.returncode == 0

    def log_bytes(self):
        """What of the write-ahead log a start has to read."""
        query = "SELECT pg_wal_lsn_diff(pg_current_wal_lsn(), redo_lsn)::bigint AS bytes FROM pg_control_checkpoint()"
        [(size,)] = self.rows(query)
        return size

    @contextmanager
    def long_log(self):
        """The same: a server folds its log every few minutes only. At its begin nothing is left to fold."""
        self.server.execute(self.name, "CHECKPOINT")
        yield

    def crash(self):
        """Ends the server without a shutdown."""
        self.server.kill()

    def recover(self):
        """Starts it again, if it has ended."""
        if not self.server.answers():
            self.server.start()

    def copied(self, name):
        """What a kill has left, once more."""
        log = Path(self.log).with_name(name)
        # The server has noticed that all connections have ended before it copies.
        for _ in range(100):
            if not self.server.backends(self.name):
                break
            time.sleep(0.1)
        return ServerDatabase(self.server, log, suffix=f"TEMPLATE {self.name}")

    def removed(self):
        """Nothing of it is left."""
        self.server.execute("postgres", f"DROP DATABASE {self.name} WITH (FORCE)")

    def files(self):
        """Everything that the server and the processes have written."""
        self.server.execute(self.name, "CHECKPOINT")
        logs = Path(self.log).parent.glob(f"{Path(self.log).name}*")
        return [path for path in [*logs, *Path(self.server.folder).rglob("*")] if path.is_file()]


class System(Client):
    """Running processes on one database, asked through its services in turn."""

    def __init__(self, database, *arguments, environment=None, workers=WORKERS, addresses=None):
        """On a server two services, which solve nothing, and workers; `addresses` are those by which
        they reach the database, where they differ."""
        self.database, self.environment = database, environment
        self.guard, self.turn = threading.Lock(), 0
        shared = isinstance(database, ServerDatabase)
        self.kinds = [Service] * SERVICES + [Worker] * workers if shared else [Service]
        self.addresses = addresses or [str(database)] * len(self.kinds)
        pairs = list(zip(("--log", *arguments[::2]), (LOG, *arguments[1::2]), strict=True))
        self.arguments = {
            Service: [part for pair in pairs for part in pair] + (["--no-worker"] if shared else []),
            Worker: [part for pair in pairs if pair[0] in OF_WORKERS for part in pair],
        }
        # The first one makes the schema.
        self.processes = [self.started(0)]
        with ThreadPoolExecutor() as starting:
            self.processes += starting.map(self.started, range(1, len(self.kinds)))

    def started(self, number):
        """A new process in a place."""
        kind, log = self.kinds[number], f"{self.database.log}{f'-{number}' if number else ''}.log"
        arguments = self.arguments[kind]
        return kind(self.addresses[number], *arguments, log=log, environment=self.environment)

    def restart(self, number):
        """Another process in the place of one that has ended."""
        self.processes[number].close()
        self.processes[number] = self.started(number)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.terminate()
        for process in self.processes:
            process.close()

    @property
    def services(self):
        return [one for one in self.processes if isinstance(one, Service)]

    @property
    def workers(self):
        """The processes that solve."""
        return [one for one in self.processes if isinstance(one, Worker)] or self.processes

    @property
    def process(self):
        """The first one, which on a file is the only one."""
        return self.processes[0].process

    def next(self):
        """One of the services that have not ended."""
        with self.guard:
            self.turn += 1
            alive = [one for one in self.services if one.process.poll() is None] or self.services
            return alive[self.turn % len(alive)]

    @property
    def address(self):
        """Host and port of one of the services."""
        service = self.next()
        return service.host, service.port

    def request(self, *arguments, **named):
        return self.next().request(*arguments, **named)

    def solver_of(self, job):
        """The process that holds the claim of a job."""
        [(boot,)] = self.database.rows("SELECT boot_id FROM jobs WHERE id = ?", job)
        [found] = [one for one in self.workers if boot_id(one) == boot]
        return found

    def signal(self, signal):
        """Sends a signal to all that have not ended."""
        for one in self.processes:
            if one.process.poll() is None:
                one.process.send_signal(signal)

    def kill(self):
        """Ends all of them without a warning."""
        self.signal(signal.SIGKILL)
        self.wait_exit()

    def terminate(self):
        """Asks all of them to end; their exit codes."""
        self.signal(signal.SIGTERM)
        return self.wait_exit()

    def wait_exit(self, patience=60.0):
        """Exit codes of all, once all have ended."""
        return [one.process.wait(patience) for one in self.processes]

    def processor_s(self):
        """Processor time of all of them."""
        return sum(map(processor_s, (one.process.pid for one in self.processes)))

    def told(self):
        """What all of them have logged, and those that were in their places before."""
        logs = {one.log.name for one in self.processes}
        return "".join(Path(log).read_text(errors="replace") for log in sorted(logs))


def boot_id(process):
    """What a process calls itself in the database."""
    return re.findall(r'boot_id"?[=:]"?([0-9a-f-]{36})', Path(process.log.name).read_text())[-1]


def processor_s(pid):
    """Processor time that a process has taken."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
