"""The service as a child process, and a small HTTP client for it. Needs nothing but Python."""

import http.client
import json
import os
import signal
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "tests" / "fixtures"
FINAL = {"succeeded", "stopped", "infeasible", "failed", "cancelled", "dead"}


def binary():
    """The built binary: SLEWPLAN, or that of the development profile."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    return os.environ.get("SLEWPLAN", str(target / "debug" / "slewplan"))


def fixture(name):
    return json.loads((FIXTURES / f"{name}.json").read_text())


class Process:
    """A child process that tells on its standard output when it is ready."""

    def __init__(self, command, arguments, log, announced, environment=None):
        self.log = open(log, "a")
        environment = {**os.environ, **(environment or {})}
        self.process = subprocess.Popen(
            [environment.get("SLEWPLAN") or binary(), command, *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=self.log,
            text=True,
            env=environment,
        )
        self.told = self.process.stdout.readline().strip()
        if not self.told.startswith(announced):
            self.kill()
            raise RuntimeError(f"{command} did not start; see {self.log.name}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            self.process.wait(30)
        self.close()

    def close(self):
        """Lets go of what it was read and written by."""
        self.log.close()
        self.process.stdout.close()

    def kill(self):
        self.process.kill()
        self.process.wait()


class Client:
    """What is asked of a service; `request` gives status and document of an answer."""

    def submit(self, scenario, **headers):
        status, job = self.request("POST", "/v1/plans", scenario, headers)
        if status != 202:
            raise RuntimeError(f"submission answered {status}: {job}")
        return job["id"]

    def job(self, identifier):
        status, job = self.request("GET", f"/v1/plans/{identifier}")
        if status != 200:
            raise RuntimeError(f"job {identifier} answered {status}: {job}")
        return job

    def wait(self, identifier, until, patience=120.0):
        """Waits until a job satisfies a condition."""
        end = time.monotonic() + patience
        while time.monotonic() < end:
            job = self.job(identifier)
            if until(job):
                return job
            time.sleep(0.01)
        raise RuntimeError(f"job {identifier} is still {job['state']} after {patience} s")

    def wait_end(self, identifier, patience=120.0):
        return self.wait(identifier, lambda job: job["state"] in FINAL, patience)


class Endpoint:
    """Something that answers at a host and a port."""

    def exchange(self, method, path, body=None, headers=None):
        """Status, headers and document of an answer."""
        connection = http.client.HTTPConnection(self.host, self.port, timeout=120)
        try:
            headers = dict(headers or {})
            if body is not None:
                headers.setdefault("Content-Type", "application/json")
                body = body if isinstance(body, (str, bytes)) else json.dumps(body)
            connection.request(method, path, body, headers)
            answer = connection.getresponse()
            text = answer.read()
            is_json = "json" in (answer.getheader("Content-Type") or "")
            return answer.status, answer.headers, json.loads(text) if is_json and text else text
        finally:
            connection.close()

    def request(self, method, path, body=None, headers=None):
        """Status and document of an answer."""
        status, _, document = self.exchange(method, path, body, headers)
        return status, document


class Service(Process, Endpoint, Client):
    """`slewplan serve` on a free port."""

    def __init__(self, database, *arguments, log=None, environment=None):
        # Of a database on a server nothing is beside it.
        shared = str(database).startswith("postgres")
        log = log or (os.devnull if shared else f"{database}.log")
        arguments = ["--listen", "127.0.0.1:0", "--database", database, *arguments]
        super().__init__("serve", arguments, log, "listening on http://", environment)
        self.host, port = self.told.removeprefix("listening on http://").rsplit(":", 1)
        self.port = int(port)


class Table:
    """What was promised, what was measured, and whether it holds."""

    def __init__(self):
        self.failed = False
        print(f"{'promise':<58} {'measured':>16} {'goal':>12}")

    def row(self, promise, measured, goal, holds):
        self.failed |= not holds
        print(f"{promise:<58} {measured:>16} {goal:>12}  {'ok' if holds else 'FAILED'}", flush=True)

    def timed(self, promise, measured, goal, holds):
        """A row about time: with LOAD_TIMES=report, for busy machines, it is shown and no more."""
        if not holds and os.environ.get("LOAD_TIMES") == "report":
            print(f"{promise:<58} {measured:>16} {goal:>12}  slow", flush=True)
        else:
            self.row(promise, measured, goal, holds)

    def exit(self):
        raise SystemExit(1 if self.failed else 0)


def percentile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]
