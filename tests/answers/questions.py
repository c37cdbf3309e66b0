"""What the program is asked on its command line: everything that it can do, with the fixtures."""

import json
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "load"), str(HERE.parent / "trust")]

from harness import strip  # noqa: E402
from service import FIXTURES, binary, fixture  # noqa: E402

FORMATS = ("csv", "aem-kvn", "aem-xml", "basilisk", "open-mct", "stk", "wheel-rpm")
KINDS = ("rest_to_rest", "lower_bound", "certified")
COMMANDS = ("solve", "slew", "study", "legs", "import", "validate", "verify", "certify", "export", "plot", "serve", "health",
            "backup", "keys", "openapi")


def asked(*arguments, given=None):
    """Exit code, output and messages of a command."""
    text = given if given is None or isinstance(given, bytes) else json.dumps(given).encode()
    done = subprocess.run([binary(), *map(str, arguments)], input=text, capture_output=True, timeout=900)
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def scenarios():
    """The scenarios by name; time limits, which depend on the machine, become limits of nodes."""
    paths = [*FIXTURES.glob("*.json"), *(FIXTURES / "gallery").glob("*.json")]
    found = {path.stem: json.loads(path.read_text()) for path in sorted(paths)}
    for seed in range(2):
        found[f"strip-26-{seed}"] = strip(26, 0.5 * seed)
    for name, scenario in found.items():
        limit = 40 if name.startswith("strip") else 400
        scenario["options"] = {**scenario.get("options", {}), "time_limit_s": None, "node_limit": limit, "alternatives": 2}
    return found


def plans(work):
    """Plans, and what is made of them; also with a given order, signed quaternions and reserves."""
    for name, scenario in scenarios().items():
        code, text, messages = asked("solve", "-", "--threads", 2, "--progress", "none", given=scenario)
        yield f"solve {name}", code, text, messages
        (work / "scenario.json").write_text(json.dumps(scenario))
        (work / "plan.json").write_text(text)
        yield f"validate {name}", *asked("validate", work / "scenario.json", "--format", "json")
        if not text or name.startswith("strip"):
            continue
        files = (work / "scenario.json", work / "plan.json")
        yield f"verify {name}", *asked("verify", *files)
        yield f"plot {name}", *asked("plot", files[1], "--scenario", files[0])
        for kind in FORMATS:
            yield f"export {kind} {name}", *asked("export", *files, "--format", kind)
        for kind in KINDS:
            yield f"legs {kind} {name}", *asked("legs", files[0], "--kind", kind, "--progress", "none")
    code, text, messages = asked("solve", FIXTURES / "two-targets.json", "--progress", "none")
    (work / "plan.json").write_text(text)
    yield "certify", *asked("certify", FIXTURES / "two-targets.json", work / "plan.json", "--progress", "none")
    for text in ("--summary", "--help"):
        yield f"solve {text}", *asked("solve", FIXTURES / "two-targets.json", "--progress", "none", text)
    ordered = fixture("olivares-a")
    ordered["options"] = {"time_limit_s": None, "torque_authority": 0.9, "momentum_authority": 0.8}
    for place, target in enumerate(reversed(ordered["targets"])):
        target["position"] = place + 1
    yield "solve in a given order", *asked("solve", "-", "--progress", "none", given=ordered)


def slews_and_studies(work):
    documents = [(("slew",), path) for path in sorted((FIXTURES / "slews").glob("*.json"))]
    for path in sorted((FIXTURES / "studies").glob("*.json")):
        documents.append((("study", "envelopes" if "envelopes" in path.stem else path.stem), path))
    for command, path in documents:
        code, text, messages = asked(*command, path)
        yield f"{' '.join(command)} {path.stem}", code, text, messages
        (work / "answer.json").write_text(text)
        if code == 0:
            yield f"plot {' '.join(command)} {path.stem}", *asked("plot", work / "answer.json")


def leg_files(work):
    """A table in parts, joined, and put into a database."""
    scenario = FIXTURES / "two-targets.json"
    for part in (1, 2):
        made = asked("legs", scenario, "--trajectories", "--shard", f"{part}/2", "--progress", "none", "-o", work / f"{part}.json")
        yield f"legs in parts {part}", *made
    yield "legs joined", *asked("legs", "--merge", work / "1.json", work / "2.json", "-o", work / "all.json")
    yield "legs in one file", 0, (work / "all.json").read_text(), ""
    yield "import", *asked("import", work / "all.json", "--database", work / "imported.db")
    solved = asked("solve", scenario, "--database", work / "imported.db", "--progress", "none")
    yield "solve with imported legs", *solved


def words():
    """What the program says about itself."""
    yield "openapi", *asked("openapi")
    for command in COMMANDS:
        yield f"help {command}", *asked(command, "--help")


def everything(work):
    yield from words()
    yield from plans(work)
    yield from slews_and_studies(work)
    yield from leg_files(work)
