"""Services and workers on one Postgres, as the Compose file and the manifests have them: their commands, from
the files of the image, on a Postgres of this system. They share the network of this machine: each has a port of
its own instead of the one that is stated."""

import os
import re
import secrets
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "load"))

from client import Client, end, free_port  # noqa: E402
from manifests import DEPLOY  # noqa: E402
from names import Names  # noqa: E402
from room import files  # noqa: E402

from postgres import Postgres, program  # noqa: E402

from common import FIXTURES  # noqa: E402

SCENARIO = FIXTURES / "two-targets.json"
SECRET = re.compile(r"\$\{(\w+):\?[^}]*\}")
PORT = re.compile(r"0\.0\.0\.0:\d+$")
# Longest wait for a health check, s.
PATIENCE_S = 60.0
WORKERS = 2


def documents(path):
    """The documents of a file, with secrets of its own; an engine takes those of Compose from .env."""
    import yaml

    made = {}
    text = SECRET.sub(lambda found: made.setdefault(found[1], secrets.token_hex(24)), path.read_text(encoding="utf-8"))
    return list(yaml.safe_load_all(text))


def in_time(check):
    """Whether a health check passes in time."""
    end_s = time.monotonic() + PATIENCE_S
    while not (passed := check()) and time.monotonic() < end_s:
        time.sleep(0.2)
    return passed


class Compose:
    """The services of the Compose file."""

    name = "compose"

    def __init__(self, room, etc):
        [project] = documents(DEPLOY / "compose.postgres.yaml")
        self.room, self.services, self.configs = room, project["services"], project["configs"]
        self.mounts = [(etc, "/etc", "ro")]
        self.replicas = {"api": 1, "worker": WORKERS}

    def prepare(self, judge, server):
        """What the image of Postgres does with its settings and with the scripts that it is given."""
        given = self.services["postgres"]["environment"]
        user, name = given["POSTGRES_USER"], given["POSTGRES_DB"]
        server.execute(
            "postgres",
            f"CREATE ROLE {user} LOGIN SUPERUSER PASSWORD '{given['POSTGRES_PASSWORD']}'",
            f"CREATE DATABASE {name} OWNER {user}",
        )
        path = f"{Path(program('psql')).parent}:{os.environ['PATH']}"
        for script in self.services["postgres"]["configs"]:
            content = self.configs[script["source"]]["content"].replace("$$", "$")
            settings = {**os.environ, **given, "PATH": path, "PGHOST": server.folder}
            subprocess.run(["sh", "-c", content], env=settings, check=True, stdout=subprocess.DEVNULL)
        kind, check, *arguments = self.services["postgres"]["healthcheck"]["test"]
        asked = [program(check), *arguments]
        well = kind == "CMD" and in_time(lambda: subprocess.run(asked, stdout=subprocess.DEVNULL).returncode == 0)
        judge.demand("compose: Postgres is well by the check of the file", well)

    def settings(self, name, port):
        given = {"PGPORT": os.environ["PGPORT"], "SLEWPLAN_LISTEN": "0.0.0.0:8080", **self.services[name]["environment"]}
        return {key: PORT.sub(f"0.0.0.0:{port}", str(value)) for key, value in given.items()}

    def run(self, name, command=None):
        """Runs a container to its end."""
        return self.room.run(command or self.services[name]["command"], self.mounts, **self.settings(name, 0))

    def start(self, name, port, log):
        return self.room.start(self.services[name]["command"], self.mounts, log, **self.settings(name, port))

    def is_well(self, name, port):
        """The health check of the file, in a running container."""
        kind, entry, *arguments = self.services[name]["healthcheck"]["test"]
        if [kind, entry] != ["CMD", *self.room.image["Entrypoint"]]:
            raise RuntimeError(f"{name} is checked by another program than its own")
        return self.room.run(arguments, self.mounts, **self.settings(name, port)).returncode == 0


