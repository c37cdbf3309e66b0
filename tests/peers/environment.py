#!/usr/bin/env python3
"""Python environments for scripts: packages from PyPI, in a folder of the cache.

    $(python3 tests/peers/environment.py) tests/peers/general.py ...

Prints the interpreter of the peers' environment (CasADi with its solvers fatrop and IPOPT), which
is created first where it is not there. PEERS_VENV names another place for it than the cache folder,
or an environment that has the packages.
"""

import os
import subprocess
import sys
import venv
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Environment:
    """Packages under a name, the modules that show that they are there, the variable for another place."""

    name: str
    packages: tuple
    modules: tuple
    variable: str

    def folder(self):
        named = os.environ.get(self.variable)
        cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
        version = self.packages[0].replace("==", "-")
        return Path(named or Path(cache, "slewplan", f"{self.name}-{version}"))

    def interpreter(self):
        """The interpreter with the packages."""
        place = self.folder()
        python = place / "bin" / "python"
        if not self.works(python):
            venv.create(place, with_pip=True)
            install = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
            subprocess.run([*install, *self.packages], check=True, stdout=sys.stderr)
        return python

    def works(self, python):
        """Whether it has the packages: an installation that was broken off is begun again."""
        command = [python, "-c", f"import {', '.join(self.modules)}"]
        return python.exists() and subprocess.run(command, stderr=subprocess.DEVNULL).returncode == 0

    def enter(self):
        """Goes on in the environment: the running script begins again there, once.

        What needs the packages can be imported only after this.
        """
        python = self.interpreter()
        if Path(sys.prefix).resolve() != self.folder().resolve():
            os.execv(python, [python, *sys.argv])


PEERS = Environment("peers", ("casadi==3.8.2", "numpy"), ("casadi", "numpy"), "PEERS_VENV")
ROUTING = Environment("routing", ("ortools==9.15.6755",), ("ortools",), "ROUTING_VENV")


def interpreter():
    """The interpreter with the packages of the peers."""
    return PEERS.interpreter()


def enter():
    """Goes on in the environment of the peers."""
    PEERS.enter()


if __name__ == "__main__":
    print(interpreter())
