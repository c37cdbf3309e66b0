"""What the scripts with foreign readers share: plans, exports and quaternions."""

import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "peers"))
from environment import Environment  # noqa: E402
from slewplan import FIXTURES, PLANNED, binary  # noqa: E402

__all__ = ["Environment", "Files", "Judge", "FIXTURES", "binary"]


@dataclass
class Files:
    """A scenario, its plan, and the plan in other formats, in a folder that goes away."""

    program: str
    scenario: Path
    folder: tempfile.TemporaryDirectory

    @classmethod
    def of(cls, program, fixture, changes=None):
        """Of a committed scenario, some members of which are replaced."""
        files = cls(program, FIXTURES / f"{fixture}.json", tempfile.TemporaryDirectory())
        if changes:
            changed = files.model() | changes
            files.scenario = files.path("scenario.json")
            files.scenario.write_text(json.dumps(changed), encoding="utf-8")
        ran = files._run("solve", files.scenario, "-o", files.path("plan.json"), "--progress", "none")
        if ran not in PLANNED:
            sys.exit(f"slewplan solve {fixture} ended with code {ran}")
        return files

    def path(self, name):
        return Path(self.folder.name, name)

    def _run(self, *arguments):
        return subprocess.run([self.program, *arguments], stdout=subprocess.DEVNULL, check=False).returncode

    def export(self, form, *choices):
        """The path of an export."""
        path = self.path("".join([form, *choices]))
        line = [self.scenario, self.path("plan.json"), "--format", form, "-o", path, *choices]
        code = self._run("export", *line)
        if code != 0:
            sys.exit(f"slewplan export --format {form} ended with code {code}")
        return path

    def model(self):
        return json.loads(self.scenario.read_text(encoding="utf-8"))

    def plan(self):
        return json.loads(self.path("plan.json").read_text(encoding="utf-8"))

    def table(self, *choices):
        """The CSV: time, quaternion x y z w, rates rad/s, then wheel speeds and torques."""
        import numpy as np

        return np.loadtxt(self.export("csv", *choices), delimiter=",", skiprows=1)


class Judge:
    """Prints a table of what was found beside what is allowed, and remembers what failed."""

    def __init__(self):
        self.failed = []

    def compare(self, what, found, allowed, unit):
        passed = found <= allowed
        print(f"{'ok  ' if passed else 'FAIL'} {what}: {found:.2e} {unit} (allowed {allowed:g})", flush=True)
        if not passed:
            self.failed.append(what)

    def demand(self, what, is_so):
        print(f"{'ok  ' if is_so else 'FAIL'} {what}", flush=True)
        if not is_so:
            self.failed.append(what)

    def end(self):
        sys.exit(f"{len(self.failed)} failed: {'; '.join(self.failed)}" if self.failed else 0)