class Kubernetes:
    """The pods of the manifests, with a Secret as they describe it."""

    name = "kubernetes"
    places = {"migrate": "migrate.yaml", "api": "api.yaml", "worker": "workers.yaml"}

    def __init__(self, room, etc):
        self.room, self.pods, self.replicas = room, {}, {}
        for name, place in self.places.items():
            for document in documents(DEPLOY / "kubernetes" / "service" / place):
                if document["kind"] in ("Job", "Deployment"):
                    self.pods[name] = document["spec"]["template"]["spec"]["containers"][0]
                if document["kind"] == "Deployment":
                    # Of the workers there are as many as the autoscaler says.
                    self.replicas[name] = document["spec"].get("replicas", WORKERS)
        self.secret = {}
        self.folder = etc.parent / "database"
        self.folder.mkdir()
        self.mounts = [(etc, "/etc", "ro"), (self.folder, "/database", "ro")]

    def prepare(self, judge, server):
        """Two roles, and their addresses in the Secret. The server proves who it is."""
        [granted] = [one["value"] for one in self.pods["migrate"]["env"] if one["name"] == "SLEWPLAN_GRANT_TO"]
        password = secrets.token_hex(24)
        server.execute(
            "postgres",
            f"CREATE ROLE slewplan_owner LOGIN PASSWORD '{password}'",
            f"ALTER ROLE {granted} PASSWORD '{password}'",
            "CREATE DATABASE slewplan OWNER slewplan_owner",
        )
        for key, role in (("owner-url", "slewplan_owner"), ("url", granted)):
            self.secret[key] = f"postgres://{role}:{password}@localhost/slewplan?sslmode=verify-full"
        (self.folder / "ca.crt").write_bytes((Path(server.folder) / "ca.crt").read_bytes())

    def settings(self, name, port):
        given = {"PGPORT": os.environ["PGPORT"], "SLEWPLAN_LISTEN": f"0.0.0.0:{port}"}
        for one in self.pods[name]["env"]:
            given[one["name"]] = one.get("value") or self.secret[one["valueFrom"]["secretKeyRef"]["key"]]
        return given

    def arguments(self, name, port):
        return [PORT.sub(f"0.0.0.0:{port}", argument) for argument in self.pods[name]["args"]]

    def run(self, name, command=None):
        """Runs a pod to its end."""
        return self.room.run(command or self.arguments(name, 0), self.mounts, **self.settings(name, 0))

    def start(self, name, port, log):
        return self.room.start(self.arguments(name, port), self.mounts, log, **self.settings(name, port))

    def is_well(self, name, port):
        """Both probes of the manifest."""
        paths = [self.pods[name][f"{kind}Probe"]["httpGet"]["path"] for kind in ("readiness", "liveness")]
        try:
            return all(Client(port).ask("GET", path)[0] == 200 for path in paths)
        except OSError:
            return False


def only_with_passwords(server):
    """By TCP the server lets nobody in without one."""
    access = Path(server.folder) / "data" / "pg_hba.conf"
    access.write_text(re.sub(r"(?m)^(host.*)trust$", r"\1scram-sha-256", access.read_text()))
    server.execute("postgres", "SELECT pg_reload_conf()")


def shared(judge, room, work):
    """Both of them."""
    for kind, environment in ((Compose, {}), (Kubernetes, {"POSTGRES_TLS": "1"})):
        own, before = work / kind.name, files(room.root)
        own.mkdir()
        etc = own / "etc"
        etc.mkdir()
        # Of the server too, and of the programs of it that are called here.
        os.environ["PGPORT"] = str(free_port())
        with ExitStack() as stack:
            stack.enter_context(Names(etc, "postgres"))
            server = stack.enter_context(Postgres("listen_addresses=localhost", environment=environment))
            only_with_passwords(server)
            up(judge, kind(room, etc), server, own / "log")
        del os.environ["PGPORT"]
        judge.demand(f"{kind.name}: nothing was written to the image's files", files(room.root) == before)


def up(judge, containers, server, log_path):
    """Everything in the order of its conditions; a plan; the server away and there again; the end."""
    what = containers.name
    containers.prepare(judge, server)
    migrated = containers.run("migrate")
    judge.demand(f"{what}: the schema is prepared {migrated.stderr.strip()[-200:]}", migrated.returncode == 0)
    made = containers.run("api", ["keys", "create", "mission-a"])
    judge.demand(f"{what}: a key is made by the role that only runs", made.returncode == 0)
    if migrated.returncode or made.returncode:
        return
    started = []
    with open(log_path, "a", encoding="utf-8") as log:
        try:
            for name, count in containers.replicas.items():
                ports = [free_port() for _ in range(count)]
                started += [(name, port, containers.start(name, port, log)) for port in ports]
            for name, port, _ in started:
                judge.demand(f"{what}: {name} is well by the check that is stated", in_time(lambda: containers.is_well(name, port)))
            api = next(port for name, port, _ in started if name == "api")
            client = Client(api, made.stdout.split()[0])
            judge.demand(f"{what}: who has no key is refused", Client(api).ask("GET", "/v1/plans")[0] == 401)
            form = {"Content-Type": "application/json", "Prefer": "wait=60"}
            answered, plan = client.ask("POST", "/v1/plans", SCENARIO.read_text(), **form)
            judge.demand(f"{what}: a scenario is solved by a worker", (answered, plan.get("status")) == (200, "optimal"))
            server.kill()
            judge.demand(f"{what}: without Postgres none is well", in_time(lambda: not any(containers.is_well(name, port) for name, port, _ in started)))
            server.start()
            well = in_time(lambda: all(containers.is_well(name, port) for name, port, _ in started))
            judge.demand(f"{what}: with it all are again, none of them started again", well and all(one.poll() is None for *_, one in started))
        finally:
            for *_, process in started:
                if process.poll() is None:
                    end(judge, process)
