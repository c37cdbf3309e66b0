"""Promises about answers: none that is wrong, none that is late."""

import json
import math
import os
import random
import subprocess
import time
from pathlib import Path

from harness import FIXTURES, ROOT, Row, binary, elsewhere, gate, missing, service

elsewhere("N5", "inertias and attitudes that cannot be are refused", "100 %", "cargo test -p slewplan-solver")
missing("N2", "every status is reached by a test", "100 %", "not measured")


def random_legs(count):
    """Scenarios of the random suite, so many of each spacecraft."""
    build = ["cargo", "build", "--quiet", "--locked", "--package", "slewplan-tests", "--example", "random_legs"]
    subprocess.run(build, cwd=ROOT, check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    lines = subprocess.run([target / "debug" / "examples" / "random_legs", str(count)], capture_output=True, text=True, check=True)
    return [json.loads(line) for line in lines.stdout.splitlines()]


def is_true(plan):
    """Whether a plan passes what it promises; its parts make up the whole."""
    waits = sum(passage["departure_s"] - passage["time_s"] for passage in plan["passages"])
    parts = sum(leg["duration_s"] for leg in plan["legs"]) + waits
    check = plan["verification"]
    return (
        check["passed"]
        and check["max_attitude_error_rad"] <= 1e-6
        and check["max_rate_error_rad_s"] <= 1e-7
        and max(check["max_wheel_speed_excess"], check["max_torque_excess"], check["max_rate_excess"]) <= 1e-6
        and math.isclose(parts, plan["total_time_s"], rel_tol=1e-9)
        and plan["lower_bound_s"] <= plan["total_time_s"] * (1 + 1e-9)
    )


@gate("N1")
def no_success_is_false(scale):
    """Every plan that is called optimal or feasible passes; random and curated problems."""
    scenarios = [json.loads(path.read_text()) for path in sorted(FIXTURES.glob("*.json"))]
    for scenario in scenarios:
        scenario["options"] = {**scenario.get("options", {}), "time_limit_s": scale.of(30, 2)}
    scenarios += random_legs(scale.of(50, 1))
    wrong, states = 0, {}
    with service(scale.database("n1"), "--queue-limit", "100000") as running:
        jobs = [running.submit(scenario) for scenario in scenarios]
        for job in jobs:
            state = running.wait_end(job, patience=3600.0)["state"]
            states[state] = states.get(state, 0) + 1
            if state in ("succeeded", "stopped"):
                plan = running.request("GET", f"/v1/plans/{job}/result")[1]
                wrong += not is_true(plan)
    counts = ", ".join(f"{count} {state}" for state, count in sorted(states.items()))
    return [Row("N1", f"plans that do not hold, of {len(jobs)} problems ({counts})", str(wrong), "0", wrong == 0 and states.get("succeeded", 0) > 0)]


@gate("N8")
def deadlines_hold(scale):
    """Random time limits over the fixtures: the command ends in time."""
    random_state, late, failed = random.Random(8), [], 0
    paths = sorted(FIXTURES.glob("*.json"))
    for number in range(scale.of(100, 8)):
        limit = 0.1 * 300.0 ** random_state.random() if not scale.short else random_state.uniform(0.1, 1.0)
        begin = time.monotonic()
        done = subprocess.run(
            [binary(), "solve", paths[number % len(paths)], "--time-limit", f"{limit:.3f}", "--format", "json"],
            capture_output=True,
        )
        late.append(time.monotonic() - begin - limit)
        if done.returncode in (0, 4):
            failed += not is_true(json.loads(done.stdout))
        else:
            failed += done.returncode != 1
    worst = max(late)
    return [
        Row("N8", f"latest end after its deadline, of {len(late)}", f"{1e3 * worst:.0f} ms", "250 ms", worst <= 0.25, timed=True),
        Row("N8", "ends with a wrong plan or an exit code that is not documented", str(failed), "0", failed == 0),
    ]
