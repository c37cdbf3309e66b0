"""A small client of the slewplan service. Needs nothing but Python 3.11.

    from slewplan import Client

    client = Client("http://127.0.0.1:8080")
    job = client.wait(client.submit(scenario)["id"])
    plan = client.plan(job["id"])
    message = client.export(job["id"], "aem-kvn", object_id="2026-001A")

Types name the members that programs usually read; documents have more. Methods and types are held
against `openapi.yaml` by a test.
"""

from __future__ import annotations

import importlib
import json
import time
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Callable, Iterator
from typing import Any, Literal, NotRequired, TypedDict, TypeVar, cast

State = Literal["queued", "running", "succeeded", "stopped", "infeasible", "failed", "cancelled", "dead"]
Format = Literal["csv", "aem-kvn", "aem-xml", "basilisk", "open-mct", "stk", "wheel-rpm"]
Scenario = dict[str, Any]
LegQuery = dict[str, Any]


class Quaternion(TypedDict):
    """Maps body vectors to reference vectors; `w` is the scalar."""

    x: float
    y: float
    z: float
    w: float


class Job(TypedDict):
    id: str
    state: State
    name: NotRequired[str | None]
    targets: int
    incumbent_s: NotRequired[float | None]
    lower_bound_s: NotRequired[float | None]
    # Where targets have values.
    value: NotRequired[float | None]
    value_bound: NotRequired[float | None]
    keep_out_violated: NotRequired[bool | None]
    detail: NotRequired[str | None]
    code: NotRequired[str | None]
    submitted_at: str


class Leg(TypedDict):
    to: str
    start_s: float
    duration_s: float
    eigenaxis_duration_s: float | None


class Passage(TypedDict):
    target: str
    time_s: float
    departure_s: float
    # Degrees, where the target points a boresight.
    roll_deg: NotRequired[float]
    body_rate_rad_s: list[float]
    wheel_speed_rad_s: list[float]


class Control(TypedDict):
    """Motor torques on the wheels, N m; the body feels the opposite."""

    start_s: float
    duration_s: float
    wheel_torque_nm: list[float]


class FlownState(TypedDict):
    time_s: float
    quaternion: Quaternion
    body_rate_rad_s: list[float]
    wheel_speed_rad_s: list[float]


class Trajectory(TypedDict):
    controls: list[Control]
    states: list[FlownState]


class Verification(TypedDict):
    passed: bool
    max_attitude_error_rad: float | None
    max_rate_error_rad_s: float | None


# `from` is a word of Python.
LegTime = TypedDict(
    "LegTime",
    {
        "from": int,
        "to": int,
        "duration_s": float | None,
        "certified_lower_bound_s": float | None,
        "status": str | None,
        "source": Literal["cached", "computed", "missing"],
        "key": str | None,
    },
)


class LegTable:
    """Leg times in the order of their query."""

    def __init__(self, rows: list[LegTime]) -> None:
        self.rows = rows

    def __len__(self) -> int:
        return len(self.rows)

    def array(self, column: Literal["duration_s", "certified_lower_bound_s"] = "duration_s") -> Any:
        """Of the full matrix of attitudes: a NumPy array, from the row to the column, s. Not a number
        where nothing is known; zero on the diagonal. Needs `numpy`."""
        numpy = importlib.import_module("numpy")
        size = 1 + max((max(row["from"], row["to"]) for row in self.rows), default=-1)
        times = numpy.full((size, size), numpy.nan)
        numpy.fill_diagonal(times, 0.0)
        for row in self.rows:
            if (time_s := row[column]) is not None:
                times[row["from"], row["to"]] = time_s
        return times

    def frame(self) -> Any:
        """A data frame with the members of a row as columns. Needs `pandas`."""
        return importlib.import_module("pandas").DataFrame(self.rows, columns=list(LegTime.__annotations__))


class LegTableJob(TypedDict):
    id: str
    state: State
    legs: int
    done: int
    cached: int
    computed: int
    missing: int
    detail: NotRequired[str | None]
    code: NotRequired[str | None]
    submitted_at: str


class Problem(TypedDict):
    pointer: str
    code: str
    message: str
    hint: str


class InclusionCost(TypedDict):
    """The best known plan with a target that is left out, compared with the plan."""

    value_change: float
    time_change_s: float


class SkippedTarget(TypedDict):
    target: str
    reason: Literal["window_unreachable", "value_too_small", "time_is_up", "not_tried"]
    inclusion: NotRequired[InclusionCost]


class Wait(TypedDict):
    """A stay at rest outside a visit, in the attitude of a target or of `start`."""

    target: str
    from_s: float
    to_s: float


