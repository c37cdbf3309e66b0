#!/usr/bin/env python3
"""Holds the client of the Python module against `openapi.yaml`, its types against mypy, and both against
a service.

    python3 tests/clients/python/check.py

Installs PyYAML, mypy and readers of tables from PyPI first where they are not there (CLIENT_VENV names another place).
SLEWPLAN names a built binary.
"""

import inspect
import io
import os
import subprocess
import sys
import tempfile
import typing
from pathlib import Path

HERE = Path(__file__).resolve().parent
TESTS = HERE.parents[1]
PACKAGE = TESTS.parent / "server" / "python"
# The module before the file of that name among the peers.
sys.path[:0] = [str(PACKAGE), str(TESTS / "peers"), str(TESTS / "load")]
from environment import Environment  # noqa: E402

NEEDED = ("mypy==2.4.1", "PyYAML", "numpy", "pandas", "pyarrow")
CLIENT = Environment("client", NEEDED, ("mypy", "yaml", "numpy", "pandas", "pyarrow"), "CLIENT_VENV")
# Types of the client by their names in the description.
TYPES = {
    "Job": "Job",
    "LegAnswer": "LegTime",
    "LegTableJob": "LegTableJob",
    "InclusionCost": "InclusionCost",
    "Plan": "Plan",
    "SkippedTarget": "SkippedTarget",
    "Wait": "Wait",
    "Leg": "Leg",
    "Passage": "Passage",
    "Control": "Control",
    "State": "FlownState",
    "Trajectory": "Trajectory",
    "Verification": "Verification",
    "UnitQuaternion": "Quaternion",
}


def properties(description, schema):
    """Names of the members of a schema, references followed."""
    if "$ref" in schema:
        return properties(description, description["components"]["schemas"][schema["$ref"].split("/")[-1]])
    names = set(schema.get("properties", {}))
    for part in schema.get("allOf", []):
        names |= properties(description, part)
    return names


def described(description):
    """What the client has and the description does not."""
    wrong = []
    for name, (method, path) in slewplan.OPERATIONS.items():
        if method.lower() not in description["paths"].get(path, {}):
            wrong.append(f"{name}: no {method} {path}")
    for schema, name in TYPES.items():
        members = properties(description, description["components"]["schemas"][schema])
        for member in typing.get_type_hints(getattr(slewplan, name)):
            if member not in members:
                wrong.append(f"{name}: {member} is not in {schema}")
    parameters = {p["name"]: p for p in description["paths"]["/v1/plans/{id}/result"]["get"]["parameters"]}
    for choice in list(inspect.signature(slewplan.Client.export).parameters)[3:]:
        if choice not in parameters:
            wrong.append(f"export: no parameter {choice}")
    formats = set(parameters["format"]["schema"]["enum"]) - {"json"}
    if formats != set(typing.get_args(slewplan.Format)):
        wrong.append(f"Format: described are {sorted(formats)}")
    states = set(description["components"]["schemas"]["JobState"]["enum"])
    if states != set(typing.get_args(slewplan.State)):
        wrong.append(f"State: described are {sorted(states)}")
    return wrong


def used(folder):
    """The example and the other methods with a service."""
    with Service(Path(folder, "client.db")) as service:
        address = f"http://{service.host}:{service.port}"
        scenario = TESTS / "fixtures" / "two-targets.json"
        example = [sys.executable, HERE / "example.py"]
        environment = {**os.environ, "PYTHONPATH": str(PACKAGE)}
        subprocess.run([*example, address, scenario, folder], check=True, env=environment)
        told = subprocess.run(example, capture_output=True, text=True, env=environment)
        assert told.returncode == 2 and told.stderr.startswith("usage: example.py "), told
        assert "ADDRESS" in told.stderr and "Traceback" not in told.stderr, told
        assert Path(folder, "plan.aem").read_text().startswith("CCSDS_AEM_VERS")
        client = slewplan.Client(address)
        model = fixture("two-targets")
        job = client.submit(model, idempotency_key="one")
        assert client.submit(model, idempotency_key="one")["id"] == job["id"]
        last = list(client.events(job["id"]))[-1]
        assert client.wait(job["id"])["state"] == "succeeded", last
        plan = client.plan(job["id"])
        assert client.verify(model, plan)["passed"]
        for form in typing.get_args(slewplan.Format):
            assert client.export(job["id"], form)
        assert len(client.export(job["id"], "csv", step_s=1.0)) < len(client.export(job["id"], "csv"))
        stars = fixture("stars-and-sun")
        rolls = [stop.get("roll_deg") for stop in client.plan(client.wait(client.submit(stars)["id"])["id"])["passages"]]
        assert len(rolls) == len(stars["targets"]) and None not in rolls, rolls
        client.delete(job["id"])
        for call in (client.job, client.stop, client.cancel, client.plan):
            try:
                call(job["id"])
            except slewplan.Refused as refused:
                assert (refused.status, refused.code) == (404, "not_found")
            else:
                raise AssertionError("a deleted job was found")
        try:
            client.submit({"targets": 1})
        except slewplan.Refused as refused:
            assert refused.status == 422 and refused.problems
        else:
            raise AssertionError("nonsense was accepted")


