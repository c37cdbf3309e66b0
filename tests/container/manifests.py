#!/usr/bin/env python3
"""Holds the Compose files and the Kubernetes manifests against their schemas and against our own rules.

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


def pod_faults(pod, user, writable):
    """Ways in which a pod is less confined than the restricted profile and a read-only root, of which only
    some places are writable."""
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
        f"writable is {writable}": [m["mountPath"] for m in mounts if not m.get("readOnly")] == writable,
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


def told_metrics():
    """Names of all metrics that the program has."""
    sources = (TESTS.parent / "server" / "src").rglob("*.rs")
    return set(re.findall(r'"(slewplan_\w+)"', "".join(path.read_text(encoding="utf-8") for path in sources)))


def database_faults(container):
    """Ways in which a process does not connect as it should: by a reference to a secret."""
    given = {variable["name"]: variable for variable in container["env"]}
    address = given["SLEWPLAN_DATABASE"]
    demands = {
        "the address of the database is a secret": "value" not in address and "secretKeyRef" in address["valueFrom"],
        "no password in plain": "PGPASSWORD" not in given,
        "only the owner migrates": (address["valueFrom"]["secretKeyRef"]["key"] == "owner-url")
        == (container["args"][0] == "migrate"),
    }
    return [demand for demand, met in demands.items() if not met]


def deployment_faults(spec):
    """Ways in which processes of a deployment would not be found, watched, or given time to end."""
    pod = spec["template"]["spec"]
    container = pod["containers"][0]
    ports = {port["name"] for port in container["ports"]}
    probes = {kind: container[f"{kind}Probe"]["httpGet"] for kind in ("readiness", "liveness")}
    demands = {
        "its pods are its own": spec["selector"]["matchLabels"].items() <= spec["template"]["metadata"]["labels"].items(),
        "probes": [probe["path"] for probe in probes.values()] == ["/health/ready", "/health/live"],
        "probes at its port": {probe["port"] for probe in probes.values()} == ports,
        "time to end": pod["terminationGracePeriodSeconds"] >= 30,
    }
    return [demand for demand, met in demands.items() if not met] + database_faults(container)


def service_faults(documents):
    """Ways in which the manifests of the service do not belong together."""
    of_kind = {}
    for document in documents:
        of_kind.setdefault(document["kind"], []).append(document)
    deployments = {document["metadata"]["name"]: document["spec"] for document in of_kind["Deployment"]}
    [service], [scaler] = of_kind["Service"], of_kind["HorizontalPodAutoscaler"]
    chosen = [
        name
        for name, spec in deployments.items()
        if service["spec"]["selector"].items() <= spec["template"]["metadata"]["labels"].items()
    ]
    target = scaler["spec"]["scaleTargetRef"]
    metrics = {metric["external"]["metric"]["name"] for metric in scaler["spec"]["metrics"]}
    demands = {
        "the Service is that of the API": chosen == ["slewplan-api"],
        "its port is there": service["spec"]["ports"][0]["targetPort"]
        in {port["name"] for port in deployments["slewplan-api"]["template"]["spec"]["containers"][0]["ports"]},
        "the workers are scaled": [target["kind"], target["name"]] == ["Deployment", "slewplan-worker"],
        "nobody else says how many": "replicas" not in deployments["slewplan-worker"],
        f"the program tells {metrics}": metrics <= told_metrics(),
    }
    return [demand for demand, met in demands.items() if not met]


def shared_compose_faults(services, image):
    """Ways in which the processes on one Postgres differ from the image or do not wait for each other."""
    own = {name: service for name, service in services.items() if name != "postgres"}
    commands = {name: service["command"][0] for name, service in own.items()}
    demands = {
        "all commands": commands == {"migrate": "migrate", "api": "serve", "worker": "work"},
        "who has not migrated solves nothing": "--no-worker" in own["api"]["command"],
        "the schema waits for Postgres": own["migrate"]["depends_on"]["postgres"]["condition"] == "service_healthy",
        "the others wait for the schema": all(
            own[name]["depends_on"]["migrate"]["condition"] == "service_completed_successfully"
            for name in ("api", "worker")
        ),
        "only this machine": all(port.startswith("127.0.0.1:") for port in own["api"]["ports"]),
        "nobody else reaches Postgres": "ports" not in services["postgres"],
        "the image's health check": all(
            own[name]["healthcheck"]["test"] == image["Healthcheck"]["Test"] for name in ("api", "worker")
        ),
        "passwords are not in the file": all(
            value.startswith("${")
            for service in services.values()
            for name, value in service["environment"].items()
            if "PASSWORD" in name
        ),
        "the owner only migrates": [name for name, s in own.items() if "owner@" in s["environment"]["SLEWPLAN_DATABASE"]]
        == ["migrate"],
        "memory": all("mem_limit" in service for service in own.values()),
    }
    faults = [demand for demand, met in demands.items() if not met]
    for name, service in own.items():
        confined = {
            "the image's user": service.get("user") == image["User"],
            "read-only root": service.get("read_only") is True,
            "no capabilities": service.get("cap_drop") == ["ALL"] and "cap_add" not in service,
            "no more privileges": service.get("security_opt") == ["no-new-privileges:true"],
            "time to end": service.get("stop_grace_period") == "30s",
        }
        faults += [f"{name}: {demand}" for demand, met in confined.items() if not met]
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
    services = {}
    for name in ("compose.yaml", "compose.postgres.yaml"):
        compose = DEPLOY / name
        # Interpolation and anchors are resolved before the schema sees the file.
        schema = [Path(sys.prefix) / "bin" / "check-jsonschema", "--builtin-schema", "vendor.compose-spec", compose]
        checked = subprocess.run(schema, capture_output=True, text=True, check=False)
        report(f"{name} against the Compose specification", [checked.stdout] if checked.returncode else [])
        services[name] = yaml.safe_load(compose.read_text(encoding="utf-8"))["services"]
    report("compose.yaml", compose_faults(services["compose.yaml"]["slewplan"], image))
    report("compose.postgres.yaml", shared_compose_faults(services["compose.postgres.yaml"], image))
    user = [int(number) for number in image["User"].split(":")]
    shared = []
    for path in sorted((DEPLOY / "kubernetes").rglob("*.yaml")):
        of_service = path.parent.name == "service"
        for document in yaml.safe_load_all(path.read_text(encoding="utf-8")):
            faults = schema_faults(document)
            if of_service:
                shared.append(document)
            if document["kind"] in ("Job", "Deployment"):
                pod = document["spec"]["template"]["spec"]
                faults += pod_faults(pod, user, [] if of_service else ["/data"])
                if document["kind"] == "Deployment":
                    faults += deployment_faults(document["spec"])
                elif of_service:
                    faults += database_faults(pod["containers"][0])
                else:
                    faults += job_faults(document["spec"])
            report(f"{path.name}: {document['kind']}, Kubernetes {' and '.join(KUBERNETES)}", faults)
    report("the manifests of the service", service_faults(shared))
    judge.end()


if __name__ == "__main__":
    SCHEMAS.enter()
    import kubernetes_validate
    import yaml

    main()
