#!/usr/bin/env python3
"""Which small changes of the program do its tests not notice?

    python3 tests/mutants/run.py [--sample 40] [--seed 1] [--seconds 60] [MODULE ...]

Takes a sample of the changes of every module (operators, negated conditions, left-out statements,
constant results), builds a copy of the project with all of them, each behind a switch, and looks which
tests get to which change. Then each change is switched on, and these tests run, the quickest first,
until one fails or the seconds are used up. Prints a table and the changes that no test noticed, but for
those that `equivalent.txt` explains.
"""

import argparse
import contextlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "peers"))
from environment import Environment  # noqa: E402

Environment("mutants", ("tree-sitter==0.26.1", "tree-sitter-rust==0.24.2"), ("tree_sitter",), "MUTANTS_VENV").enter()

from rewriting import changes, rewritten  # noqa: E402

MODULES = {
    "checker": ["solver/src/checker.rs", "solver/src/checker"],
    "certified": ["solver/src/bounds/certified.rs", "solver/src/bounds/certified", "solver/src/model/dynamics.rs"],
    "certify": ["solver/src/bounds/certify.rs", "solver/src/bounds/certify", "solver/src/tour/planner/certificate.rs", "solver/src/tour/planner/certificate"],
    "kinematic_bound": ["solver/src/bounds/kinematic.rs", "solver/src/bounds/kinematic"],
    "canonical": ["solver/src/tour/planner/canonical.rs", "solver/src/tour/planner/places.rs", "solver/src/tour/planner/legs.rs"],
    "order_rules": ["solver/src/model/order_rules.rs", "solver/src/model/scenario/order.rs"],
    "search": ["solver/src/tour/order.rs", "solver/src/tour/order"],
    "store": ["server/src/store.rs", "server/src/store"],
    "reader": ["server/src/documents/reader.rs", "server/src/documents/reader", "server/src/documents/scenario.rs",
               "server/src/documents/scenario"],
}
SWITCH = '''//! Which change is switched on.
#![allow(missing_docs, dead_code)]
use std::io::Write;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
static SEEN: [AtomicBool; COUNT] = [const { AtomicBool::new(false) }; COUNT];
static CHOSEN: OnceLock<usize> = OnceLock::new();
pub(crate) fn is(change: usize) -> bool {
    let chosen = *CHOSEN.get_or_init(|| std::env::var("MUTATION").map_or(0, |n| n.parse().unwrap_or(0)));
    if chosen == 0 && !SEEN[change].swap(true, Relaxed)
        && let Ok(path) = std::env::var("MUTATION_TRACE")
        && let Ok(mut file) = std::fs::OpenOptions::new().create(true).append(true).open(path)
    {
        let _ = file.write_all(format!("{change}\\n").as_bytes());
    }
    chosen == change
}
'''
CRATES = {"solver": "lib.rs", "server": "main.rs"}
# A test that takes so many times as long as it should, and so many seconds more, has noticed the change.
SLOWER, LATER = 10, 20


def sources(names):
    for name in names:
        path = ROOT / name
        found = sorted(path.rglob("*.rs")) if path.is_dir() else [path] * path.exists()
        yield from (f for f in found if f.name != "tests.rs" and "tests" not in f.relative_to(ROOT).parts)


def sampled(module, count, draw):
    """Some of the changes of a module."""
    found = []
    for path in sources(MODULES[module]):
        found += changes(str(path.relative_to(ROOT)), path.read_bytes())
    return found, draw.sample(found, min(count, len(found)))


def copied(folder):
    """A copy of the project's files; the compiler's own folder stays."""
    folder.mkdir(parents=True, exist_ok=True)
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    for name in listed.stdout.split():
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            content = (ROOT / name).read_bytes()
            if not (folder / name).exists() or (folder / name).read_bytes() != content:
                (folder / name).write_bytes(content)


def written(folder, chosen):
    """Writes all changes into the copy."""
    count = max(change.number for change in chosen) + 1
    for crate, root in CRATES.items():
        switch = SWITCH.replace("COUNT", str(count))
        (folder / crate / "src" / "mutation.rs").write_text(switch)
        original = (ROOT / crate / "src" / root).read_text()
        (folder / crate / "src" / root).write_text(original + "\nmod mutation;\n")
    paths = {change.path for change in chosen}
    for path in paths:
        here = [change for change in chosen if change.path == path]
        (folder / path).write_text(rewritten((ROOT / path).read_bytes(), here))


