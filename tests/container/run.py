#!/usr/bin/env python3
"""Runs the image: jobs as the Kubernetes manifests state them, the service, and several on a Postgres.

    tests/container.sh

calls this with what `buildah inspect --type image` prints and the folder where the image is mounted.
"""

import json
import re
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.append(str(Path(__file__).resolve().parent))
from client import Client, end, free_port  # noqa: E402
from manifests import DEPLOY, SCHEMAS  # noqa: E402
from room import Room, files, inside, status  # noqa: E402
from shared import shared  # noqa: E402

from common import FIXTURES, Judge  # noqa: E402

LARGEST_MB = 30
REFERENCE = re.compile(r"\$\((\w+)\)")
SCENARIO = FIXTURES / "two-targets.json"


def size(judge, room):
    """What is in the image, and how large it is."""
    found = files(room.root)
    megabytes = sum(found.values()) / 1e6
    judge.demand(f"nothing but the program: {', '.join(found)}", list(found) == ["slewplan"])
    judge.demand(f"{megabytes:.1f} MB, at most {LARGEST_MB}", megabytes <= LARGEST_MB)


def confined(judge, room, work):
    """The root cannot be written, and a plan needs no file at all."""
    asked = ["solve", "-", "--progress", "none"]
    solved = room.run(asked, given=SCENARIO.read_text())
    judge.demand("solve from standard input to standard output, no volume", solved.returncode == 0)
    judge.demand("its plan is verified", json.loads(solved.stdout)["verification"]["passed"] is True)
    data = (room.volume(work / "refused"), "/data", "rw")
    refused = room.run([*asked, "-o", "/plan.json"], [data], given=SCENARIO.read_text())
    judge.demand(f"no file on the root: {last(refused.stderr)}", "Read-only file system" in refused.stderr)
    judge.demand("which is an error", refused.returncode == 1)


def jobs(judge, room, work):
    """Every job of the manifests, pod by pod; what their containers are given and leave behind."""
    scenario = work / "scenario"
    scenario.mkdir()
    (scenario / "scenario.json").write_text(SCENARIO.read_text())
    data = room.volume(work / "answers")
    sources = {"scenario": scenario, "data": data}
    for path in sorted((DEPLOY / "kubernetes").glob("*.yaml")):
        for document in yaml.safe_load_all(path.read_text(encoding="utf-8")):
            if document["kind"] == "Job":
                run_pods(judge, room, path.name, document["spec"], sources)
    plan = json.loads((data / "plan.json").read_text())
    judge.demand("the plan in the volume is optimal", plan["status"] == "optimal")
    judge.demand("and verified", plan["verification"]["passed"] is True)
    whole = legs(room.run(["legs", "-"], given=SCENARIO.read_text()).stdout)
    parts = [legs(part.read_text()) for part in sorted(data.glob("legs-*.json"))]
    sizes = ", ".join(str(len(part)) for part in parts)
    judge.demand(f"{len(parts)} parts of {sizes} are the {len(whole)} legs", sorted(sum(parts, [])) == sorted(whole))


def run_pods(judge, room, name, spec, sources):
    """The pods of a job, one after another."""
    container = spec["template"]["spec"]["containers"][0]
    mounts = [
        (sources[mount["name"]], mount["mountPath"], "ro" if mount.get("readOnly") else "rw")
        for mount in container["volumeMounts"]
    ]
    for index in range(spec.get("completions", 1)):
        # What Kubernetes gives the pods of an Indexed Job, and what it does with $(NAME) in arguments.
        given = {"JOB_COMPLETION_INDEX": str(index)} if spec.get("completionMode") == "Indexed" else {}
        arguments = [REFERENCE.sub(lambda found: given.get(found[1], found[0]), part) for part in container["args"]]
        ended = room.run(arguments, mounts, **given)
        if ended.returncode != 0:
            print(ended.stderr, file=sys.stderr)
        judge.demand(f"{name}, pod {index}: {' '.join(arguments)}", ended.returncode == 0)


def legs(table):
    """The legs of a table: ends, and time to a microsecond."""
    return [(leg["from"], leg["to"], round(leg["duration_s"], 6)) for leg in json.loads(table)["legs"]]


def last(text):
    """The last line: the message of a program that also logs."""
    return text.strip().rpartition("\n")[2]


def service(judge, room, work):
    """The service on one volume: refused without a key, at work, healthy, ended, and on again."""
    data = room.volume(work / "service")
    mounts = [(data, "/data", "rw")]
    port = free_port()
    # As the image has it, but for the port.
    listen = {"SLEWPLAN_LISTEN": f"0.0.0.0:{port}"}
    command = room.image["Cmd"]
    check = room.image["Healthcheck"]["Test"][2:]
    open_to_all = room.run(command, mounts, **listen)
    judge.demand(f"without a key it does not start: {last(open_to_all.stderr)}", open_to_all.returncode == 2)
    made = room.run(["keys", "create", "mission-a"], mounts)
    judge.demand(f"a key is made in the volume: {last(made.stderr)}", made.returncode == 0)
    before = files(room.root)

    with open(work / "log", "a", encoding="utf-8") as log:
        started = room.start(command, mounts, log, **listen)
        judge.demand("with a key it starts", f"0.0.0.0:{port}" in started.stdout.readline())
        confinement(judge, room, inside(started))
        judge.demand("the image's health check finds it well", room.run(check, **listen).returncode == 0)
        client = Client(port, made.stdout.split()[0])
        judge.demand("/health/ready answers 200", client.ask("GET", "/health/ready")[0] == 200)
        judge.demand("who has no key is refused", Client(port).ask("GET", "/v1/plans")[0] == 401)
        form = {"Content-Type": "application/json", "Prefer": "wait=60"}
        answered, plan = client.ask("POST", "/v1/plans", SCENARIO.read_text(), **form)
        judge.demand("a scenario is solved over HTTP", (answered, plan["status"]) == (200, "optimal"))
        judge.demand("and its plan is verified", plan["verification"]["passed"] is True)
        end(judge, started)
        judge.demand("the health check finds it gone", room.run(check, **listen).returncode == 1)
        strange = [name for name in files(data) if not name.startswith("slewplan.db")]
        judge.demand(f"the volume has its database and nothing else {strange}", not strange)
        judge.demand("nothing else was written", files(room.root) == before)

        again = room.start(command, mounts, log, **listen)
        again.stdout.readline()
        _, listed = client.ask("GET", "/v1/plans")
        states = [job["state"] for job in listed["plans"]]
        judge.demand("on the same volume it has its plan again", states == ["succeeded"])
        end(judge, again)


def confinement(judge, room, process):
    """What the process within may do."""
    facts = status(process)
    user, group = room.user.split(":")
    judge.demand(
        f"user {facts['Uid']}, groups {facts['Gid']} {facts['Groups']}",
        set(facts["Uid"].split()) == {user} and set(facts["Gid"].split()) == {group} and not facts["Groups"],
    )
    nothing = all(int(facts[f"Cap{kind}"], 16) == 0 for kind in ("Inh", "Prm", "Eff", "Amb"))
    judge.demand("no capabilities, no way to get any", nothing and facts["NoNewPrivs"] == "1")
    judge.demand("the first process of its namespace", facts["NSpid"].split()[-1] == "1")


def main():
    image = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))["Docker"]["config"]
    room = Room(sys.argv[2], image)
    judge = Judge()
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        # Others than root have to find their way through it.
        work.chmod(0o755)
        size(judge, room)
        for part in (confined, jobs, service, shared):
            part(judge, room, work)
    judge.end()


if __name__ == "__main__":
    SCHEMAS.enter()
    import yaml

    main()
