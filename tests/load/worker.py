"""`slewplan work` as a child process."""

import os

from service import Endpoint, Process


class Worker(Process, Endpoint):
    """A worker with one thread, unless something else is said; it answers where its metrics are."""

    def __init__(self, database, *arguments, log=os.devnull, environment=None):
        arguments = ["--metrics", "127.0.0.1:0", "--database", database, *arguments]
        if "--threads" not in arguments:
            arguments += ["--threads", "1"]
        super().__init__("work", arguments, log, "working on postgres://", environment)
        metrics = self.process.stdout.readline().strip()
        self.host, port = metrics.removeprefix("metrics on http://").rsplit(":", 1)
        self.port = int(port)
