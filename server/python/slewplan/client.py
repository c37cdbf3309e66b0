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

import json
import time
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Iterator
from typing import Any, Literal, NotRequired, TypedDict, cast

State = Literal["queued", "running", "succeeded", "stopped", "infeasible", "failed", "cancelled", "dead"]
Format = Literal["csv", "aem-kvn", "aem-xml", "basilisk", "open-mct", "stk", "wheel-rpm"]
Scenario = dict[str, Any]


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


class Problem(TypedDict):
    pointer: str
    code: str
    message: str
    hint: str


class Plan(TypedDict):
    status: Literal["optimal", "feasible", "infeasible", "failed"]
    total_time_s: float | None
    lower_bound_s: float | None
    relative_gap: float | None
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
}
ENDED = ("succeeded", "stopped", "infeasible", "failed", "cancelled", "dead")


class Client:
    """The service at an address, with a key where it asks for one."""

    def __init__(self, address: str, key: str | None = None, timeout_s: float = 120.0) -> None:
        self._address = address.rstrip("/")
        self._headers = {"Authorization": f"Bearer {key}"} if key else {}
        self._timeout_s = timeout_s

    def submit(self, scenario: Scenario, idempotency_key: str | None = None) -> Job:
        """Queues a scenario."""
        headers = {"Idempotency-Key": idempotency_key} if idempotency_key else {}
        return cast(Job, json.loads(self._send("submit", body=scenario, headers=headers)))

    def job(self, identifier: str) -> Job:
        """Where a job stands."""
        return cast(Job, json.loads(self._send("job", identifier)))

    def wait(self, identifier: str, patience_s: float = 3600.0) -> Job:
        """The job when it has ended; `TimeoutError` when it has not after so long."""
        end, pause = time.monotonic() + patience_s, 0.05
        while (job := self.job(identifier))["state"] not in ENDED:
            if time.monotonic() > end:
                raise TimeoutError(f"job {identifier} is still {job['state']}")
            time.sleep(pause)
            pause = min(2 * pause, 2.0)
        return job

    def events(self, identifier: str) -> Iterator[dict[str, Any]]:
        """What happens to a job, until it has ended; each with incumbent and bound."""
        with self._open("events", identifier) as stream:
            for line in stream:
                if line.startswith(b"data:"):
                    yield json.loads(line[5:])

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


def _document(content: bytes) -> dict[str, Any]:
    try:
        return cast(dict[str, Any], json.loads(content))
    except ValueError:
        return {"detail": content.decode(errors="replace")}
