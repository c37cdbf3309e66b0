"""Promises about requests that nobody has thought of: generated from the description and from
documents that are almost right."""

import copy
import http.client
import json
import random
import re
import threading

from harness import FIXTURES, ROOT, Row, fixture, gate, service

# Documented answers of an overloaded or full service; any other from 500 on is a defect.
EXCUSED = {503, 507}
# Longer than an entry of an index may be, and nothing to compress.
LONG = random.Random(1).randbytes(5000).hex()
STRANGE = [0, -1, 1e-300, -1e300, 1e400, 5e-324, 2**63, 0.5, 10**30, True, None, "", "x", "\u0000", "é" * 300, LONG, [], {}, [[]], [1, 2, 3, 4, 5]]
WORDS = ["", "0", "-1", "1", "99999999999999999999", "x", "%00", "%ff", "..", "null", "true", "0,0,0,1", "1,0,0", "queued", "csv", "json", "rest_to_rest", "a b", "'", "%F0%9F%9A%80"]


def operations():
    """Method, path, names of the query's parameters and documented statuses of every operation."""
    found, path, current = [], None, None
    for line in (ROOT / "openapi.yaml").read_text().splitlines():
        if line == "components:":
            break
        if match := re.fullmatch(r"  (/\S*):", line):
            path = match[1]
        elif match := re.fullmatch(r"    (get|put|post|delete):", line):
            current = (match[1].upper(), path, [], set())
            found.append(current)
        elif match := re.fullmatch(r"      - name: (\S+)", line):
            name = match[1]
        elif line == "        in: query":
            current[2].append(name)
        elif match := re.fullmatch(r"        '(\d+)':", line):
            current[3].add(int(match[1]))
    return found


def places(node, path=()):
    """The ways to all values within a document."""
    yield path
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield from places(value, (*path, key))


def spoilt(document, state):
    """A document with up to three values replaced, left out, doubled or renamed."""
    document = copy.deepcopy(document)
    for _ in range(state.randrange(4)):
        way = state.choice(list(places(document)))
        if not way:
            continue
        parent = document
        for key in way[:-1]:
            parent = parent[key]
        key, action = way[-1], state.randrange(6)
        if action < 2:
            parent[key] = copy.deepcopy(state.choice(STRANGE))
        elif action == 2 and isinstance(parent[key], (int, float)):
            parent[key] = parent[key] * state.choice([-1, 0, 1e-9, 1.0001, 1e9])
        elif action == 3:
            del parent[key]
        elif action == 4 and isinstance(parent, list):
            parent.append(copy.deepcopy(parent[key]))
        elif isinstance(parent, dict):
            parent[str(key) + state.choice(["", "_", "x"])] = copy.deepcopy(parent[key])
    return document


def bodies():
    """What is posted where, before it is spoilt."""
    plain = fixture("two-targets")
    plan = {
        "total_time_s": 1.0,
        "sequence": [target["id"] for target in plain["targets"]],
        "passages": [{"target": target["id"], "time_s": 1.0, "departure_s": 1.0} for target in plain["targets"]],
        "trajectory": {"controls": [{"start_s": 0.0, "duration_s": 1.0, "wheel_torque_nm": [0.0, 0.0, 0.0]}]},
    }
    attitudes = [{"roll_pitch_yaw_deg": angles} for angles in ([0, 0, 0], [15, 0, 10], [25, 0, 50])]
    query = {"spacecraft": plain["spacecraft"], "attitudes": attitudes, "kind": "certified", "mode": "compute"}
    pair = {"spacecraft": plain["spacecraft"], "pairs": [{"from": attitudes[0], "to": attitudes[1]}], "mode": "cached_only"}
    scenarios = [json.loads(path.read_text()) for path in sorted(FIXTURES.glob("*.json"))]
    for scenario in scenarios:
        scenario["options"] = {"time_limit_s": 0.02, "node_limit": 2}
    return {
        "/v1/plans": scenarios,
        "/v1/verify": [{"scenario": plain, "plan": plan}],
        "/v1/legs/query": [query, pair],
        "/v1/spacecraft/{name}": [plain["spacecraft"]],
    }


