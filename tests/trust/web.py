"""Promises about HTTP: slow clients, many clients, hostile bodies, panics."""

import json
import os
import threading
import time
import zlib
from pathlib import Path

from harness import (
    HTTP_ALIKE,
    Row,
    connect,
    exchange,
    fixture,
    gate,
    long_running,
    percentile,
    post,
    resident_kib,
    service,
    timed,
    variant,
)


def closed_after(service, *parts, pause=0.0, patience=45.0):
    """Seconds until the service closes a connection on which these parts are sent slowly."""
    begin = time.monotonic()
    with connect(service, timeout=1.0) as connection:
        for part in parts:
            try:
                connection.sendall(part)
            except OSError:
                return time.monotonic() - begin
            time.sleep(pause)
            if time.monotonic() - begin > patience:
                return None
        while time.monotonic() - begin < patience:
            try:
                if not connection.recv(65536):
                    return time.monotonic() - begin
            except TimeoutError:
                continue
            except OSError:
                return time.monotonic() - begin
    return None


# Memory that an idle service may keep of what it has been through, KiB.
KEPT = 20 * 1024
# Time after which a client has noticed that its connection is closed, s: it looks once a second.
NOTICED = 1.5


def seconds(took):
    return "never" if took is None else f"{took:.1f} s"