def built(folder, chosen):
    """Builds the tests with all changes that compile; those, and the programs."""
    while True:
        written(folder, chosen)
        command = ["cargo", "test", "--workspace", "--no-run", "--message-format=json"]
        environment = {**os.environ, "CARGO_TARGET_DIR": str(folder / "target")}
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
        messages = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
        if done.returncode == 0:
            tests = [m for m in messages if m["reason"] == "compiler-artifact" and m.get("executable") and m["profile"]["test"]]
            return chosen, [(m["executable"], str(Path(m["manifest_path"]).parent)) for m in tests]
        wrong = set()
        for message in messages:
            if message["reason"] == "compiler-message" and message["message"]["level"] == "error":
                for span in message["message"]["spans"]:
                    wrong.add((span["file_name"], span["line_start"]))
        kept = [change for change in chosen if (change.path, change.line) not in wrong]
        print(f"{len(chosen) - len(kept)} changes do not compile", file=sys.stderr)
        if len(kept) == len(chosen):
            sys.exit(done.stderr[-5000:] + "\n".join(map(str, sorted(wrong))))
        for path in {change.path for change in chosen} - {change.path for change in kept}:
            shutil.copy(ROOT / path, folder / path)
        chosen = kept


def ran(test, variables, limit=None):
    """Whether a test passes, and in what time, s."""
    program, folder, name = test
    begin = time.monotonic()
    # With what it starts, which a change may keep from ending, in a group of its own.
    child = subprocess.Popen([program, "--exact", name, "--test-threads=1"], cwd=folder, start_new_session=True,
                             env={**os.environ, **variables}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        passed = child.wait(limit) == 0
    except subprocess.TimeoutExpired:
        passed = False
    took = time.monotonic() - begin
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)
    child.wait()
    return passed, took


def traced(folder, programs):
    """Every test with its time, and the changes that it gets to."""
    tests = []
    for program, place in programs:
        listed = subprocess.run([program, "--list", "--format=terse"], cwd=place, capture_output=True, text=True)
        names = [line.removesuffix(": test") for line in listed.stdout.splitlines() if line.endswith(": test")]
        tests += [(program, place, name) for name in names]

    def trace(item):
        index, test = item
        file = folder / "target" / f"trace-{index}"
        file.unlink(missing_ok=True)
        passed, seconds = ran(test, {"MUTATION_TRACE": str(file)})
        if not passed:
            print(f"fails without any change: {test[2]}", file=sys.stderr)
        reached = {int(line) for line in file.read_text().split()} if file.exists() else set()
        return test, seconds, reached if passed else set()

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return sorted(pool.map(trace, enumerate(tests)), key=lambda known: known[1])


def judged(change, known, seconds):
    """The name of the test that notices a change; else how many got to it, and how many ran."""
    reaching = [(test, usual) for test, usual, reached in known if change.number in reached]
    used, run = 0.0, 0
    for test, usual in reaching:
        if used > seconds:
            break
        passed, took = ran(test, {"MUTATION": str(change.number)}, SLOWER * usual + LATER)
        used, run = used + took, run + 1
        if not passed:
            return test[2], len(reaching), run
    return None, len(reaching), run


def explained():
    """What `equivalent.txt` says of changes that change nothing: the place, and the change or * for any."""
    lines = (Path(__file__).parent / "equivalent.txt").read_text().splitlines()
    known = [line.split(" | ") for line in lines if line and not line.startswith("#")]
    return {(path, before, after) for path, before, after, _ in known}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("modules", nargs="*", metavar="MODULE", help=", ".join(MODULES))
    parser.add_argument("--sample", type=int, default=40, help="changes of each module")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=60, help="of tests for each change")
    parser.add_argument("--folder", type=Path, default=Path.home() / ".cache" / "slewplan" / "mutants")
    options = parser.parse_args()
    draw, chosen, module_of, totals = random.Random(options.seed), [], {}, {}
    for module in options.modules or MODULES:
        found, some = sampled(module, options.sample, draw)
        totals[module] = len(found)
        for change in some:
            change.number = len(chosen) + 1
            module_of[change.number] = module
            chosen.append(change)
    copied(options.folder)
    chosen, programs = built(options.folder, chosen)
    known = traced(options.folder, programs)
    print(f"{len(known)} tests, {len(chosen)} changes", file=sys.stderr)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        verdicts = list(pool.map(lambda change: judged(change, known, options.seconds), chosen))
    equivalent, left = explained(), []
    print("| module | changes possible | tried | noticed | equivalent | not noticed |\n|---|---|---|---|---|---|")
    for module, possible in totals.items():
        mine = [(c, v) for c, v in zip(chosen, verdicts) if module_of[c.number] == module]
        missed = [(c, v) for c, v in mine if v[0] is None]
        same = [c for c, _ in missed if {(c.path, c.before, c.after), (c.path, c.before, "*")} & equivalent]
        left += [(c, v) for c, v in missed if c not in same]
        noticed, open_ = len(mine) - len(missed), len(missed) - len(same)
        share = f"{open_} ({100 * open_ / max(1, len(mine)):.0f} %)"
        print(f"| {module} | {possible} | {len(mine)} | {noticed} | {len(same)} | {share} |")
    for change, (_, reaching, run) in left:
        print(f"{change}   [{run} of {reaching} tests that get there]")


main()