class Plan(TypedDict):
    status: Literal["optimal", "feasible", "infeasible", "failed"]
    total_time_s: float | None
    lower_bound_s: float | None
    relative_gap: float | None
    # Of scenarios with windows, values or a latest end.
    objective: NotRequired[Literal["value_then_time"]]
    value: NotRequired[float]
    value_bound: NotRequired[float]
    skipped: NotRequired[list[SkippedTarget]]
    waits: NotRequired[list[Wait]]
    sequence: list[str]
    legs: list[Leg]
    passages: list[Passage]
    trajectory: Trajectory
    verification: Verification | None
    reasons: list[Problem]
    warnings: list[Problem]


class Refused(Exception):
    """An answer of the service that is an error (RFC 9457)."""

    def __init__(self, status: int, document: dict[str, Any]) -> None:
        self.status = status
        self.code: str = document.get("code", "")
        self.problems: list[Problem] = document.get("errors", [])
        super().__init__(f"{status} {self.code}: {document.get('detail', '')}")


# Method and path of every operation that the client uses, as in openapi.yaml.
OPERATIONS = {
    "submit": ("POST", "/v1/plans"),
    "job": ("GET", "/v1/plans/{id}"),
    "result": ("GET", "/v1/plans/{id}/result"),
    "events": ("GET", "/v1/plans/{id}/events"),
    "stop": ("POST", "/v1/plans/{id}/stop"),
    "cancel": ("POST", "/v1/plans/{id}/cancel"),
    "delete": ("DELETE", "/v1/plans/{id}"),
    "verify": ("POST", "/v1/verify"),
    "query_legs": ("POST", "/v1/legs/query"),
    "submit_legs": ("POST", "/v1/leg-tables"),
    "leg_job": ("GET", "/v1/leg-tables/{id}"),
    "leg_result": ("GET", "/v1/leg-tables/{id}/result"),
    "leg_events": ("GET", "/v1/leg-tables/{id}/events"),
    "stop_legs": ("POST", "/v1/leg-tables/{id}/stop"),
    "cancel_legs": ("POST", "/v1/leg-tables/{id}/cancel"),
    "delete_legs": ("DELETE", "/v1/leg-tables/{id}"),
}
LINES = {"Accept": "application/x-ndjson"}
ENDED = ("succeeded", "stopped", "infeasible", "failed", "cancelled", "dead")


