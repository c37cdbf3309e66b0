#!/usr/bin/env python3
"""Holds compose.yaml and the Kubernetes manifests against their schemas and against our own rules.

    python3 tests/container/manifests.py IMAGE.json

IMAGE.json is what `buildah inspect --type image` prints. The schemas come with two packages from
PyPI, installed first where they are not there (CONTAINER_VENV names another place).
"""

import json
import re
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
DEPLOY = TESTS.parent / "server" / "deploy"
sys.path += [str(TESTS / "peers"), str(TESTS / "readers")]
from common import Judge  # noqa: E402
from environment import Environment  # noqa: E402

SCHEMAS = Environment(
    "container",
    ("kubernetes-validate==1.37.0", "check-jsonschema==0.39.0", "PyYAML==6.0.3"),
    ("kubernetes_validate", "check_jsonschema", "yaml"),
    "CONTAINER_VENV",
)
# The oldest release in which podFailurePolicy needs no switch, and the newest with a schema.
KUBERNETES = ("1.31", "1.37")
PARTS = re.compile(r"indexed/(\d+)$")


def schema_faults(document):
    """What the schemas of Kubernetes find; unknown members are faults."""
    faults = []
    for version in KUBERNETES:
        try:
            kubernetes_validate.validate(document, version, strict=True)
        except kubernetes_validate.ValidationError as error:
            faults.append(f"{version}: {'/'.join(map(str, error.path))}: {error.message}")
    return faults


def pod_faults(pod, user):
    """Ways in which a pod is less confined than the restricted profile and a read-only root."""
    container = pod["containers"][0]
    outer, inner = pod.get("securityContext", {}), container.get("securityContext", {})
    names = {volume["name"] for volume in pod["volumes"]}
    mounts = container["volumeMounts"]
    demands = {
        "one container": len(pod["containers"]) == 1 and "initContainers" not in pod,
        "not root": outer.get("runAsNonRoot") is True,
        "the image's user": [outer.get("runAsUser"), outer.get("runAsGroup")] == user,
        "the volume is the user's": outer.get("fsGroup") == user[1],
        "seccomp": outer.get("seccompProfile") == {"type": "RuntimeDefault"},
        "no more privileges": inner.get("allowPrivilegeEscalation") is False,
        "read-only root": inner.get("readOnlyRootFilesystem") is True,
        "no capabilities": inner.get("capabilities") == {"drop": ["ALL"]},
        "no token": pod.get("automountServiceAccountToken") is False,
        # A service called slewplan would put variables SLEWPLAN_* of its own into the pod.
        "no links": pod.get("enableServiceLinks") is False,
        "nothing of the host": not {"hostNetwork", "hostPID", "hostIPC"} & pod.keys(),
        "limits": "memory" in container["resources"]["limits"],
        "every volume is mounted": names == {mount["name"] for mount in mounts},
        "only /data is writable": [m["mountPath"] for m in mounts if not m.get("readOnly")] == ["/data"],
    }
    return [demand for demand, met in demands.items() if not met]


def job_faults(spec):
    """Ways in which a job would repeat what cannot succeed, or miss a part."""
    faults = []
    rules = spec["podFailurePolicy"]["rules"]
    if spec["template"]["spec"].get("restartPolicy") != "Never":
        faults.append("failures by exit code need restartPolicy Never")
    if rules[0]["action"] != "Ignore" or not {2, 3} <= set(rules[1]["onExitCodes"]["values"]):
        faults.append("lost nodes come first, then inputs that no repetition makes valid")
    if spec.get("completionMode") == "Indexed":
        arguments = spec["template"]["spec"]["containers"][0]["args"]
        parts = [int(found[1]) for found in map(PARTS.search, arguments) if found]
        if parts != [spec["completions"]] or spec["parallelism"] > spec["completions"]:
            faults.append(f"{parts} parts for {spec['completions']} completions")
        if not any("$(JOB_COMPLETION_INDEX)" in argument for argument in arguments):
            faults.append("the parts overwrite each other")
    return faults


def compose_faults(service, image):
    """Ways in which the service of the compose file differs from the image or is less confined."""
    check = image["Healthcheck"]
    demands = {
        "the image's user": service.get("user") == image["User"],
        "read-only root": service.get("read_only") is True,
        "no capabilities": service.get("cap_drop") == ["ALL"] and "cap_add" not in service,
        "no more privileges": service.get("security_opt") == ["no-new-privileges:true"],
        "one volume": service.get("volumes") == ["data:/data"],
        "only this machine": all(port.startswith("127.0.0.1:") for port in service["ports"]),
        "the image's health check": service["healthcheck"]["test"] == check["Test"],
        "time to end": service.get("stop_grace_period") == "30s",
    }
    return [demand for demand, met in demands.items() if not met]


def image_faults(image):
    """Ways in which the image is not what the Containerfile promises."""
    user, _, group = image["User"].partition(":")
    demands = {
        "a user by number": user.isdecimal() and group.isdecimal() and int(user) > 0 < int(group),
        "the program": image["Entrypoint"] == ["/slewplan"] and image["Cmd"] == ["serve"],
        "one volume": list(image["Volumes"]) == ["/data"],
        "the database in the volume": "SLEWPLAN_DATABASE=/data/slewplan.db" in image["Env"],
        "a health check": image["Healthcheck"]["Test"] == ["CMD", "/slewplan", "health"],
        "one port": list(image["ExposedPorts"]) == ["8080/tcp"],
    }
    return [demand for demand, met in demands.items() if not met]


def main():
    image = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))["Docker"]["config"]
    judge = Judge()

    def report(what, faults):
        judge.demand(f"{what}{': ' if faults else ''}{'; '.join(faults)}", not faults)

    report("image", image_faults(image))
    compose = DEPLOY / "compose.yaml"
    schema = [Path(sys.prefix) / "bin" / "check-jsonschema", "--builtin-schema", "vendor.compose-spec", compose]
    checked = subprocess.run(schema, capture_output=True, text=True, check=False)
    report("compose.yaml against the Compose specification", [checked.stdout] if checked.returncode else [])
    services = yaml.safe_load(compose.read_text(encoding="utf-8"))["services"]
    report("compose.yaml", compose_faults(services["slewplan"], image))
    user = [int(number) for number in image["User"].split(":")]
    for path in sorted((DEPLOY / "kubernetes").glob("*.yaml")):
        for document in yaml.safe_load_all(path.read_text(encoding="utf-8")):
            faults = schema_faults(document)
            if document["kind"] == "Job":
                faults += pod_faults(document["spec"]["template"]["spec"], user) + job_faults(document["spec"])
            report(f"{path.name}: {document['kind']}, Kubernetes {' and '.join(KUBERNETES)}", faults)
    judge.end()


if __name__ == "__main__":
    SCHEMAS.enter()
    import kubernetes_validate
    import yaml

    main()
