#!/usr/bin/env python3
"""What a thousand idle workers cost their Postgres: statements a second, its processors and memory, and how much
longer a job takes among them.

    python3 tests/load/idle.py [CONNECTIONS]

1000 connections by default. What one idle worker asks is read from the log of the server; `pgbench` repeats that on
every connection, at the same pace, and listens for notices as a worker does. It does not answer them: what a notice
makes a thousand workers ask is not in these figures.
"""

import re
import statistics
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path

from postgres import Postgres, program
from service import Service, Table, fixture
from shared import DATABASE, TINY, children, processor_s
from worker import Worker

ALONE_S, AMONG_S, SETTLED_S = 30.0, 60.0, 40.0
TURNS = 40
# Milliseconds, and a statement with its parameters, by `log_line_prefix=%n `.
EXECUTED = re.compile(r"^(\d+\.\d+) LOG:  (?:execute [^:]*|statement): +(.*(?:\n(?!\d+\.\d+ ).*)*)", re.M)
PARAMETERS = re.compile(r"\n\d+\.\d+ DETAIL:  (?:P|p)arameters: (.*)")
PARAMETER = re.compile(r"\$(\d+) = ('(?:[^']|'')*'|NULL)")


def asked_by_a_worker(postgres):
    """What an idle worker asks within a time: pairs of seconds since the begin and a statement."""
    log = Path(postgres.folder) / "server.log"
    time.sleep(5.0)
    postgres.execute(DATABASE, "ALTER SYSTEM SET log_statement = 'all'", "SELECT pg_reload_conf()")
    time.sleep(0.5)
    since, begin = time.time(), log.stat().st_size
    time.sleep(ALONE_S)
    text = log.read_bytes()[begin:].decode(errors="replace")
    postgres.execute(DATABASE, "ALTER SYSTEM SET log_statement = 'none'", "SELECT pg_reload_conf()")
    found = []
    for match in EXECUTED.finditer(text):
        statement = " ".join(match.group(2).split())
        if told := PARAMETERS.match(text, match.end()):
            values = dict(PARAMETER.findall(told.group(1)))
            statement = re.sub(r"\$(\d+)", lambda place: values[place.group(1)], statement)
        found.append((float(match.group(1)) - since, statement))
    return found


def script(asked):
    """The same for `pgbench`, over and over; the connections begin at different times."""
    wait = ["\\if not :begun", f"\\set pause random(0, {int(1e3 * ALONE_S)})", "\\sleep :pause ms"]
    lines = [*wait, "LISTEN slewplan;", "\\set begun true", "\\endif"]
    now = 0.0
    for at_s, statement in asked:
        lines += [f"\\sleep {max(0, round(1e3 * (at_s - now)))} ms", f"{statement};"]
        now = at_s
    return "\n".join([*lines, f"\\sleep {max(0, round(1e3 * (ALONE_S - now)))} ms"])


def turn_ms(service):
    """The median time of a job from its submission to its end."""
    times = []
    for _ in range(TURNS):
        begin = time.monotonic()
        status, _ = service.request("POST", "/v1/plans", fixture(TINY), {"Prefer": "wait=10"})
        if status != 200:
            raise RuntimeError(f"a turn was answered with {status}")
        times.append(1e3 * (time.monotonic() - begin))
    return statistics.median(times)


class Server:
    """The processes of the server, and what they have taken."""

    def __init__(self, postgres):
        self.postgres = postgres
        self.pid = int((Path(postgres.folder) / "data" / "postmaster.pid").read_text().split()[0])

    def processes(self):
        return [self.pid, *children(self.pid)]

    def processor_s(self):
        return sum(map(processor_s, self.processes()))

    def memory_mb(self):
        """What belongs to its processes, shared pages divided among them."""
        found = 0
        for pid in self.processes():
            text = Path(f"/proc/{pid}/smaps_rollup").read_text()
            found += int(re.search(r"^Pss: +(\d+) kB", text, re.M).group(1))
        return found / 1024

    def statements(self):
        """Each is a transaction of its own."""
        ((count,),) = self.postgres.rows(DATABASE, f"SELECT xact_commit AS count FROM pg_stat_database WHERE datname = '{DATABASE}'")
        return count


def main(connections):
    table = Table()
    with ExitStack() as stack:
        postgres = stack.enter_context(Postgres(f"max_connections={connections + 100}", "log_line_prefix=%n "))
        stack.enter_context(Worker(postgres.url(), "--log", "error"))
        asked = asked_by_a_worker(postgres)
        table.row("statements of an idle worker a second", f"{len(asked) / ALONE_S:.2f}", "", bool(asked))
        service = stack.enter_context(Service(postgres.url(), "--no-worker", "--log", "error"))
        server = Server(postgres)
        turn_ms(service)
        alone, memory = turn_ms(service), server.memory_mb()
        path = Path(postgres.folder) / "idle.sql"
        path.write_text(script(asked))
        command = [program("pgbench"), "--no-vacuum", f"--client={connections}", "--jobs=2", "--define=begun=false", f"--file={path}"]
        command += [f"--time={int(SETTLED_S + AMONG_S + ALONE_S)}", postgres.url()]
        crowd = stack.enter_context(subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True))
        stack.callback(crowd.terminate)
        time.sleep(SETTLED_S)
        begin, count, taken = time.monotonic(), server.statements(), server.processor_s()
        time.sleep(AMONG_S)
        took = time.monotonic() - begin
        rate, busy = (server.statements() - count) / took, (server.processor_s() - taken) / took
        if crowd.poll() is not None:
            raise RuntimeError(crowd.stderr.read())
        table.row(f"the same of {connections}", f"{rate:.0f}", "", True)
        table.row("processors of the server that these take", f"{busy:.2f}", "", True)
        grown = 1024 * (server.memory_mb() - memory) / connections
        table.row("memory of the server for each of them", f"{grown:.0f} KiB", "", True)
        among = turn_ms(service)
        table.row("a turn from its submission to its end, alone, among them", f"{alone:.0f} ms, {among:.0f} ms", "", True)
    table.exit()


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000)
