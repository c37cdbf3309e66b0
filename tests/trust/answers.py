"""Promises about answers: none that is wrong, none that is late."""

import json
import math
import random
import re
import subprocess
import time

from harness import HTTP_ALIKE, FIXTURES, ROOT, Row, binary, elsewhere, example, gate, service

elsewhere("N5", "inertias and attitudes that cannot be are refused", "100 %", "cargo test -p slewplan-solver", HTTP_ALIKE)


def random_legs(count):
    """Scenarios of the random suite, so many of each spacecraft."""
    lines = subprocess.run([example("scenarios"), "legs", str(count)], capture_output=True, text=True, check=True)
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


@gate("N1", of_a_file=HTTP_ALIKE)
def no_success_is_false(scale):
    """Every plan that is called optimal or feasible passes; random and curated problems."""
    scenarios = [json.loads(path.read_text()) for path in sorted(FIXTURES.glob("*.json"))]
    for scenario in scenarios:
        scenario["options"] = {**scenario.get("options", {}), "time_limit_s": scale.of(10, 2)}
    # One leg each: a thousand of them take a minute or two.
    scenarios += random_legs(scale.of(50, 1))
    wrong, states = 0, {}
    with service(scale.database("n1"), "--queue-limit", "100000") as running:
        for scenario in scenarios:
            job = running.submit(scenario)
            state = running.wait_end(job, patience=600.0)["state"]
            states[state] = states.get(state, 0) + 1
            if state in ("succeeded", "stopped"):
                plan = running.request("GET", f"/v1/plans/{job}/result")[1]
                wrong += not is_true(plan)
    counts = ", ".join(f"{count} {state}" for state, count in sorted(states.items()))
    return [Row("N1", f"plans that do not hold, of {len(scenarios)} problems ({counts})", str(wrong), "0", wrong == 0 and states.get("succeeded", 0) > 0)]


def lines_of(path, begin):
    """The indented lines of an item of a source."""
    text = (ROOT / path).read_text()
    listed = text[text.index(begin) :]
    return listed[: listed.index("\n}")]


def codes_of(path, enumeration):
    """Variants of an enumeration and their texts, which are the names in snake case."""
    names = re.findall(r"^ {4}(\w+),$", lines_of(path, f"enum {enumeration} {{"), re.MULTILINE)
    return {name: re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower() for name in names}


def listed_codes(path, macro):
    """Variants and texts, as a macro lists them."""
    return dict(re.findall(r'^ {4}(\w+) = "(\w+)"', lines_of(path, f"\n{macro}! {{"), re.MULTILINE))


def texts_of_tests():
    """All tests, and of the other sources what only tests see."""
    texts = [path.read_text() for path in (ROOT / "tests").rglob("*") if path.suffix in (".rs", ".py")]
    for path in [*(ROOT / "solver/src").rglob("*.rs"), *(ROOT / "server/src").rglob("*.rs")]:
        text, is_test = path.read_text(), "tests" in path.parts or path.name == "tests.rs"
        _, mark, rest = text.partition("#[cfg(test)]\nmod tests {")
        texts.append(text if is_test else mark + rest)
    return "\n".join(texts)


@gate("N2", of_a_file=HTTP_ALIKE)
def every_failure_is_named(scale):
    """Every status and code is named by a test, and no number of an answer is not one."""
    tests, rows = texts_of_tests(), []
    optimiser = (ROOT / "solver/src/nlp/status.rs").read_text().partition("impl NlpStatus")[2].partition("\n}")[0]
    statuses = re.findall(r'(\w+)(?:\(_\))?\)? => "(\w+)"', optimiser)
    for what, codes in {
        "states of jobs": codes_of("server/src/store/rows.rs", "JobState"),
        "codes of problems": codes_of("solver/src/model/problem.rs", "Code"),
        "codes of HTTP errors": listed_codes("server/src/api/error.rs", "error_codes"),
        "statuses of the optimiser": dict(statuses),
    }.items():
        unnamed = [text for name, text in codes.items() if f'"{text}"' not in tests and f"[{text}]" not in tests and f"::{name}" not in tests]
        for text in unnamed:
            print(f"    no test names {text}")
        rows.append(Row("N2", f"{what} that no test names, of {len(codes)}", str(len(unnamed)), "0", not unnamed and bool(codes)))
    wrong, count = 0, 0
    for path in sorted(FIXTURES.glob("*.json")):
        done = subprocess.run([binary(), "solve", path, "--time-limit", "2", "--format", "json"], capture_output=True, text=True)
        if done.returncode in (0, 4):
            count += 1
            wrong += bool(re.search(r"\b(NaN|[Ii]nf(inity)?)\b", done.stdout)) + any(holes(json.loads(done.stdout)))
    rows.append(Row("N2", f"numbers that are none, in {count} plans", str(wrong), "0", wrong == 0 and count > 0))
    return rows


# What may be unknown.
NULLABLE = {"certified_lower_bound_s", "rest_to_rest_duration_s", "name", "epoch", "time_system", "reference_frame"}


def holes(node, key=None):
    """Names of the values that are null and must not be."""
    if node is None and key not in NULLABLE:
        yield key
    for name, value in node.items() if isinstance(node, dict) else ((key, part) for part in node) if isinstance(node, list) else ():
        yield from holes(value, name)


@gate("N8", of_a_file=HTTP_ALIKE)
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