class Generator:
    """Requests from a seed."""

    def __init__(self, seed, ended):
        self.state = random.Random(seed)
        self.operations = operations()
        self.bodies = bodies()
        self.ended = ended

    def next(self):
        """Method, path, headers, body and the statuses that the description has for them."""
        state = self.state
        method, template, parameters, statuses = state.choice(self.operations)
        # A stream of a job that goes on would last as long as that.
        identifiers = [self.ended] if "events" in template else [self.ended, "00000000-0000-7000-8000-000000000000", *WORDS[1:]]
        path = re.sub(r"\{\w+\}", lambda _: state.choice(identifiers).replace(" ", "%20"), template)
        # Deleted, the one job that has a plan would be gone.
        if method == "DELETE" and self.ended in path:
            path = path.replace(self.ended, self.ended[:-1] + "x")
        chosen = [name for name in parameters if state.random() < 0.3]
        if state.random() < 0.03:
            chosen.append("unknown")
        if chosen:
            path += "?" + "&".join(f"{name}={state.choice(WORDS).replace(' ', '%20')}" for name in chosen)
        headers, body = {}, None
        if method in ("POST", "PUT") and template in self.bodies:
            body = json.dumps(spoilt(state.choice(self.bodies[template]), state)).replace("Infinity", "1e400")
            if state.random() < 0.1:
                place = state.randrange(len(body))
                body = body[:place] + state.choice('{}[],:"x0\\') + body[place + 1 :]
            body = body.encode("utf-8", "surrogatepass")
            headers["Content-Type"] = "application/json" if state.random() < 0.97 else "text/plain"
        if state.random() < 0.05:
            headers["Idempotency-Key"] = state.choice(["a", "b", "c" * 300, "d e"])
        if state.random() < 0.05:
            headers["Accept"] = state.choice(["text/csv", "application/json", "image/png", "*/*", ";;"])
        if state.random() < 0.05:
            headers["If-None-Match"] = state.choice(['"x"', "*", "x"])
        if state.random() < 0.02:
            method = state.choice(["PATCH", "PUT", "DELETE", "OPTIONS", "HEAD"])
            statuses = {*range(200, 500), *EXCUSED}
        # Of a path that the words have made another one.
        return method, path, headers, body, statuses | {404, 405}


def answered(connection, method, path, body, headers):
    connection.request(method, path, body, headers)
    answer = connection.getresponse()
    answer.read()
    return answer.status


def ask(running, seed, count, ended):
    """Statuses of so many requests, and what was wrong with them."""
    generator, statuses, wrong = Generator(seed, ended), {}, []
    connection = http.client.HTTPConnection(*running.address, timeout=60)
    for _ in range(count):
        method, path, headers, body, documented = generator.next()
        try:
            try:
                status = answered(connection, method, path, body, headers)
            except (http.client.RemoteDisconnected, BrokenPipeError, ConnectionResetError):
                # A service may close a connection after any answer.
                connection.close()
                status = answered(connection, method, path, body, headers)
        except (http.client.HTTPException, OSError) as error:
            connection.close()
            status = 0
            wrong.append(f"{method} {path}: {error!r}")
        statuses[status] = statuses.get(status, 0) + 1
        if status and (status not in documented or status >= 500 and status not in EXCUSED):
            wrong.append(f"{method} {path}: {status}; {(body or b'')[:300]!r}")
    connection.close()
    return statuses, wrong


def merged(parts):
    total = {}
    for part in parts:
        for status, count in part.items():
            total[status] = total.get(status, 0) + count
    return total


@gate("H8")
def no_generated_request_breaks_anything(scale):
    """Besides these, tests/schemathesis.sh generates requests from the schemas alone."""
    total, workers = scale.of(100_000, 2_000), 4
    with service(scale.database("h8"), "--queue-limit", "50") as running:
        ended = running.submit(fixture("two-targets"))
        running.wait_end(ended)
        results = [None] * workers

        def work(index):
            results[index] = ask(running, index, total // workers, ended)

        threads = [threading.Thread(target=work, args=(index,)) for index in range(workers)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        alive = running.request("GET", "/health/live")[0] == 200
    statuses = merged(result[0] for result in results)
    wrong = [line for result in results for line in result[1]]
    for line in wrong[:20]:
        print(f"    {line}")
    panics = running.told().count("panic")
    shares = " ".join(f"{status}:{count}" for status, count in sorted(statuses.items()))
    return [
        Row("H8", f"undocumented or 5xx, of {sum(statuses.values())} ({shares})"[:78], str(len(wrong)), "0", not wrong and alive),
        Row("H8", "panics in the log", str(panics), "0", panics == 0),
    ]
