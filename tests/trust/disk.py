"""Promises about the database: full disks, failing disks, locks, copies."""

import errno
import os
import shutil
import subprocess
import threading
import time

from harness import (
    ROOT,
    Background,
    Faults,
    Row,
    binary,
    connect,
    elsewhere,
    fixture,
    gate,
    percentile,
    rows_of,
    service,
    sound,
    timed,
    variant,
)

elsewhere("D1", "SQLite is at least 3.51.3, or neither build nor start", "3.51.3", "const assertion and check at start in store.rs")


def ready(running):
    return running.request("GET", "/health/ready")[0]


def until(condition, patience):
    """Seconds until a condition holds; `None` when it does not in time."""
    begin = time.monotonic()
    while time.monotonic() - begin < patience:
        if condition():
            return time.monotonic() - begin
        time.sleep(0.02)
    return None


@gate("D2")
def a_full_disk_is_survived(scale):
    """A file system of 32 MB, filled and freed again and again under the running service."""
    folder = scale.work / "small-disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=32m", "tmpfs", folder]
    mounted = subprocess.run(mount, capture_output=True).returncode == 0
    database = folder / "d2.db"
    # Without the right to mount: every write is refused as if the disk were full.
    faults = None if mounted else Faults(scale.work, database)

    def fill():
        if faults:
            return faults.fail("write", 1, errno.ENOSPC, sticky=True)
        with open(folder / "filler", "wb", buffering=0) as file:
            try:
                while True:
                    file.write(bytes(4096))
            except OSError:
                pass

    def free():
        faults.clear() if faults else (folder / "filler").unlink()

    rounds, statuses, slowest, reads, recoveries = scale.of(20, 3), {}, 0.0, set(), []
    unnamed = 0
    try:
        with service(database, environment=faults.environment if faults else None) as running:
            known = running.submit(variant(0))
            running.wait_end(known)
            process = running.process.pid
            for number in range(rounds):
                fill()
                # What the write-ahead log has room for still passes.
                big = variant(number + 1)
                big["name"] = "x" * 200_000
                for _ in range(40):
                    took, (status, answer) = timed(lambda: running.request("POST", "/v1/plans", big))
                    slowest = max(slowest, took)
                    if status != 202:
                        statuses[status] = statuses.get(status, 0) + 1
                        unnamed += status == 507 and answer["code"] != "disk_full"
                        break
                reads.add(running.request("GET", f"/v1/plans/{known}/result")[0])
                reads.add(running.request("GET", "/health/live")[0])
                free()
                recoveries.append(until(lambda: running.request("POST", "/v1/plans", variant(0))[0] == 202, 10.0))
                for job in running.request("GET", "/v1/plans?limit=100")[1]["plans"]:
                    if job["id"] != known:
                        running.request("DELETE", f"/v1/plans/{job['id']}")
            alive = running.process.poll() is None and running.process.pid == process
            log = (folder / "d2.db.log").read_text()
        intact = sound(database)
    finally:
        if mounted:
            subprocess.run(["umount", folder], check=False)
    recovered = [wait for wait in recoveries if wait is not None]
    worst = max(recovered, default=float("inf"))
    return [
        Row("D2", f"refusals while full, of {rounds}: status {statuses}", str(sum(statuses.values())), f"{rounds} x 507/503", set(statuses) <= {503, 507} and sum(statuses.values()) == rounds and unnamed == 0),
        Row("D2", "slowest answer to a write while full", f"{1e3 * slowest:.0f} ms", "1000 ms", slowest <= 1.0, timed=True),
        Row("D2", f"reads while full: statuses {sorted(reads)}", str(len(reads)), "only 200", reads == {200}),
        Row("D2", f"writes again after room was made, {len(recovered)} of {rounds}, slowest", f"{worst:.2f} s", "5 s", len(recovered) == rounds and worst <= 5.0 and alive and intact),
        Row("D2", "panics", str(log.count("panic")), "0", "panic" not in log),
    ]


