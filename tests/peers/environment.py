#!/usr/bin/env python3
"""The Python environment of the peers: CasADi with its solvers fatrop and IPOPT, from PyPI.

    $(python3 tests/peers/environment.py) tests/peers/general.py ...

Prints the interpreter of the environment, which is created first where it is not there. PEERS_VENV
names another place for it than the cache folder, or an environment that has the packages.
"""

import os
import subprocess
import sys
import venv
from pathlib import Path

PACKAGES = ["casadi==3.8.2", "numpy"]


def folder():
    named = os.environ.get("PEERS_VENV")
    cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(named or Path(cache, "slewplan", "peers-" + PACKAGES[0].replace("==", "-")))


def interpreter():
    """The interpreter with the packages."""
    place = folder()
    python = place / "bin" / "python"
    if not works(python):
        venv.create(place, with_pip=True)
        install = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run([*install, *PACKAGES], check=True, stdout=sys.stderr)
    return python


def works(python):
    """Whether it has the packages: an installation that was broken off is begun again."""
    command = [python, "-c", "import casadi, numpy"]
    return python.exists() and subprocess.run(command, stderr=subprocess.DEVNULL).returncode == 0


def enter():
    """Goes on in the environment: the running script begins again there, once.

    What needs the packages can be imported only after this.
    """
    python = interpreter()
    if Path(sys.prefix).resolve() != folder().resolve():
        os.execv(python, [python, *sys.argv])


if __name__ == "__main__":
    print(interpreter())
