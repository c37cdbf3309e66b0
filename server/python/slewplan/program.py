"""The program that is installed with this module."""

from __future__ import annotations

import json
import shutil
import subprocess
import sysconfig
import tempfile
from pathlib import Path
from typing import cast

from .client import Plan, Scenario

# Exit codes with which `solve` prints a plan: complete, infeasible with the reasons, stopped.
WITH_PLAN = (0, 3, 4)


class Failed(Exception):
    """The program ended without an answer; the text is what it said."""

    def __init__(self, code: int, said: str) -> None:
        self.code = code
        super().__init__(said.strip() or f"slewplan ended with code {code}")


def program() -> str:
    """Path of the program: beside the interpreter first, since a notebook may have another PATH."""
    schemes = [sysconfig.get_default_scheme(), sysconfig.get_preferred_scheme("user")]
    for scheme in schemes:
        path = Path(sysconfig.get_path("scripts", scheme), "slewplan")
        if path.is_file():
            return str(path)
    found = shutil.which("slewplan")
    if found is None:
        raise FileNotFoundError("the program slewplan is not installed")
    return found


def run(*arguments: str | Path, text: str | None = None) -> str:
    """What the program prints, with this text as its standard input; `Failed` where it refuses."""
    return _run(arguments, text, (0,))


def solve(scenario: Scenario, *arguments: str) -> Plan:
    """The plan of a scenario, as far as it came within the time limit; its `status` says how far."""
    command = ("solve", "-", "--format", "json", "--progress", "none", *arguments)
    return cast(Plan, json.loads(_run(command, json.dumps(scenario), WITH_PLAN)))


def plot(plan: Plan, scenario: Scenario, *arguments: str) -> str:
    """The drawing of a plan as SVG, with the limits and boresights of its scenario."""
    with tempfile.NamedTemporaryFile("w", suffix=".json", encoding="utf-8") as file:
        json.dump(scenario, file)
        file.flush()
        return run("plot", "-", "--scenario", file.name, *arguments, text=json.dumps(plan))


def _run(arguments: tuple[str | Path, ...], text: str | None, answers: tuple[int, ...]) -> str:
    command = [program(), *map(str, arguments)]
    ended = subprocess.run(command, input=text or "", capture_output=True, encoding="utf-8")
    if ended.returncode not in answers or (ended.returncode != 0 and not ended.stdout):
        raise Failed(ended.returncode, ended.stderr)
    return ended.stdout