@gate("H1", of_a_file=HTTP_ALIKE)
def slow_clients_are_cut_off(scale):
    """Silence, half heads, drip-fed bodies; then a thousand of them and one good client."""
    head = b"POST /v1/plans HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 500\r\n\r\n"
    rows, results = [], {}
    most, count = scale.of(512, 64), scale.of(1000, 150)
    with service(scale.database("h1"), "--max-connections", str(most)) as running:
        cases = {
            "silent connection": ([b""], 0.0, 10.0),
            "half a head": ([b"GET / HTTP/1.1\r\nHo"], 0.0, 10.0),
            "head of one byte per second": ([bytes([byte]) for byte in head], 1.0, 10.0),
            "body that pauses": ([head + b"{"], 0.0, 10.0),
            "body of one byte per second": ([head, *[b" "] * 60], 1.0, 30.0),
        }
        threads = [
            threading.Thread(target=lambda name=name, parts=parts, pause=pause: results.__setitem__(name, closed_after(running, *parts, pause=pause)))
            for name, (parts, pause, _) in cases.items()
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for name, (_, _, goal) in cases.items():
            took = results[name]
            rows.append(Row("H1", f"{name} is closed after", seconds(took), f"{goal:.0f} s", took is not None and took <= goal + NOTICED))
        idle = resident_kib(running.process.pid)
        job = running.submit(long_running())
        crowd, waits = [], []
        parts = [b"", b"GET / HTTP/1.1\r\nHo", head + b"{", f"GET /v1/plans/{job}/events HTTP/1.1\r\nHost: localhost\r\n\r\n".encode()]

        def good(patience):
            end = time.monotonic() + patience
            while time.monotonic() < end:
                waits.append(timed(lambda: running.request("GET", "/health/live"))[0])
                time.sleep(0.02)

        for number in range(count):
            try:
                connection = connect(running)
                connection.sendall(parts[number % len(parts)])
                crowd.append(connection)
            except OSError:
                pass
            if number % 50 == 49:
                good(0.2)
        good(scale.of(20.0, 2.0))
        peak = resident_kib(running.process.pid, "VmHWM")
        descriptors = len(os.listdir(f"/proc/{running.process.pid}/fd"))
        for connection in crowd:
            connection.close()
        running.request("POST", f"/v1/plans/{job}/cancel")
        begin, after = time.monotonic(), resident_kib(running.process.pid)
        while after > idle + KEPT and time.monotonic() - begin < 60.0:
            time.sleep(0.2)
            after = min(after, resident_kib(running.process.pid))
        took = time.monotonic() - begin
    slow = percentile(waits, 0.99)
    rows += [
        Row("H1", f"p99 of a good client beside {count} slow ones", f"{1e3 * slow:.0f} ms", "100 ms", slow <= 0.1, timed=True),
        Row("H2", "files open under attack", str(descriptors), f"{most} + 64", descriptors <= most + 64),
        Row("H2", "memory of the idle service", f"{idle / 1024:.0f} MB", "60 MB", idle <= 60 * 1024),
        Row("H2", "peak memory under attack", f"{peak / 1024:.0f} MB", "200 MB", peak <= 200 * 1024),
        Row("H2", f"memory kept {took:.1f} s after it and the solve (60)", f"{(after - idle) / 1024:+.0f} MB", f"{KEPT / 1024:+.0f} MB", after - idle <= KEPT),
    ]
    return rows


@gate("H4", of_a_file=HTTP_ALIKE)
def solves_do_not_starve_requests(scale):
    duration, live, cached = scale.of(600.0, 5.0), [], []
    with service(scale.database("h4")) as running:
        done = running.submit(variant(0))
        running.wait_end(done)
        number = 0
        jobs = [running.submit(long_running(number)) for number in range(scale.of(80, 3))]
        end = time.monotonic() + duration
        while time.monotonic() < end:
            live.append(timed(lambda: running.request("GET", "/health/live"))[0])
            cached.append(timed(lambda: running.request("GET", f"/v1/plans/{done}/result"))[0])
            time.sleep(0.02)
        for job in reversed(jobs):
            running.request("DELETE", f"/v1/plans/{job}")
    slow, worst, read = percentile(live, 0.99), max(live), percentile(cached, 0.99)
    return [
        Row("H4", f"liveness under a full solver for {duration:.0f} s, p99", f"{1e3 * slow:.1f} ms", "50 ms", slow <= 0.05, timed=True),
        Row("H4", "slowest", f"{1e3 * worst:.0f} ms", "250 ms", worst <= 0.25, timed=True),
        Row("H4", "stored plan, p99", f"{1e3 * read:.1f} ms", "50 ms", read <= 0.05, timed=True),
    ]


def hostile_bodies():
    """Bodies, as raw requests, that must be refused: a name, the request, allowed statuses."""
    good = json.dumps(fixture("two-targets")).encode()
    cases = []

    def case(name, body, *headers, statuses=(400, 413, 415, 422), path="/v1/plans"):
        cases.append((name, post(body, path, *headers), statuses))

    megabytes = 5 << 20
    members = b"{" + b",".join([b'"":0'] * 900) + b"}"
    # To the last byte, and to the last value, that is read.
    for count in 4 << 20, 1 << 17:
        def filled(entry, values, opening=b"[", closing=b"]"):
            times = min((count - 2) // values, ((4 << 20) - 2) // (len(entry) + 1))
            return opening + b",".join([entry] * times) + closing

        case(f"numbers, at most {count}", filled(b"0", 1))
        case(f"texts, at most {count}", filled(b'"a"', 1))
        case(f"fields, at most {count}", filled(b'"":0', 2, b"{", b"}"))
        case(f"objects of fields, at most {count}", filled(members, 2 * 900 + 1))
    case("oversize", b"[" + b"0," * (megabytes // 2) + b"0]", statuses=(413,))
    chunk = b"%x\r\n" % (1 << 16) + b" " * (1 << 16) + b"\r\n"
    head = b"POST /v1/plans HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n"
    cases.append(("oversize in chunks", head + chunk * (megabytes >> 16) + b"0\r\n\r\n", (413,)))
    bomb = zlib.compress(bytes(64 << 20))
    for coding in ("gzip", "deflate", "zstd", "br"):
        case(f"{coding} bomb", bomb, "Content-Type: application/json", f"Content-Encoding: {coding}", statuses=(415,))
    for depth in (200, 10_000, 100_000):
        case(f"depth {depth}", b"[" * depth + b"]" * depth)
        case(f"objects of depth {depth}", b'{"a":' * depth + b"1" + b"}" * depth)
        case(f"open to depth {depth}", b"[" * depth)
    for digits in (400, 100_000, 4_000_000):
        case(f"number of {digits} digits", b'{"name":' + b"9" * digits + b"}")
    numbers = [b"1e400", b"-1e400", b"1e99999999999", b"NaN", b"Infinity", b"-Infinity", b"nan", b"+1", b"01", b".5", b"5.", b"0x10", b"1e", b"--1", b"1_000", b'"1"', b"null", b"true", b"[]", b"{}", b'""']
    places = ["max_torque_nm", "inertia_kg_m2", "max_speed_rad_s", "axis"]
    document = fixture("two-targets")
    for place in places:
        for number in numbers:
            wheel = dict(document["spacecraft"]["wheels"][0])
            wheel[place] = "@"
            changed = json.loads(json.dumps(document))
            changed["spacecraft"]["wheels"][0] = wheel
            # A wheel without a limit on its speed is one.
            if (place, number) != ("max_speed_rad_s", b"null"):
                case(f"{place} of {number[:12]!r}", json.dumps(changed).encode().replace(b'"@"', number))
    text = good.decode()
    for key in list(document) + ["epoch"]:
        case(f"{key} twice", (text[:-1] + f', "{key}": 1, "{key}": 2}}').encode())
        case(f"unknown field beside {key}", (text[:-1] + f', "{key}_": 1}}').encode())
        for junk in () if key not in document else (b"0", b'"x"', b"[[]]", b'{"a":1}', b"false"):
            # The name is a label.
            if key != "name" or junk != b'"x"':
                case(f"{key} is {junk!r}", (text[:-1] + "}").replace(f'"{key}": ', f'"{key}": @', 1).encode().replace(b"@", junk + b', "_": ', 1))
    for bad in (b"\xff", b"\xc3\x28", b"\xed\xa0\x80", b"\xf8\x88\x80\x80\x80", b"\x00", b'"\\ud800"', b'"\\u12"', b'"\\x41"', b'"a\nb"', b"'a'", b"// c\n1", b"[1,]", b"{,}", b'{"a"}', b"", b" ", b"\xef\xbb\xbf{}", b"[1] 2", b"nul"):
        case(f"text {bad[:8]!r}", bad)
        case(f"name {bad[:8]!r}", b'{"name":' + bad + b"}")
        case(f"in a string {bad[:8]!r}", b'{"name":"' + bad + b'"}')
    many = json.loads(text)
    many["targets"] = [dict(document["targets"][0], id=f"t{number}") for number in range(5000)]
    case("5000 targets", json.dumps(many).encode(), statuses=(413, 422))
    many["targets"] = [1] * 200_000
    case("200000 numbers as targets", json.dumps(many).encode(), statuses=(413, 422))
    wide = json.loads(text)
    wide["spacecraft"]["wheels"] = wide["spacecraft"]["wheels"] * 3000
    case("9000 wheels", json.dumps(wide).encode(), statuses=(413, 422))
    cones = json.loads(text)
    cones["spacecraft"]["boresights"] = [{"name": f"{number}" * 100, "axis": [0, 0, 1]} for number in range(100)]
    cones["keep_out"] = [{"boresight": "x", "direction": [0, 0, 0], "half_angle_deg": 0}] * 1000
    case("1000 cones of unknown boresights", json.dumps(cones).encode(), statuses=(422,))
    cones["keep_out"] = [{}] * 50_000
    case("50000 empty cones", json.dumps(cones).encode(), statuses=(422,))
    legs = {"spacecraft": document["spacecraft"], "attitudes": [1] * 30_000}
    case("legs between 30000 attitudes", json.dumps(legs).encode(), statuses=(413, 422), path="/v1/legs/query")
    flight = {"scenario": document, "plan": {"total_time_s": 1, "sequence": [], "trajectory": {"controls": []}}}
    flight["plan"]["passages"] = [{"target": "x", "time_s": 0}] * 20_000
    case("20000 unknown passages", json.dumps(flight).encode(), statuses=(422,), path="/v1/verify")
    for form in ("text/plain", "application/xml", "", "multipart/form-data; boundary=x", "application/json5"):
        case(f"form {form!r}", good, f"Content-Type: {form}", statuses=(415,))
    return cases


@gate("H7", of_a_file=HTTP_ALIKE)
def hostile_bodies_are_cheap_to_refuse(scale):
    cases = hostile_bodies()
    if scale.short:
        cases = cases[::4]
    wrong, slow, no_pointer, extra = [], [], [], {}
    with service(scale.database("h7")) as running:
        for _ in range(20):
            exchange(running, post(json.dumps(fixture("olivares-c")).encode(), "/v1/plans?validate_only=true"))
        process = running.process.pid
        for name, request, statuses in cases:
            before = resident_kib(process)
            # The highest mark begins anew at what there is now.
            Path(f"/proc/{process}/clear_refs").write_text("5")
            took, answer = timed(lambda: exchange(running, request))
            extra[name] = resident_kib(process, "VmHWM") - before
            status = int(answer[9:12]) if answer.startswith(b"HTTP/1.1 ") else 0
            if status not in statuses:
                wrong.append(f"{name}: {status}")
            if took > 0.05:
                slow.append(f"{name}: {1e3 * took:.0f} ms")
            if status == 422 and b'"pointer"' not in answer:
                no_pointer.append(name)
    for line in wrong + slow + no_pointer:
        print(f"    {line}")
    worst = max(extra, key=extra.get)
    return [
        Row("H7", f"hostile bodies not refused, of {len(cases)}", str(len(wrong)), "0", not wrong),
        Row("H7", "without a JSON pointer", str(len(no_pointer)), "0", not no_pointer),
        Row("H7", "slower than 50 ms", str(len(slow)), "0", not slow, timed=True),
        Row("H7", f"extra memory for one of them, most ({worst})", f"{extra[worst] / 1024:.1f} MB", "8 MB", extra[worst] <= 8 * 1024),
    ]

