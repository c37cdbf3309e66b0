"""What a loss of power leaves: the disk rebuilt as it could be at a moment, from a record of what it was
asked to do."""

import random
import sqlite3
import struct
import threading
from dataclasses import dataclass

from disks import interposed
from harness import Row, gate, service, variant

RECORD = struct.Struct("=IIQQ")
WRITE, TRUNCATE, SYNC = 1, 2, 3
SECTOR = 512
CLIENTS = 4


class Recorder:
    """Records what a service asks of the disk for its database."""

    def __init__(self, work, database):
        library = interposed(work, "recorder")
        self.log = work / f"{database.name}.record"
        self.log.touch()
        self.environment = {
            "LD_PRELOAD": str(library),
            "RECORDER_DATABASE": str(database),
            "RECORDER_LOG": str(self.log),
        }

    def position(self):
        """Where the record ends now: what is before has happened."""
        return self.log.stat().st_size


@dataclass
class Request:
    """A write, or without data a truncation to the offset."""

    offset: int
    data: bytes | None

    def reach(self, content):
        if self.data is None:
            del content[self.offset :]
            content.extend(bytes(self.offset - len(content)))
            return
        end = self.offset + len(self.data)
        if len(content) < end:
            content.extend(bytes(end - len(content)))
        content[self.offset : end] = self.data

    def sectors(self):
        """The parts that reach the disk each by itself."""
        if self.data is None:
            return [self]
        begins = [self.offset, *range(self.offset - self.offset % SECTOR + SECTOR, self.offset + len(self.data), SECTOR)]
        ends = [*begins[1:], self.offset + len(self.data)]
        return [Request(begin, self.data[begin - self.offset : end - self.offset]) for begin, end in zip(begins, ends)]


class Disk:
    """A database and its log: what is safe, and what was asked for since the last sync."""

    def __init__(self, database, heeds_syncs=True):
        self.safe = [bytearray(database), bytearray()]
        self.unsafe = [[], []]
        self.heeds_syncs = heeds_syncs

    def take(self, kind, file, request):
        if kind != SYNC:
            self.unsafe[file].append(request)
        elif self.heeds_syncs:
            for one in self.unsafe[file]:
                one.reach(self.safe[file])
            self.unsafe[file].clear()

    def after_loss(self, state):
        """Both files as they may be found: of what is not safe nothing, all, or any part."""
        share = state.choice((0.0, 1.0, state.random()))
        found = []
        for safe, unsafe in zip(self.safe, self.unsafe):
            content = bytearray(safe)
            for part in (part for one in unsafe for part in one.sectors()):
                if state.random() < share:
                    part.reach(content)
            found.append(content)
        return found


def requests(record):
    """Every record: where it ends, its kind, the file and what was asked for. Of one that was cut off by
    the kill nothing."""
    place = 0
    while place + RECORD.size <= len(record):
        kind, file, offset, length = RECORD.unpack_from(record, place)
        begin = place + RECORD.size
        data = record[begin : begin + length] if kind == WRITE else None
        place = begin + (length if kind == WRITE else 0)
        if place <= len(record):
            yield place, kind, file, Request(length if kind == TRUNCATE else offset, data)


def losses(disk, record, points, state):
    """What is found after a loss of power at each of some ascending positions in the record."""
    asked, place = requests(record), 0
    for point in points:
        while place < point:
            place, kind, file, request = next(asked)
            disk.take(kind, file, request)
        yield point, disk.after_loss(state)


def put(folder, content):
    """A database of what was found."""
    path = folder / "image.db"
    for part in folder.glob("image.db*"):
        part.unlink()
    for name, bytes_found in zip(("image.db", "image.db-wal"), content):
        (folder / name).write_bytes(bytes_found)
    return path


def jobs_in(path):
    """The jobs of a database; `None` when it is not sound."""
    try:
        connection = sqlite3.connect(path)
        try:
            if connection.execute("PRAGMA integrity_check").fetchall() != [("ok",)]:
                return None
            return {identifier for (identifier,) in connection.execute("SELECT id FROM jobs")}
        finally:
            connection.close()
    except sqlite3.DatabaseError:
        return None


def serves(path, job):
    """Whether a service starts on a database and has a job."""
    try:
        with service(path) as running:
            return running.request("GET", f"/v1/plans/{job}")[0] == 200
    except RuntimeError:
        return False


def recorded(scale):
    """A service under submissions from its start to its kill: the database before, the record, and where
    the record ended when each job had been acknowledged."""
    database = scale.file("d4")
    with service(database):
        pass
    before, recorder = database.read_bytes(), Recorder(scale.work, database)
    acknowledged, guard = [], threading.Lock()
    with service(database, "--queue-limit", "100000", environment=recorder.environment) as running:

        def submit(client):
            for number in range(scale.of(150, 60)):
                scenario = variant(number % 20)
                # Long enough that the log is folded into the database now and then.
                scenario["name"] = f"{client}-{number}-" + "x" * 8000
                job = running.submit(scenario)
                at = recorder.position()
                with guard:
                    acknowledged.append((at, job))

        threads = [threading.Thread(target=submit, args=(client,)) for client in range(CLIENTS)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        running.kill()
    return before, recorder.log.read_bytes(), sorted(acknowledged)


@gate("D4", of_a_file="the log of a server is that of Postgres, with synchronous_commit on")
def acknowledged_jobs_survive_a_loss_of_power(scale):
    """The disk as it may be found, of losses at any time and of losses right after an answer."""
    before, record, acknowledged = recorded(scale)
    state, folder = random.Random(4), scale.work / "images"
    folder.mkdir()
    ends = [end for end, *_ in requests(record) if end >= acknowledged[0][0]]
    syncs = [0, 0]
    for _, kind, file, _ in requests(record):
        syncs[file] += kind == SYNC

    def points(count):
        return sorted(state.choice(ends) if number % 2 else state.choice(acknowledged)[0] for number in range(count))

    count, unsound, lost, starts, refused = scale.of(1000, 60), 0, 0, 0, 0
    for number, (point, found) in enumerate(losses(Disk(before), record, points(count), state)):
        promised = [job for at, job in acknowledged if at <= point]
        jobs = jobs_in(put(folder, found))
        unsound += jobs is None
        lost += len(set(promised) - (jobs or set()))
        if number % 50 == 0:
            starts += 1
            refused += not serves(put(folder, found), promised[-1])
    # A disk that heeds no syncs is what a service without them has: it must be found out.
    blind, noticed = scale.of(100, 20), 0
    for point, found in losses(Disk(before, heeds_syncs=False), record, points(blind), state):
        jobs = jobs_in(put(folder, found))
        noticed += jobs is None or any(at <= point and job not in jobs for at, job in acknowledged)
    folded, committed = syncs
    return [
        Row("D4", f"damaged databases after a loss of power, of {count}", str(unsound), "0", unsound == 0),
        Row("D4", f"acknowledged jobs lost, of {len(acknowledged)}", str(lost), "0", lost == 0),
        Row("D4", f"starts of a service that failed, of {starts}", str(refused), "0", refused == 0),
        Row("D4", f"losses noticed on a disk that heeds no sync, of {blind}", str(noticed), "some", noticed > 0),
        Row("D4", "syncs of the log, and of the database when the log was folded", f"{committed}, {folded}", "-", None),
    ]
