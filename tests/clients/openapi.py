#!/usr/bin/env python3
"""Holds `openapi.yaml` against other people's tools, and a client that they generate against a service.

    python3 tests/clients/openapi.py

The file must say the same to readers of YAML 1.1 and 1.2, and `openapi-spec-validator` must accept it.
`openapi-python-client` makes a client of it, which plans experiment A and reads a refusal. The tools
are installed from PyPI first where they are not there (OPENAPI_VENV names another place). SLEWPLAN names
a built binary.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path += [str(TESTS / "peers"), str(TESTS / "load")]
from environment import Environment  # noqa: E402

TOOLS = Environment(
    "openapi",
    (
        "openapi-python-client==0.29.1",
        "openapi-spec-validator==0.9.0",
        "PyYAML==6.0.3",
        "ruamel.yaml==0.19.1",
        "httpx==0.28.1",
    ),
    ("openapi_python_client", "openapi_spec_validator", "yaml", "ruamel.yaml", "httpx"),
    "OPENAPI_VENV",
)
DESCRIPTION = TESTS.parent / "openapi.yaml"
# Without this the generator has no reader for a file of its own kind; nothing is reformatted.
GENERATOR = "content_type_overrides:\n  application/yaml: text/plain\npost_hooks: []\n"


def differences(one, other, place=""):
    """Where two documents differ, in values or in their types."""
    if type(one) is not type(other):
        return [f"{place}: {one!r} and {other!r}"]
    if isinstance(one, dict):
        inside = [(f"{place}/{name}", one.get(name), other.get(name)) for name in one.keys() | other.keys()]
    elif isinstance(one, list):
        if len(one) != len(other):
            return [f"{place}: {len(one)} and {len(other)} entries"]
        inside = [(f"{place}/{index}", *pair) for index, pair in enumerate(zip(one, other))]
    else:
        return [] if one == other else [f"{place}: {one!r} and {other!r}"]
    return [found for where, a, b in inside for found in differences(a, b, where)]


def read():
    """The description, as every reader of YAML has it."""
    text = DESCRIPTION.read_text(encoding="utf-8")
    old, new = yaml.safe_load(text), ruamel.yaml.YAML(typ="safe", pure=True).load(text)
    if found := differences(old, new):
        sys.exit("\n".join(["openapi.yaml differs between YAML 1.1 and 1.2:", *found]))
    print(f"ok   {len(old['paths'])} paths are the same in YAML 1.1 and 1.2")
    return old


def generate(folder):
    """The module of a client that is made of the description, without a warning."""
    (folder / "generator.yaml").write_text(GENERATOR, encoding="utf-8")
    command = [sys.executable, "-m", "openapi_python_client", "generate", "--fail-on-warning"]
    command += ["--path", DESCRIPTION, "--meta", "none", "--config", folder / "generator.yaml"]
    subprocess.run([*command, "--output-path", folder / "generated"], check=True)
    sys.path.insert(0, str(folder))
    print("ok   openapi-python-client makes a client of it")


def used(folder):
    """The generated client plans experiment A, and reads why something else is refused."""
    from generated.api.plans import create_plan, get_plan, get_result
    from generated.client import Client
    from generated.models import Job, JobState, Plan, Problem, Scenario

    with Service(folder / "generated.db") as service:
        client = Client(f"http://{service.host}:{service.port}", timeout=120.0, raise_on_unexpected_status=True)
        body = Scenario.from_dict(fixture("olivares-a"))
        plan = create_plan.sync(client=client, body=body, prefer="wait=60")
        assert isinstance(plan, Plan), plan
        assert plan.status == "optimal" and abs(plan.total_time_s - 467.71) < 0.5, plan.total_time_s
        assert plan.verification.passed and len(plan.sequence) == 6
        job = create_plan.sync(client=client, body=body)
        assert isinstance(job, Job), job
        service.wait_end(job.id)
        assert get_plan.sync(job.id, client=client).state == JobState.SUCCEEDED
        assert get_result.sync(job.id, client=client).sequence == plan.sequence

        body.spacecraft.wheels[1].max_torque_nm = -1.0
        body.targets[2].id = body.targets[0].id
        answer = create_plan.sync_detailed(client=client, body=body)
        refused = answer.parsed
        assert answer.status_code == 422 and isinstance(refused, Problem), answer
        assert refused.status == 422 and refused.code == "invalid_input", refused
        found = {(error.pointer, error.code) for error in refused.errors}
        expected = {("/spacecraft/wheels/1/max_torque_nm", "torque_limits"), ("/targets/2/id", "duplicate_id")}
        assert found == expected, found
        assert all(error.message and error.hint for error in refused.errors)
    print("ok   the generated client plans experiment A and reads a refusal")


def main():
    openapi_spec_validator.validate(read())
    print("ok   openapi-spec-validator accepts it")
    with tempfile.TemporaryDirectory() as folder:
        generate(Path(folder))
        used(Path(folder))


if __name__ == "__main__":
    TOOLS.enter()
    import openapi_spec_validator
    import ruamel.yaml
    import yaml
    from service import Service, fixture

    main()
