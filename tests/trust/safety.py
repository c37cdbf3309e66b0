"""Promises about who may do what."""

import itertools
import json
import re
import subprocess
from pathlib import Path

from harness import HTTP_ALIKE, ROOT, Row, binary, cargo_test, exchange, gate, service, variant


# Licences under which everybody may use, change and pass on; MPL-2.0 asks for changes to its own files
# only, and only tests have such a package.
LICENCES = {"MPL-2.0", "MIT", "Apache-2.0", "BSD-3-Clause", "Zlib", "BSL-1.0", "Unlicense", "Unicode-3.0", "ISC", "CC0-1.0"}


def is_free(expression):
    """Whether one of the alternatives of a licence is made of known ones only."""
    alternatives = re.split(r" OR | ?/ ?", expression.replace("(", "").replace(")", ""))
    terms = lambda alternative: {term.split(" WITH ")[0].strip() for term in alternative.split(" AND ")}
    return any(terms(alternative) <= LICENCES for alternative in alternatives)


@gate("S5", of_a_file="the sources")
def dependencies_are_clean(_):
    """Licences and sources of what is linked, and the advisories where cargo-deny is there."""
    told = subprocess.run(["cargo", "metadata", "--locked", "--format-version", "1"], cwd=ROOT, capture_output=True, text=True, check=True)
    packages = json.loads(told.stdout)["packages"]
    foreign = [package["name"] for package in packages if package["source"] not in (None, "registry+https://github.com/rust-lang/crates.io-index")]
    unfree = [f"{package['name']}: {package['license']}" for package in packages if not is_free(package["license"] or "")]
    locked = (ROOT / "Cargo.lock").read_text()
    unsummed = locked.count("\nsource = ") - locked.count("\nchecksum = ")
    lints = "unsafe_code = \"forbid\"" in (ROOT / "Cargo.toml").read_text()
    own = [package["name"] for package in packages if package["source"] is None]
    unguarded = [name for name in own if "[lints]\nworkspace = true" not in next(Path(p["manifest_path"]).read_text() for p in packages if p["name"] == name)]
    for line in foreign + unfree + unguarded:
        print(f"    {line}")
    deny = subprocess.run(["cargo", "deny", "check", "advisories"], cwd=ROOT, capture_output=True, text=True)
    advisories = "none" if deny.returncode == 0 else "cargo-deny or its database is not here" if "no such command" in deny.stderr or "fetch" in deny.stderr else "some"
    return [
        Row("S5", f"packages of unknown licences, of {len(packages)}", str(len(unfree)), "0", not unfree),
        Row("S5", "packages from elsewhere than crates.io, or without a checksum", str(len(foreign) + unsummed), "0", not foreign and unsummed == 0),
        Row("S5", f"own packages that do not forbid unsafe code, of {len(own)}", str(len(unguarded)), "0", lints and not unguarded),
        Row("S5", "advisories", advisories, "none", advisories == "none"),
    ]


def make_key(database, *arguments):
    made = subprocess.run([binary(), "keys", "create", *arguments, "--database", str(database)], capture_output=True, text=True, check=True)
    return made.stdout.strip()


@gate("S2")
def clients_are_isolated(scale):
    """The tests of keys: what every route answers without a key, with a wrong, a revoked and a foreign one."""
    database = {"SLEWPLAN_TEST_DATABASE": "postgres" if scale.shared else "sqlite"}
    passed = re.search(r"test result: ok\. (\d+) passed", cargo_test("--test", "service", "keys::", **database))
    return [Row("S2", "clients are isolated on every route: tests that pass", passed[1] if passed else "not all", "all", bool(passed))]


@gate("S1")
def keys_cannot_be_read(scale):
    database = scale.database("s1")
    key = make_key(database, "canary")
    with service(database, "--log-format", "json") as running:
        bearer = {"Authorization": f"Bearer {key}"}
        job = running.submit(variant(0), **bearer)
        answers = []
        for path in ("/v1/plans", f"/v1/plans/{job}", "/v1/plans/none", "/metrics", "/v1/nothing"):
            answers.append(running.request("GET", path, headers=bearer)[1])
            answers.append(running.request("GET", path, headers={"Authorization": f"Basic {key}"})[1])
    artefacts = database.files()
    found = sum(key.encode() in path.read_bytes() for path in artefacts) + (key in str(answers))
    bits = 4 * len(key.removeprefix("slewplan_"))
    return [
        Row("S1", f"files and answers that contain the key, of {len(artefacts) + len(answers)}", str(found), "0", found == 0),
        Row("S1", "random bits of a key", str(bits), "128", bits >= 128),
    ]


