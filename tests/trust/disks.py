"""Disks that fail and disks that are full, under a file of SQLite or under a Postgres."""

import errno
import mmap
import shutil
import struct
import subprocess
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Callable

from harness import HERE, Postgres
from systems import FileDatabase, ServerDatabase

DISK_MB = 32


def interposed(work, name):
    """One of the C sources here as a library that comes between a program and the system; built once."""
    library = work / f"{name}.so"
    if not library.exists():
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", library, HERE / f"{name}.c", "-ldl"], check=True)
    return library


class Faults:
    """Makes writes and syncs of files fail whose paths have a part."""

    FAULT = struct.Struct("iiii")

    def __init__(self, work, name, part):
        library = interposed(work, "shim")
        self.requests = work / f"{name}.faults"
        self.requests.write_bytes(bytes(2 * self.FAULT.size))
        # A Postgres that root starts runs as another user.
        self.requests.chmod(0o666)
        self.file = open(self.requests, "r+b")
        self.map = mmap.mmap(self.file.fileno(), 0)
        self.environment = {"LD_PRELOAD": str(library), "TRUST_SHIM": str(self.requests), "TRUST_MATCH": part}

    def fail(self, what, after, error, sticky=False):
        place = 0 if what == "write" else self.FAULT.size
        _, _, _, calls = self.FAULT.unpack_from(self.map, place)
        # The countdown last: the fault is complete when it begins to count.
        self.FAULT.pack_into(self.map, place, 0, error, int(sticky), calls)
        struct.pack_into("i", self.map, place, after)

    def clear(self):
        for place in (0, self.FAULT.size):
            struct.pack_into("i", self.map, place, 0)

    def pending(self, what):
        place = 0 if what == "write" else self.FAULT.size
        return struct.unpack_from("i", self.map, place)[0] > 0


@dataclass
class Failing:
    """A database whose disk fails on request; `environment` is for the processes on it."""

    database: object
    faults: Faults
    environment: dict | None = None

    @property
    def is_server(self):
        return isinstance(self.database, ServerDatabase)

    def fail_once(self, error):
        """The next write of a file fails; on a server the connections of all processes are ended."""
        if self.is_server:
            self.database.end_connections()
        else:
            self.faults.fail("write", 1, error)

    def serves(self):
        """Whether the server is there; a file always is."""
        return not self.is_server or self.database.server.answers()

    def restart(self):
        """Starts a server that did not recover by itself, as those do that watch over it."""
        self.database.server.restart()


@contextmanager
def failing(scale, name):
    """A new database on such a disk: of Postgres, the whole server has it."""
    if not scale.shared:
        faults = Faults(scale.work, name, f"{name}.db")
        yield Failing(scale.database(name), faults, faults.environment)
        return
    faults = Faults(scale.work, name, "/data/")
    with Postgres(environment=faults.environment) as server:
        yield Failing(ServerDatabase(server, scale.work / name), faults)


@dataclass
class SmallDisk:
    """A database on a disk that can be filled and freed."""

    database: object
    fill: Callable
    free: Callable
    environment: dict | None = None


@contextmanager
def small_disk(scale, name):
    """A new database on a small file system. Without the right to mount, writes to a file are refused as if
    it were full."""
    folder = scale.work / f"{name}-disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={DISK_MB}m", "tmpfs", folder]
    if subprocess.run(mount, capture_output=True).returncode != 0:
        if scale.shared:
            raise RuntimeError("a small file system cannot be mounted")
        faults = Faults(scale.work, name, f"{name}.db")
        refuse = lambda: faults.fail("write", 1, errno.ENOSPC, sticky=True)
        yield SmallDisk(scale.database(name), refuse, faults.clear, faults.environment)
        return

    def fill():
        with open(folder / "filler", "wb", buffering=0) as file:
            try:
                while True:
                    file.write(bytes(4096))
            except OSError:
                pass

    try:
        if scale.shared:
            # Tables and indexes are on it, the log of the server is not.
            space = f"small_{name}"
            shutil.chown(folder, user=scale.server().owner)
            scale.server().execute("postgres", f"CREATE TABLESPACE {space} LOCATION '{folder}'")
            database = ServerDatabase(scale.server(), scale.work / name, suffix=f"TABLESPACE {space}")
        else:
            database = FileDatabase(folder / f"{name}.db")
        yield SmallDisk(database, fill, (folder / "filler").unlink)
    finally:
        if scale.shared:
            database.removed()
            scale.server().execute("postgres", f"DROP TABLESPACE {space}")
        subprocess.run(["umount", folder], check=False)
