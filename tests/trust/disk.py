"""Promises about the database: full disks, failing disks, locks, copies."""

import errno
import json
import random
import shutil
import sqlite3
import subprocess
import threading
import time

from disks import failing, small_disk
from harness import (
    ROOT,
    Background,
    Row,
    binary,
    connect,
    elsewhere,
    gate,
    percentile,
    ready,
    service,
    timed,
    until,
    variant,
)
from systems import FileDatabase

elsewhere(
    "D1",
    "SQLite is at least 3.51.3, or neither build nor start",
    "3.51.3",
    "const assertion and check at start in store.rs",
    of_a_file="the version of SQLite; of Postgres, 15 or newer, a check at start",
)


@gate("D2")
def a_full_disk_is_survived(scale):
    """A small file system, filled and freed again and again under the running system. On a server it has the
    tables; a server whose log has no room ends, which is a server that is away."""
    rounds, statuses, slowest, reads, recoveries = scale.rounds(20, 3), {}, 0.0, set(), []
    unnamed, state = 0, random.Random(2)
    with small_disk(scale, "d2") as disk, service(disk.database, environment=disk.environment) as running:
        known = running.submit(variant(0))
        running.wait_end(known)
        pids = [one.process.pid for one in running.processes]
        for number in range(rounds):
            disk.fill()
            # What pages and logs have room for still passes; what cannot be packed soon does not.
            big = variant(number + 1)
            big["name"] = state.randbytes(100_000).hex()
            for _ in range(40):
                took, (status, answer) = timed(lambda: running.request("POST", "/v1/plans", big))
                slowest = max(slowest, took)
                if status != 202:
                    statuses[status] = statuses.get(status, 0) + 1
                    unnamed += status == 507 and answer["code"] != "disk_full"
                    break
            reads.add(running.request("GET", f"/v1/plans/{known}/result")[0])
            reads.add(running.request("GET", "/health/live")[0])
            disk.free()
            recoveries.append(until(lambda: running.request("POST", "/v1/plans", variant(0))[0] == 202, 10.0))
            for job in running.request("GET", "/v1/plans?limit=100")[1]["plans"]:
                if job["id"] != known:
                    running.request("DELETE", f"/v1/plans/{job['id']}")
        alive = [one.process.pid for one in running.processes if one.process.poll() is None] == pids
        log = running.told()
        running.terminate()
        intact = disk.database.sound()
    recovered = [wait for wait in recoveries if wait is not None]
    worst = max(recovered, default=float("inf"))
    return [
        Row("D2", f"refusals while full, of {rounds}: status {statuses}", str(sum(statuses.values())), f"{rounds} x 507/503", set(statuses) <= {503, 507} and sum(statuses.values()) == rounds and unnamed == 0),
        Row("D2", "slowest answer to a write while full", f"{1e3 * slowest:.0f} ms", "1000 ms", slowest <= 1.0, timed=True),
        Row("D2", f"reads while full: statuses {sorted(reads)}", str(len(reads)), "only 200", reads == {200}),
        Row("D2", f"writes again after room was made, {len(recovered)} of {rounds}, slowest", f"{worst:.2f} s", "5 s", len(recovered) == rounds and worst <= 5.0 and alive and intact),
        Row("D2", "panics", str(log.count("panic")), "0", "panic" not in log),
    ]


def submitted(running, scenario, acknowledged):
    """The status of a submission, which is acknowledged or not."""
    status, job = running.request("POST", "/v1/plans", scenario)
    if status == 202:
        acknowledged.append(job["id"])
    return status


