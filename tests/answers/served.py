"""What the service is asked: jobs and their results, tables, refusals; and what it finds in a database of before."""

import http.client
import json
import re
import shutil

from questions import FORMATS, KINDS, asked as command, scenarios
from refusals import everything as refusals
from service import Service, fixture

# What is another one at each run: identifiers of jobs and of keys, times of day.
OWN = re.compile(r"[0-9a-f]{8}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{12}|\d{4}-\d\d-\d\dT[\d:.]+Z|^[0-9a-f]{12}(?= )", re.MULTILINE)
JOBS = ("two-targets", "olivares-a", "pyramid", "quarter-turn")
SERVED = ("/v1/limits", "/v1/version", "/openapi.yaml", "/docs/errors", "/health/live", "/health/ready", "/")


class Client:
    """Questions over one connection, and over another where the service has closed it."""

    def __init__(self, service):
        self.connection = http.client.HTTPConnection(service.host, service.port, timeout=300)

    def ask(self, method, path, body=None, headers=None):
        """Status and text of an answer, without what is another one at each run."""
        headers = {"Content-Type": "application/json", **(headers or {})} if body is not None else headers or {}
        try:
            self.connection.request(method, path, body, headers)
            answer = self.connection.getresponse()
        except (BrokenPipeError, ConnectionResetError, http.client.RemoteDisconnected):
            self.connection.close()
            self.connection.request(method, path, body, headers)
            answer = self.connection.getresponse()
        return answer.status, OWN.sub("<own>", answer.read().decode(errors="replace")), ""


def submitted(service):
    """Jobs of some scenarios, ended; by name."""
    jobs = {}
    for name in JOBS:
        jobs[name] = service.submit(scenarios()[name])
        service.wait_end(jobs[name])
    return jobs


def stored(service, jobs):
    """What a database holds: plans, scenarios, legs, spacecraft, keys."""
    client = Client(service)
    for name, job in jobs.items():
        for what in ("", "/scenario", "/result", *(f"/result?format={kind}" for kind in FORMATS)):
            yield f"stored {name} {what}", *client.ask("GET", f"/v1/plans/{job}{what}")
    yield "stored plans", *client.ask("GET", "/v1/plans")
    status, text, _ = client.ask("GET", "/v1/legs?limit=100")
    # Threads store them in any order.
    legs = sorted(json.loads(text)["legs"], key=lambda leg: leg["key"])
    yield "stored legs", status, json.dumps(legs), ""
    for leg in legs:
        yield f"stored leg {leg['key']}", *client.ask("GET", f"/v1/legs/{leg['key']}")
    yield "stored spacecraft", *client.ask("GET", "/v1/spacecraft/kept")
    code, text, messages = command("keys", "list", "--database", service.database)
    yield "stored keys", code, OWN.sub("<own>", text), messages


def asked(service):
    client = Client(service)
    for path in SERVED:
        yield f"GET {path}", *client.ask("GET", path)
    status, text, _ = client.ask("GET", "/metrics")
    yield "GET /metrics", status, "\n".join(line for line in text.splitlines() if line.startswith("#")), ""
    craft = fixture("pyramid")["spacecraft"]
    attitudes = [{"roll_pitch_yaw_deg": angles} for angles in ([0, 0, 0], [15, 0, 10], [25, -40, 50])]
    for kind in KINDS:
        for mode in ("cached_only", "compute", "cached_only"):
            query = {"spacecraft": craft, "attitudes": attitudes, "kind": kind, "mode": mode}
            yield f"legs {kind} {mode}", *client.ask("POST", "/v1/legs/query", json.dumps(query))
    scenario = fixture("two-targets")
    wrong = [("GET", "/v1/plans/x"), ("GET", "/v1/plans/00000000-0000-7000-8000-000000000000"), ("GET", "/v1/plans?state=x"), ("GET", "/nowhere"),
             ("GET", "/v1/legs/x"), ("GET", "/v1/legs?attitude=1,2"), ("GET", "/v1/legs?tolerance_rad=-1"), ("DELETE", "/v1/limits"),
             ("GET", "/v1/spacecraft/none"), ("POST", "/v1/plans/x/stop"), ("GET", "/v1/plans?limit=0"), ("GET", "/v1/plans?cursor=x"),
             ("GET", "/v1/plans?unknown=1")]
    for method, path in wrong:
        yield f"{method} {path}", *client.ask(method, path)
    for headers in ({"Content-Type": "text/plain"}, {"Prefer": "wait=x"}, {"Idempotency-Key": "d e"}):
        yield f"POST with {headers}", *client.ask("POST", "/v1/plans", json.dumps(scenario), headers)
    plan = json.loads(command("solve", "-", "--progress", "none", given=scenario)[1])
    for name, method, path, body in refusals(plan):
        yield f"refused {name}", *client.ask(method, path, body)


def kept(work, before):
    """The service on a copy of the database that the program before left behind."""
    for part in before.glob("service.db*"):
        shutil.copy(part, work / part.name.replace("service", "copied"))
    jobs = json.loads((before / "jobs.json").read_text())
    with started(work / "copied.db") as service:
        for question, *answer in stored(service, jobs):
            yield f"kept{question.removeprefix('stored')}", *answer


def started(database):
    service = Service(database, "--no-keys")
    service.database = database
    return service


def everything(work, before):
    """All of it; also asks a database of `before`, a folder that another program has filled."""
    with started(work / "service.db") as service:
        craft = fixture("two-targets")["spacecraft"]
        service.request("PUT", "/v1/spacecraft/kept", craft)
        command("keys", "create", "kept", "--database", service.database)
        jobs = submitted(service)
        (work / "jobs.json").write_text(json.dumps(jobs))
        yield from stored(service, jobs)
    if before:
        yield from kept(work, before)
    with started(work / "asked.db") as service:
        yield from asked(service)