@gate("D3")
def errors_of_the_disk_stop_or_pass(scale):
    """The n-th write or sync fails: writes are refused cleanly, a failed sync ends the process."""
    database = scale.database("d3")
    faults = Faults(scale.work, database)
    acknowledged, wrong, late, unsound = [], [], [], 0
    last = scale.of(300, 12)

    def submit(running, number):
        status, job = running.request("POST", "/v1/plans", variant(number % 20))
        if status == 202:
            acknowledged.append(job["id"])
        return status

    running = service(database, "--queue-limit", "100000", environment=faults.environment)
    exits = 0
    for number in range(1, last + 1):
        what = "sync" if number % 2 else "write"
        faults.fail(what, 1 + number // 2 % 30, errno.EIO)
        begin = time.monotonic()
        while faults.pending(what) and time.monotonic() - begin < 5.0:
            try:
                if submit(running, number) not in (202, 500, 503, 507):
                    wrong.append(number)
            except OSError:
                break
        faults.clear()
        if what == "sync":
            begin = time.monotonic()
            code = None
            try:
                code = running.process.wait(2.0)
            except subprocess.TimeoutExpired:
                pass
            if code is not None:
                exits += 1
                late.append(time.monotonic() - begin)
                wrong += [number] if code == 0 else []
                running.__exit__()
                unsound += not sound(database)
                running = service(database, "--queue-limit", "100000", environment=faults.environment)
        elif until(lambda: submit(running, number) == 202, 1.0) is None:
            wrong.append(number)
    running.__exit__()
    stored = {identifier for (identifier,) in rows_of(database, "SELECT id FROM jobs")}
    lost = sum(identifier not in stored for identifier in acknowledged)
    syncs = (last + 1) // 2
    return [
        Row("D3", f"exits after a failed sync, of {syncs} (the rest: the service survived)", str(exits), str(syncs), exits == syncs),
        Row("D3", "slowest exit", f"{max(late, default=0.0):.2f} s", "2 s", max(late, default=9.0) <= 2.0, timed=True),
        Row("D3", "failed writes after which the next was not taken within 1 s, wrong codes", str(len(wrong)), "0", not wrong),
        Row("D3", f"acknowledged jobs lost, of {len(acknowledged)}", str(lost), "0", lost == 0 and bool(acknowledged)),
        Row("D3", "restarts with a damaged database", str(unsound), "0", unsound == 0),
    ]


@gate("D7")
def the_writer_heals(scale):
    """Single failures of writes: the next write succeeds."""
    database = scale.database("d7")
    faults = Faults(scale.work, database)
    rounds, healed = scale.of(100, 10), 0
    with service(database, "--queue-limit", "100000", environment=faults.environment) as running:
        for number in range(rounds):
            faults.fail("write", 1, errno.ENOSPC if number % 2 else errno.EIO)
            running.request("POST", "/v1/plans", variant(0))
            faults.clear()
            wait = until(lambda: running.request("POST", "/v1/plans", variant(0))[0] == 202, 1.0)
            healed += wait is not None and ready(running) == 200
    return [Row("D7", f"writes and readiness within 1 s of a failure, of {rounds}", str(healed), str(rounds), healed == rounds)]


@gate("D5")
def nobody_sees_a_locked_database(scale):
    """Writes, reads, copies and checkpoints together; D6 and D9 are measured on the way."""
    database, seconds = scale.database("d5"), scale.of(300.0, 6.0)
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
                copy = scale.work / f"d9-{copies}.db"
                in_copy.set()
                done = subprocess.run([binary(), "backup", copy, "--database", database], capture_output=True)
                in_copy.clear()
                copies += 1
                sound_copies += done.returncode == 0 and sound(copy)
        slow.close()
        locked = (scale.work / "d5.db.log").read_text().lower().count("locked")
    for number in range(copies):
        begin = time.monotonic()
        with service(scale.work / f"d9-{number}.db") as restored:
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
    import json

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
    log = (scale.work / "d8.db.log").read_text()
    return [Row("D8", f"requests that succeed after {count} hang-ups, of 100; readiness {good}", str(fine), "100", fine == 100 and good == 200 and "panic" not in log)]


@gate("D11")
def upgrades_survive_kills(scale):
    """Killed while the schema is brought up to date: old or new, never between."""
    old, rounds, unsound = scale.database("d11-old"), scale.of(50, 5), 0
    import random
    import sqlite3

    random_state = random.Random(11)
    first = sorted((ROOT / "migrations").glob("*.sql"))[0]
    versions = len(list((ROOT / "migrations").glob("*.sql")))
    with service(scale.database("d11-new")) as running:
        job = running.submit(variant(0))
        running.wait_end(job)
    template = scale.database("d11-new")
    checksums = rows_of(template, "SELECT * FROM _sqlx_migrations ORDER BY version LIMIT 1")
    connection = sqlite3.connect(old)
    connection.executescript(first.read_text())
    create = rows_of(template, "SELECT sql FROM sqlite_master WHERE name = '_sqlx_migrations'")[0][0]
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
        unsound += not (fine and sound(database))
        for part in scale.work.glob(f"d11-{number}.db*"):
            part.unlink()
    return [Row("D11", f"databases that did not open after a kill while upgrading, of {rounds} (schemas seen: {sorted(seen)} of {versions})", str(unsound), "0", unsound == 0)]


@gate("D10")
def damage_is_noticed(scale):
    """A byte of the file flipped: the plan is as it was, or not served; nothing panics."""
    import random

    random_state = random.Random(10)
    original = scale.database("d10")
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