@gate("D3")
def errors_of_the_disk_stop_or_pass(scale):
    """The n-th write or sync fails: writes are refused cleanly. After a failed sync on a file the process
    ends; Postgres ends its own, and begins again from its log, while the services stay."""
    acknowledged, wrong, late, unsound, exits = [], [], [], 0, 0
    last, many = scale.rounds(300, 12), ("--queue-limit", "100000")
    # A server recovers meanwhile.
    patience = 15.0 if scale.shared else 1.0
    with failing(scale, "d3") as disk:
        database, faults = disk.database, disk.faults
        running = service(database, *many, environment=disk.environment)
        for number in range(1, last + 1):
            what, scenario = "sync" if number % 2 else "write", variant(number % 20)
            faults.fail(what, 1 + number // 2 % 30, errno.EIO)
            begin = time.monotonic()
            while faults.pending(what) and time.monotonic() - begin < 5.0:
                try:
                    if submitted(running, scenario, acknowledged) not in (202, 500, 503, 507):
                        wrong.append(number)
                except OSError:
                    break
            faults.clear()
            begin = time.monotonic()
            if what == "sync" and not scale.shared:
                code = until(lambda: running.process.poll() is not None, 2.0) and running.process.poll()
                if code is not None:
                    exits += 1
                    late.append(time.monotonic() - begin)
                    wrong += [number] if code == 0 else []
                    running.__exit__()
                    unsound += not database.sound()
                    running = service(database, *many, environment=disk.environment)
                continue
            if not disk.serves():
                disk.restart()
            waited = until(lambda: submitted(running, scenario, acknowledged) == 202, patience)
            wrong += [number] if waited is None else []
            late += [waited] if scale.shared and waited else []
        gone = sum(one.process.poll() is not None for one in running.processes)
        running.__exit__()
        unsound += not database.sound()
        stored = {identifier for (identifier,) in database.rows("SELECT id FROM jobs")}
    lost, syncs = sum(identifier not in stored for identifier in acknowledged), (last + 1) // 2
    longest = max(late, default=9.0)
    if scale.shared:
        rows = [
            Row("D3", "processes that ended while the disk of the server failed", str(gone), "0", gone == 0),
            Row("D3", "submissions are taken again after", f"{longest:.2f} s", f"{patience:.0f} s", longest <= patience, timed=True),
        ]
    else:
        rows = [
            Row("D3", f"exits after a failed sync, of {syncs} (the rest: the service survived)", str(exits), str(syncs), exits == syncs),
            Row("D3", "slowest exit", f"{longest:.2f} s", "2 s", longest <= 2.0, timed=True),
        ]
    return [
        *rows,
        Row("D3", f"failures after which a write was not taken within {patience:.0f} s, wrong codes", str(len(wrong)), "0", not wrong),
        Row("D3", f"acknowledged jobs lost, of {len(acknowledged)}", str(lost), "0", lost == 0 and bool(acknowledged)),
        Row("D3", "times that the database was found damaged", str(unsound), "0", unsound == 0),
    ]


@gate("D7")
def the_writer_heals(scale):
    """Single failures of writes: the next write succeeds. On a server a connection is ended each time."""
    rounds, waits, many = scale.rounds(100, 10), [], ("--queue-limit", "100000")
    with failing(scale, "d7") as disk, service(disk.database, *many, environment=disk.environment) as running:
        for number in range(rounds):
            disk.fail_once(errno.ENOSPC if number % 2 else errno.EIO)
            running.request("POST", "/v1/plans", variant(0))
            disk.faults.clear()
            wait = until(lambda: running.request("POST", "/v1/plans", variant(0))[0] == 202, 10.0)
            waits += [wait] if wait is not None and ready(running) == 200 else []
    worst = max(waits, default=float("inf"))
    return [
        Row("D7", f"failures after which a write and readiness succeed, of {rounds}", str(len(waits)), str(rounds), len(waits) == rounds),
        Row("D7", "slowest write after a failure", f"{worst:.2f} s", "1 s", worst <= 1.0, timed=True),
    ]


@gate("D5", of_a_file="locks, log and copies of a file; of a server they are those of Postgres")
def nobody_sees_a_locked_database(scale):
    """Writes, reads, copies and checkpoints together; D6 and D9 are measured on the way."""
    database, seconds = scale.file("d5"), scale.of(300.0, 6.0)
    statuses, wal, plain, copying = {}, [], [], []
    guard = threading.Lock()
    copies, sound_copies, restores = 0, 0, []
    with service(database, "--queue-limit", "1000000") as running:
        job = running.submit(variant(0))
        running.wait_end(job)
        in_copy = threading.Event()

        def write(index, count):
            try:
                took, (status, _) = timed(lambda: running.request("POST", "/v1/plans", variant(0)))
            except OSError:
                status, took = 0, 0.0
            with guard:
                statuses[status] = statuses.get(status, 0) + 1
                (copying if in_copy.is_set() else plain).append(took)

        def read(index, count):
            try:
                status, _ = running.request("GET", f"/v1/plans/{job}/result")
            except OSError:
                status = 0
            with guard:
                statuses[status] = statuses.get(status, 0) + 1

        def look(index, count):
            log = database.with_name(database.name + "-wal")
            wal.append(log.stat().st_size if log.exists() else 0)
            time.sleep(0.1)

        slow = connect(running)
        slow.sendall(f"GET /v1/plans/{job}/events HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        with Background(4, write), Background(4, read), Background(1, look):
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                time.sleep(seconds / 6)
                copy = scale.file(f"d9-{copies}")
                in_copy.set()
                done = subprocess.run([binary(), "backup", copy, "--database", database], capture_output=True)
                in_copy.clear()
                copies += 1
                sound_copies += done.returncode == 0 and FileDatabase(copy).sound()
        slow.close()
        locked = (scale.work / "d5.db.log").read_text().lower().count("locked")
    for number in range(copies):
        begin = time.monotonic()
        with service(scale.file(f"d9-{number}")) as restored:
            good = restored.request("GET", f"/v1/plans/{job}/result")[0] == 200
            restores.append((time.monotonic() - begin) if good else float("inf"))
    good = {status: count for status, count in statuses.items() if status in (200, 202)}
    errors = sum(statuses.values()) - sum(good.values())
    delay = percentile(copying, 0.99) - percentile(plain, 0.99) if copying else 0.0
    return [
        Row("D5", f"answers other than 200 and 202, of {sum(statuses.values())} in {seconds:.0f} s; 'locked' in the log: {locked}", str(errors), "0", errors == 0 and locked == 0),
        Row("D6", "largest write-ahead log", f"{max(wal) / 2**20:.1f} MB", "64 MB", max(wal) <= 64 * 2**20),
        Row("D9", f"copies that are sound, of {copies}", str(sound_copies), str(copies), sound_copies == copies > 0),
        Row("D9", "p99 of writes during copies minus before", f"{1e3 * delay:.0f} ms", "100 ms", delay <= 0.1, timed=True),
        Row("D9", "slowest start of a service on a copy, all results there", f"{max(restores):.2f} s", "30 s per GB", max(restores) <= 30.0),
    ]


@gate("D8")
def hang_ups_are_harmless(scale):
    """Clients that leave in the middle of their request."""
    database, count = scale.database("d8"), scale.of(10_000, 300)
    body = json.dumps(variant(0)).encode()
    request = b"POST /v1/plans HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: %d\r\n\r\n" % len(body) + body
    with service(database, "--queue-limit", "1000000") as running:

        def storm(index, number):
            with connect(running) as connection:
                cut = len(request) if number % 3 else (number * 37) % len(request)
                connection.sendall(request[:cut])

        begun = 0

        def some(index, number):
            nonlocal begun
            if begun < count:
                begun += 1
                try:
                    storm(index, number)
                except OSError:
                    pass
            else:
                time.sleep(0.01)

        with Background(8, some):
            while begun < count:
                time.sleep(0.05)
        fine = sum(running.request("POST", "/v1/plans", variant(0))[0] == 202 for _ in range(100))
        good = ready(running)
        log = running.told()
    return [Row("D8", f"requests that succeed after {count} hang-ups, of 100; readiness {good}", str(fine), "100", fine == 100 and good == 200 and "panic" not in log)]


@gate("D11", of_a_file="migrations of Postgres are transactions of the server: store tests of the schema")
def upgrades_survive_kills(scale):
    """Killed while the schema is brought up to date: old or new, never between."""
    old, rounds, unsound = scale.file("d11-old"), scale.of(50, 5), 0
    random_state = random.Random(11)
    first = sorted((ROOT / "migrations").glob("*.sql"))[0]
    versions = len(list((ROOT / "migrations").glob("*.sql")))
    template = FileDatabase(scale.file("d11-new"))
    with service(template) as running:
        job = running.submit(variant(0))
        running.wait_end(job)
    checksums = template.rows("SELECT * FROM _sqlx_migrations ORDER BY version LIMIT 1")
    connection = sqlite3.connect(old)
    connection.executescript(first.read_text())
    create = template.rows("SELECT sql FROM sqlite_master WHERE name = '_sqlx_migrations'")[0][0]
    connection.execute(create)
    connection.execute(f"INSERT INTO _sqlx_migrations VALUES ({','.join('?' * len(checksums[0]))})", checksums[0])
    connection.executemany(
        "INSERT INTO jobs (id, state, scenario, targets, submitted_us, finished_us) VALUES (?, 'failed', x'7b7d', 1, 1, 2)",
        [(f"old-{number}",) for number in range(20_000)],
    )
    connection.commit()
    connection.close()
    seen = set()
    for number in range(rounds):
        database = scale.work / f"d11-{number}.db"
        shutil.copy(old, database)
        process = subprocess.Popen([binary(), "serve", "--listen", "127.0.0.1:0", "--database", database], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(random_state.uniform(0.0, 0.12))
        process.kill()
        process.wait()
        # Looked at in a copy, so that nothing but the service repairs the original.
        for part in scale.work.glob(f"d11-{number}.db*"):
            shutil.copy(part, scale.work / part.name.replace("d11-", "d11-look-"))
        with sqlite3.connect(scale.work / f"d11-look-{number}.db") as look:
            seen.add(look.execute("SELECT count(*) FROM _sqlx_migrations WHERE success").fetchone()[0])
        try:
            with service(database) as running:
                fine = running.request("GET", "/v1/plans/old-7")[0] == 200
        except RuntimeError:
            fine = False
        unsound += not (fine and FileDatabase(database).sound())
        for part in scale.work.glob(f"d11-{number}.db*"):
            part.unlink()
    return [Row("D11", f"databases that did not open after a kill while upgrading, of {rounds} (schemas seen: {sorted(seen)} of {versions})", str(unsound), "0", unsound == 0)]


@gate("D10", of_a_file="checksums of pages are those of Postgres (initdb --data-checksums)")
def damage_is_noticed(scale):
    """A byte of the file flipped: the plan is as it was, or not served; nothing panics."""
    random_state = random.Random(10)
    original = scale.file("d10")
    with service(original) as running:
        jobs = [running.submit(variant(number)) for number in range(5)]
        for job in jobs:
            running.wait_end(job)
        plans = {job: running.request("GET", f"/v1/plans/{job}/result")[1] for job in jobs}
    wrong, panics, noticed, size = 0, 0, 0, original.stat().st_size
    rounds = scale.of(200, 6)
    for number in range(rounds):
        database = scale.work / f"d10-{number}.db"
        shutil.copy(original, database)
        with open(database, "r+b") as file:
            place = random_state.randrange(size)
            file.seek(place)
            byte = file.read(1)[0]
            file.seek(place)
            file.write(bytes([byte ^ (1 << random_state.randrange(8))]))
        try:
            with service(database) as running:
                for job, plan in plans.items():
                    status, answer = running.request("GET", f"/v1/plans/{job}/result")
                    wrong += status == 200 and answer != plan
                    noticed += status != 200
        except RuntimeError:
            noticed += 1
        log = (scale.work / f"d10-{number}.db.log").read_text()
        panics += "panic" in log
        for part in scale.work.glob(f"d10-{number}.db*"):
            part.unlink()
    return [Row("D10", f"wrong plans or panics after a flipped byte, of {rounds} ({noticed} noticed)", str(wrong + panics), "0", wrong + panics == 0)]
