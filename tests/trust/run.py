#!/usr/bin/env python3
"""Measures what the service promises and prints a table.

    tests/trust/run.py [--short] [--rounds N] [--database sqlite|postgres] [GATE...]

All gates without names. The system is one process on a file of SQLite, or two services and three workers
on a Postgres that is started for it. SLEWPLAN names a built binary; without it that of the development
profile is taken. --short does a taste of everything in about a minute; --rounds says how often what takes
long is repeated. Times are judged unless LOAD_TIMES=report. Needs Python, and for some gates root, a C
compiler or strace; what they lack makes the gate fail, not disappear.
"""

import argparse
import os
import sys
import tempfile
import time
import traceback
from pathlib import Path

import across  # noqa: F401
import answers  # noqa: F401
import chaos  # noqa: F401
import disk  # noqa: F401
import ends  # noqa: F401
import faults  # noqa: F401
import generated  # noqa: F401
import jobs  # noqa: F401
import load  # noqa: F401
import outage  # noqa: F401
import power  # noqa: F401
import resumed  # noqa: F401
import safety  # noqa: F401
import web  # noqa: F401
from harness import GATES, OF_A_FILE, Row, Scale, Server


# Measured on the way by another gate.
WITHIN = {"D6": "D5", "D9": "D5", "H2": "H1"}


def verdict(row):
    if row.holds is None:
        return "-"
    if row.holds:
        return "pass"
    if row.timed and os.environ.get("LOAD_TIMES") == "report":
        return "slow"
    return "FAIL"


def show(row):
    print(f"{row.gate:<4} {row.promise:<78} {row.measured:>16} {row.goal:>14}  {verdict(row)}", flush=True)


def measure(name, scale):
    if scale.shared and name in OF_A_FILE:
        return [Row(name, f"not on Postgres: {OF_A_FILE[name]}", "-", "-", None)]
    try:
        return GATES[name](scale)
    except Exception as error:  # one gate that cannot be measured does not hide the others
        traceback.print_exc()
        return [Row(name, "could not be measured", type(error).__name__, "-", False)]


def has_autogroups():
    """Whether the kernel gives every session the same share, and every connection of Postgres as one: solvers
    are in the way of requests then, which they are not in a container or under systemd."""
    setting = Path("/proc/sys/kernel/sched_autogroup_enabled")
    return setting.exists() and setting.read_text().strip() == "1"


def order(name):
    return "JDHNSLP".index(name[0]), int(name[1:])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--rounds", type=int)
    parser.add_argument("--database", choices=("sqlite", "postgres"), default="sqlite")
    parser.add_argument("gates", nargs="*")
    arguments = parser.parse_args()
    names = [WITHIN.get(name, name) for name in arguments.gates] or sorted(GATES, key=order)
    unknown = set(names) - set(GATES)
    if unknown:
        parser.error(f"no gate is called {', '.join(sorted(unknown))}")
    show(Row("gate", "promise", "measured", "goal", None))
    if arguments.database == "postgres" and has_autogroups():
        print("times are worse than they need be: sysctl kernel.sched_autogroup_enabled=0", file=sys.stderr)
    rows = []
    with Server() as server:
        for name in names:
            with tempfile.TemporaryDirectory(prefix="trust-") as folder:
                # A Postgres that root starts runs as another user.
                Path(folder).chmod(0o755)
                scale = Scale(arguments.short, Path(folder), arguments.rounds, server if arguments.database == "postgres" else None)
                begin = time.monotonic()
                for row in measure(name, scale):
                    show(row)
                    rows.append(row)
                print(f"     {name} took {time.monotonic() - begin:.0f} s", file=sys.stderr)
    failed = [row for row in rows if verdict(row) == "FAIL"]
    print(f"{len(rows)} rows, {len(failed)} failed")
    raise SystemExit(1 if failed else 0)


if __name__ == "__main__":
    main()