TRAVERSALS = [
    prefix + form + "etc/passwd"
    for prefix in ("/", "/page/", "/docs/", "/docs//", "/v1/plans/", "/v1/spacecraft/", "/v1/legs/")
    for form in (
        "../../../../",
        "..%2f..%2f..%2f",
        "%2e%2e/%2e%2e/%2e%2e/",
        "%2e%2e%2f%2e%2e%2f",
        "%252e%252e%252f",
        "..\\..\\..\\",
        "..%5c..%5c",
        "....//....//",
        "/",
        "%00/",
        "%c0%ae%c0%ae/",
        "..;/",
    )
]


@gate("S3", of_a_file=HTTP_ALIKE)
def no_path_escapes(scale):
    """Every traversal is refused, and nothing but the database is opened."""
    database, wrong = scale.database("s3"), []
    trace = scale.work / "s3.trace"
    with service(database) as running:
        tracer = None
        try:
            tracer = subprocess.Popen(["strace", "-f", "-qq", "-e", "trace=openat,open", "-o", trace, "-p", str(running.process.pid)], stderr=subprocess.DEVNULL)
        except FileNotFoundError:
            pass
        for path in TRAVERSALS:
            answer = exchange(running, f"GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode("latin1"))
            status = int(answer[9:12])
            if status not in (400, 404) or b"root:" in answer:
                wrong.append(f"{path}: {status}")
        if tracer:
            tracer.terminate()
            tracer.wait()
    for line in wrong:
        print(f"    {line}")
    rows = [Row("S3", f"traversals not answered with 400 or 404, of {len(TRAVERSALS)}", str(len(wrong)), "0", not wrong)]
    if trace.exists():
        opened = set(re.findall(r'open(?:at)?\([^"]*"([^"]+)"', trace.read_text()))
        foreign = {path for path in opened if not path.startswith((str(database), str(scale.work), "/proc/self", "/sys/"))}
        rows.append(Row("S3", f"files opened outside of the data {sorted(foreign)[:3]}", str(len(foreign)), "0", not foreign))
    return rows


@gate("S6", of_a_file=HTTP_ALIKE)
def defaults_are_safe(scale):
    database, bare, leaks, taken = scale.database("s6"), [], [], []
    help_text = subprocess.run([binary(), "serve", "--help"], capture_output=True, text=True, check=True).stdout
    refused = subprocess.run([binary(), "serve", "--listen", "0.0.0.0:0", "--database", str(database)], capture_output=True, text=True, timeout=20)
    with service(database) as running:
        requests = [("GET", path) for path in ("/", "/docs/", "/docs/errors", "/openapi.yaml", "/v1/plans", "/v1/plans/x", "/v1/legs", "/v1/limits", "/health/ready", "/metrics", "/none", "/v1/plans/%ff")]
        requests += [("POST", "/v1/plans"), ("PATCH", "/v1/plans"), ("OPTIONS", "/v1/plans"), ("DELETE", "/v1/plans/x")]
        for (method, path), origin in itertools.product(requests, ("", "Origin: https://elsewhere.example\r\n")):
            answer = exchange(running, f"{method} {path} HTTP/1.1\r\nHost: localhost\r\n{origin}Connection: close\r\n\r\n".encode()).decode("utf-8", "replace")
            head, _, body = answer.partition("\r\n\r\n")
            head = head.lower()
            needed = ("x-content-type-options: nosniff", "frame-ancestors 'none'", "cache-control:", "x-request-id:")
            if any(text not in head for text in needed) or "access-control" in head:
                bare.append(f"{method} {path}")
            if int(answer[9:12]) >= 400 and re.search(r"(SELECT|INSERT|sqlx|\.rs:|/root/|/home/|" + re.escape(str(scale.work)) + ")", body):
                leaks.append(f"{method} {path}")
            if origin and int(answer[9:12]) != 403:
                taken.append(f"{method} {path}")
        rebound = exchange(running, b"GET /v1/plans HTTP/1.1\r\nHost: elsewhere.example\r\nConnection: close\r\n\r\n")
        if b" 403 " not in rebound[:16]:
            taken.append("Host: elsewhere.example")
        preface = exchange(running, b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", timeout=15.0)
    return [
        Row("S6", "default address", "127.0.0.1:8080", "loopback", "default: 127.0.0.1:8080" in help_text),
        Row("S6", "other addresses without keys: exit code", str(refused.returncode), "not 0", refused.returncode == 2),
        Row("S6", f"answers without the headers, of {len(requests)} {bare}", str(len(bare)), "0", not bare),
        Row("S6", f"errors that tell about the inside {leaks}", str(len(leaks)), "0", not leaks),
        Row("S6", f"requests of foreign pages and names that are served {taken}", str(len(taken)), "0", not taken),
        Row("S6", "HTTP/2", "off" if not preface.startswith(b"\x00") else "on", "off", not preface.startswith(b"\x00\x00")),
    ]
