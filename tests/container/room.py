"""Programs on the files of an image, confined as a container engine would: without an engine.

Namespaces of its own for mounts and processes, a root that is mounted read-only with /proc and the
devices that every engine gives, one writable volume, an unprivileged user without capabilities and
without a way to get any. What an engine adds, and this does not: a filter of system calls, cgroups, a
network of its own. Needs root.
"""

import os
import subprocess
from pathlib import Path

# $1 is the root, then come mounts of a source, a place and ro or rw until --, then the command.
# The root of the image is not this machine's, so its program is found only after chroot.
CONFINE = """
root=$1; shift
mount --bind "$root" "$root"
mount -t proc proc "$root/proc"
mount -t tmpfs -o nosuid,noexec,mode=755 dev "$root/dev"
for device in null zero full random urandom; do
    touch "$root/dev/$device"
    mount --bind "/dev/$device" "$root/dev/$device"
done
while [ "$1" != -- ]; do
    mount --bind "$1" "$root$2"
    case $3 in ro) mount -o remount,bind,ro "$root$2" ;; esac
    shift 3
done
shift
mount -o remount,bind,ro "$root"
exec setpriv --no-new-privs --bounding-set=-all,+sys_chroot,+setuid,+setgid \
    chroot --userspec="$ROOM_USER" --groups= "$root" "$@"
"""


class Room:
    """The root of an image with its settings."""

    def __init__(self, root, image):
        self.root = Path(root)
        self.image = image
        self.user = image["User"]
        self.settings = dict(setting.split("=", 1) for setting in image["Env"])

    def volume(self, folder):
        """A new volume for /data: as engines do, with the owner that the image gives it."""
        folder.mkdir()
        owner = (self.root / "data").stat()
        os.chown(folder, owner.st_uid, owner.st_gid)
        folder.chmod(owner.st_mode & 0o7777)
        return folder

    def command(self, arguments, mounts):
        """The command line for arguments of the program; mounts are (source, mount point, ro or rw)."""
        # Engines make mount points too.
        for place in ["/proc", "/dev", *(place for _, place, _ in mounts)]:
            (self.root / place.lstrip("/")).mkdir(exist_ok=True)
        places = [str(part) for mount in mounts for part in mount]
        separate = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-euc", CONFINE, "room"]
        return [*separate, str(self.root), *places, "--", *self.image["Entrypoint"], *arguments]

    def _environment(self, settings):
        # PATH and the user are for the commands that lead into the image.
        return {**self.settings, **settings, "PATH": os.environ["PATH"], "ROOM_USER": self.user}

    def run(self, arguments, mounts=(), given="", **settings):
        """Runs the program to its end, with a text on standard input."""
        command = self.command(arguments, list(mounts))
        environment = self._environment(settings)
        return subprocess.run(
            command, input=given, env=environment, capture_output=True, text=True, timeout=300, check=False
        )

    def start(self, arguments, mounts, log, **settings):
        """Starts the program; standard error goes to the log."""
        command = self.command(arguments, list(mounts))
        return subprocess.Popen(
            command, env=self._environment(settings), stdout=subprocess.PIPE, stderr=log, text=True
        )


def inside(started):
    """The process within: the only child of the one that made its namespaces."""
    children = Path(f"/proc/{started.pid}/task/{started.pid}/children").read_text()
    return int(children.split()[0])


def status(process):
    """What Linux tells about a process."""
    lines = Path(f"/proc/{process}/status").read_text().splitlines()
    return {name: value.strip() for name, _, value in (line.partition(":") for line in lines)}


def files(folder):
    """All files below a folder with their sizes."""
    found = {}
    for place, _, names in os.walk(folder):
        for name in names:
            path = Path(place, name)
            found[str(path.relative_to(folder))] = path.lstat().st_size
    return found