class Client:
    """The service at an address, with a key where it asks for one."""

    def __init__(self, address: str, key: str | None = None, timeout_s: float = 120.0) -> None:
        self._address = address.rstrip("/")
        self._headers = {"Authorization": f"Bearer {key}"} if key else {}
        self._timeout_s = timeout_s

    def submit(
        self, scenario: Scenario, idempotency_key: str | None = None, *, priority: int = 0
    ) -> Job:
        """Queues a scenario; jobs of greater priority, from -10 to 10, are solved first."""
        headers = {"Idempotency-Key": idempotency_key} if idempotency_key else {}
        query = {"priority": priority} if priority else {}
        answer = self._send("submit", query=query, body=scenario, headers=headers)
        return cast(Job, json.loads(answer))

    def job(self, identifier: str) -> Job:
        """Where a job stands."""
        return cast(Job, json.loads(self._send("job", identifier)))

    def wait(self, identifier: str, patience_s: float = 3600.0) -> Job:
        """The job when it has ended; `TimeoutError` when it has not after so long."""
        return _ended(self.job, identifier, patience_s)

    def events(self, identifier: str) -> Iterator[dict[str, Any]]:
        """What happens to a job, until it has ended; each with incumbent and bound."""
        return self._events("events", identifier)

    def plan(self, identifier: str) -> Plan:
        """The final plan, or the best so far."""
        return cast(Plan, json.loads(self._send("result", identifier, {"format": "json"})))

    def export(
        self,
        identifier: str,
        form: Format,
        *,
        step_s: float | None = None,
        tolerance: float | None = None,
        rates: bool | None = None,
        wheel: int | None = None,
        object_name: str | None = None,
        object_id: str | None = None,
    ) -> str:
        """The plan in the format of another tool."""
        choices: dict[str, Any] = {
            "format": form,
            "step_s": step_s,
            "tolerance": tolerance,
            "rates": None if rates is None else str(rates).lower(),
            "wheel": wheel,
            "object_name": object_name,
            "object_id": object_id,
        }
        return self._send("result", identifier, choices).decode()

    def stop(self, identifier: str) -> Job:
        """Finishes a running job with the best plan so far."""
        return cast(Job, json.loads(self._send("stop", identifier)))

    def cancel(self, identifier: str) -> Job:
        """Abandons a job."""
        return cast(Job, json.loads(self._send("cancel", identifier)))

    def delete(self, identifier: str) -> None:
        """Deletes a job with its plan; a running one is cancelled first."""
        self._send("delete", identifier)

    def verify(self, scenario: Scenario, plan: Plan) -> Verification:
        """Flies a plan made by anyone again."""
        body = {"scenario": scenario, "plan": plan}
        return cast(Verification, json.loads(self._send("verify", body=body)))

    def query_legs(self, query: LegQuery) -> LegTable:
        """The times of legs, cached, certified, or, with `"mode": "compute"`, of up to 1,000 legs."""
        return self._table("query_legs", body=query)

    def submit_legs(
        self, query: LegQuery, idempotency_key: str | None = None, *, priority: int = 0
    ) -> LegTableJob:
        """Queues a table of leg times of any size; `priority` is that of `submit`."""
        headers = {"Idempotency-Key": idempotency_key} if idempotency_key else {}
        parameters = {"priority": priority} if priority else {}
        answer = self._send("submit_legs", query=parameters, body=query, headers=headers)
        return cast(LegTableJob, json.loads(answer))

    def leg_job(self, identifier: str) -> LegTableJob:
        """How far the job of a table is."""
        return cast(LegTableJob, json.loads(self._send("leg_job", identifier)))

    def wait_legs(self, identifier: str, patience_s: float = 86400.0) -> LegTableJob:
        """The job of a table when it has ended; `TimeoutError` when it has not after so long."""
        return _ended(self.leg_job, identifier, patience_s)

    def leg_events(self, identifier: str) -> Iterator[dict[str, Any]]:
        """What happens to the job of a table, until it has ended; each with counts of legs."""
        return self._events("leg_events", identifier)

    def leg_table(self, identifier: str) -> LegTable:
        """The rows of a table: all of them, or those so far."""
        return self._table("leg_result", identifier)

    def export_legs(self, identifier: str, form: Literal["ndjson", "csv", "parquet", "json"]) -> bytes:
        """The same as a file."""
        return self._send("leg_result", identifier, {"format": form})

    def stop_legs(self, identifier: str) -> LegTableJob:
        """Finishes the job of a table with the legs so far."""
        return cast(LegTableJob, json.loads(self._send("stop_legs", identifier)))

    def cancel_legs(self, identifier: str) -> LegTableJob:
        """Abandons the job of a table; the legs that it has solved stay in the cache."""
        return cast(LegTableJob, json.loads(self._send("cancel_legs", identifier)))

    def delete_legs(self, identifier: str) -> None:
        """Deletes the job of a table with its rows."""
        self._send("delete_legs", identifier)

    def _table(self, operation: str, identifier: str = "", body: LegQuery | None = None) -> LegTable:
        with self._open(operation, identifier, body=body, headers=LINES) as lines:
            return LegTable([json.loads(line) for line in lines])

    def _events(self, operation: str, identifier: str) -> Iterator[dict[str, Any]]:
        with self._open(operation, identifier) as stream:
            for line in stream:
                if line.startswith(b"data:"):
                    yield json.loads(line[5:])

    def _open(
        self,
        operation: str,
        identifier: str = "",
        query: dict[str, Any] | None = None,
        body: Any = None,
        headers: dict[str, str] | None = None,
    ) -> Any:
        method, path = OPERATIONS[operation]
        path = path.replace("{id}", urllib.parse.quote(identifier, safe=""))
        chosen = {name: value for name, value in (query or {}).items() if value is not None}
        address = self._address + path + ("?" + urllib.parse.urlencode(chosen) if chosen else "")
        sent = {**self._headers, **(headers or {})}
        content = None
        if body is not None:
            content, sent["Content-Type"] = json.dumps(body).encode(), "application/json"
        request = urllib.request.Request(address, content, sent, method=method)
        try:
            return urllib.request.urlopen(request, timeout=self._timeout_s)
        except urllib.error.HTTPError as error:
            raise Refused(error.code, _document(error.read())) from None

    def _send(self, *arguments: Any, **named: Any) -> bytes:
        with self._open(*arguments, **named) as answer:
            return cast(bytes, answer.read())


AnyJob = TypeVar("AnyJob", Job, LegTableJob)


def _ended(read: Callable[[str], AnyJob], identifier: str, patience_s: float) -> AnyJob:
    """A job when it has ended."""
    end, pause = time.monotonic() + patience_s, 0.05
    while (job := read(identifier))["state"] not in ENDED:
        if time.monotonic() > end:
            raise TimeoutError(f"job {identifier} is still {job['state']}")
        time.sleep(pause)
        pause = min(2 * pause, 2.0)
    return job


def _document(content: bytes) -> dict[str, Any]:
    try:
        return cast(dict[str, Any], json.loads(content))
    except ValueError:
        return {"detail": content.decode(errors="replace")}
