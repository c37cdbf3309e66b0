"""The program under comparison, as the peers' scripts run it."""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "tests" / "fixtures"
# Optimal, and stopped with the best plan so far.
PLANNED = (0, 4)


def fixture(name):
    """One of the committed scenarios."""
    return json.loads((FIXTURES / f"{name}.json").read_text(encoding="utf-8"))


def binary(named=None):
    """The program: the named one, that of SLEWPLAN, or one built now."""
    named = named or os.environ.get("SLEWPLAN")
    if named:
        return named
    return built("slewplan-server") / "slewplan"


def example(name):
    """A program of tests/examples, built now."""
    return built("slewplan-tests", "--example", name) / "examples" / name


def built(package, *what):
    """The folder of what is built of a package now."""
    build = ["cargo", "build", "--release", "--locked", "--package", package, *what]
    subprocess.run(build, cwd=ROOT, check=True)
    return Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"), "release")


def solve(program, scenario, *arguments):
    """The plan, and what the whole process took: seconds on the clock and of processors."""
    return run(program, "solve", scenario, arguments, PLANNED)


def legs(program, scenario, kind):
    """Rows of the table of legs by the names of their ends."""
    # With legs that failed it ends with 1, and the table names them.
    table, _ = run(program, "legs", scenario, ["--kind", kind], (0, 1))
    return {(row["from"], row["to"]): row for row in table["legs"]}


def run(program, command, scenario, arguments, accepted, progress=True):
    with tempfile.TemporaryDirectory() as folder:
        given, answer = Path(folder, "scenario.json"), Path(folder, "answer.json")
        given.write_text(json.dumps(scenario), encoding="utf-8")
        quiet = ["--progress", "none"] if progress else []
        line = [program, command, given, "-o", answer, *quiet, *arguments]
        ran, taken = timed(line)
        if ran.returncode not in accepted:
            sys.exit(f"slewplan {command} ended with code {ran.returncode}")
        return json.loads(answer.read_text(encoding="utf-8")), taken


def timed(line):
    """The process when it has ended, and the seconds on the clock and of processors it took."""
    used, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    ran = subprocess.run(line, stdout=subprocess.PIPE, check=False)
    wall, now = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    return ran, (wall, now.ru_utime + now.ru_stime - used.ru_utime - used.ru_stime)
