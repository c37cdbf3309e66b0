"""A client of the service in a container, and the end of one."""

import http.client
import json
import os
import signal
import socket
import time

from room import inside

# Services and workers promise to end in this time, s.
GRACE_S = 20


class Client:
    """Requests to the service on this machine."""

    def __init__(self, port, secret=None):
        self.port = port
        self.headers = {"Authorization": f"Bearer {secret}"} if secret else {}

    def ask(self, method, path, body=None, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        try:
            connection.request(method, path, body, {**self.headers, **headers})
            answer = connection.getresponse()
            return answer.status, json.loads(answer.read() or "null")
        finally:
            connection.close()


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def end(judge, started):
    """Ends the service as an engine does."""
    begin = time.monotonic()
    os.kill(inside(started), signal.SIGTERM)
    code = started.wait(2 * GRACE_S)
    took = time.monotonic() - begin
    judge.demand(f"SIGTERM ends it with code {code} after {took:.1f} s", code == 0 and took <= GRACE_S)
