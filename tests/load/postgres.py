"""A Postgres of its own for tests in Python, by tests/postgres.sh. Needs its programs and nothing else."""

import json
import os
import shutil
import subprocess
import time
from glob import glob
from pathlib import Path

from service import ROOT

SOCKET = ".s.PGSQL.5432"
RETRIES = 300


def program(name):
    """One of the programs of Postgres, which Debian keeps out of PATH."""
    return shutil.which(name) or next(iter(sorted(glob(f"/usr/lib/postgresql/*/bin/{name}"), reverse=True)), name)


def literal(value):
    """A value as SQL."""
    return str(value) if isinstance(value, int) else "'" + str(value).replace("'", "''") + "'"


def written_out(query, parameters):
    """A query with its values in place of the question marks."""
    for value in parameters:
        query = query.replace("?", literal(value), 1)
    return query


class Postgres:
    """A server, which ends with this process."""

    def __init__(self, *settings, folder=None, environment=None):
        """Settings are arguments of `postgres`; it makes its own folder, within the given one if any."""
        environment = {**os.environ, **(environment or {}), **({"TMPDIR": str(folder)} if folder else {})}
        options = [part for setting in settings for part in ("-c", setting)]
        self.script = subprocess.Popen(
            [str(ROOT / "tests" / "postgres.sh"), *options],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
        )
        self.folder = self.script.stdout.readline().strip()
        if not self.folder:
            raise RuntimeError("Postgres is not installed, or does not start")
        self.databases = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.script.stdin.close()
        self.script.wait(60)

    @property
    def socket(self):
        """The socket that it listens at."""
        return Path(self.folder) / SOCKET

    @property
    def owner(self):
        """Whom the server runs as."""
        return Path(self.folder).owner()

    def _ask(self, command):
        print(command, file=self.script.stdin, flush=True)
        return self.script.stdout.readline().strip()

    def kill(self):
        """Ends it without a shutdown."""
        if self._ask("kill") != "killed":
            raise RuntimeError("Postgres cannot be ended")

    def start(self):
        """Starts it again."""
        if self._ask("start") != self.folder:
            raise RuntimeError("Postgres does not start again")

    def answers(self):
        """Whether it is there, though it may not take connections yet."""
        asked = [program("pg_isready"), "--quiet", f"--host={self.folder}"]
        return subprocess.run(asked).returncode != 2

    def restart(self):
        """Starts it again, however it ended."""
        self.kill()
        self.start()

    def url(self, database="postgres", address=None):
        """The address of a database, by its socket or by another way to the server."""
        if address:
            return f"postgres://slewplan@{address}/{database}?sslmode=disable"
        return f"postgres://slewplan@localhost/{database}?host={self.folder}"

    def new_database(self, suffix=""):
        """The name of a new, empty database; further words of the statement may be given."""
        self.databases += 1
        name = f"test_{self.databases}"
        self.execute("postgres", f"CREATE DATABASE {name} {suffix}")
        return name

    def execute(self, database, *statements):
        """Executes statements, each by itself; what they print."""
        command = [program("psql"), "--no-psqlrc", "--quiet", "--tuples-only", "--no-align", "--set=ON_ERROR_STOP=1"]
        commands = [f"--command={statement}" for statement in statements]
        for _ in range(RETRIES):
            done = subprocess.run([*command, *commands, self.url(database)], capture_output=True, text=True)
            # It is starting up, or recovers from a crash.
            if "the database system is" not in done.stderr:
                break
            time.sleep(0.1)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.strip())
        return done.stdout

    def rows(self, database, query, *parameters):
        """The rows of a query."""
        query = written_out(query, parameters)
        text = self.execute(database, f"SELECT coalesce(json_agg(row_to_json(t)), '[]') FROM ({query}) AS t")
        # Columns may have equal names: pairs, not members.
        found = json.loads(text, object_pairs_hook=lambda pairs: tuple(value for _, value in pairs))
        return list(found)

    def backends(self, database):
        """The processes of the server that serve connections to a database."""
        query = "SELECT pid FROM pg_stat_activity WHERE datname = ? AND pid <> pg_backend_pid() ORDER BY random()"
        return [pid for (pid,) in self.rows("postgres", query, database)]