def tabulated(folder):
    """Tables of leg times, as others read them."""
    with Service(Path(folder, "legs.db")) as service:
        client = slewplan.Client(f"http://{service.host}:{service.port}")
        attitudes = [{"roll_pitch_yaw_deg": [10 * number, 0, 25 * number]} for number in range(4)]
        query = {"spacecraft": fixture("two-targets")["spacecraft"], "attitudes": attitudes}
        job = client.submit_legs(query, idempotency_key="legs")
        assert list(client.leg_events(job["id"]))[-1]["done"] == 12
        job = client.wait_legs(job["id"])
        assert (job["state"], job["done"], job["missing"]) == ("succeeded", 12, 0), job
        table = client.leg_table(job["id"])
        times, frame = table.array(), table.frame()
        assert times.shape == (4, 4) and (times[~numpy.eye(4, dtype=bool)] > 0).all()
        assert numpy.allclose(times, times.T) and (times >= table.array("certified_lower_bound_s")).all()
        for row in frame.itertuples():
            assert times[row[1], row.to] == row.duration_s
        read = pyarrow.parquet.read_table(io.BytesIO(client.export_legs(job["id"], "parquet")))
        assert read.schema.metadata[b"kind"] == b"rest_to_rest"
        assert read.to_pylist() == table.rows
        csv = pandas.read_csv(io.BytesIO(client.export_legs(job["id"], "csv")))
        assert numpy.allclose(csv.duration_s, frame.duration_s, rtol=1e-12, atol=0) and (csv.key == frame.key).all()
        assert {row["source"] for row in client.query_legs(query).rows} == {"cached"}
        pointing = [{"pointing": {"boresight": [0, 0, 1], "ra_dec_deg": [40 * n, 10 * n]}} for n in range(3)]
        solved = {**query, "mode": "compute"}
        free = client.query_legs({**solved, "attitudes": pointing}).array()
        roll_0 = [{"ra_dec_roll_deg": [40 * n, 10 * n, 0], "boresight": [0, 0, 1]} for n in range(3)]
        given = client.query_legs({**solved, "attitudes": roll_0}).array()
        others = ~numpy.eye(3, dtype=bool)
        assert (free[others] < given[others]).all(), (free, given)
        client.delete_legs(job["id"])
        for call in (client.leg_job, client.stop_legs, client.cancel_legs, client.leg_table):
            try:
                call(job["id"])
            except slewplan.Refused as refused:
                assert (refused.status, refused.code) == (404, "not_found")
            else:
                raise AssertionError("a deleted table was found")


def main():
    description = yaml.safe_load((TESTS.parent / "openapi.yaml").read_text(encoding="utf-8"))
    wrong = described(description)
    if wrong:
        sys.exit("\n".join(wrong))
    strict = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", PACKAGE / "slewplan"]
    subprocess.run(strict, check=True)
    with tempfile.TemporaryDirectory() as folder:
        used(folder)
        tabulated(folder)
    print("the client agrees with openapi.yaml and with the service")


if __name__ == "__main__":
    CLIENT.enter()
    import numpy
    import pandas
    import pyarrow.parquet
    import slewplan
    import yaml
    from service import Service, fixture

    main()
