"""Names of hosts, as engines give them to containers: a server of names at an address of its own."""

import socket
import socketserver
import struct
import threading

# Where Docker has its own, and /etc/resolv.conf of every container points to.
ADDRESS = "127.0.0.11"
HEAD = struct.Struct(">HHHHHH")
TYPE_A, CLASS_IN = 1, 1
ANSWER, NO_SUCH_NAME = 0x8180, 0x8183


def question(message):
    """The name that is asked for, its type, and the question as it stands."""
    labels, place = [], HEAD.size
    while length := message[place]:
        labels.append(message[place + 1 : place + 1 + length].decode())
        place += 1 + length
    [kind] = struct.unpack_from(">H", message, place + 1)
    return ".".join(labels), kind, message[HEAD.size : place + 5]


class Handler(socketserver.BaseRequestHandler):
    """One question."""

    def handle(self):
        message, connection = self.request
        name, kind, asked = question(message)
        known, found = name in self.server.known, b""
        if known and kind == TYPE_A:
            # The name as in the question; for one minute.
            found = struct.pack(">HHHIH4s", 0xC00C, TYPE_A, CLASS_IN, 60, 4, socket.inet_aton("127.0.0.1"))
        [number] = struct.unpack_from(">H", message)
        head = HEAD.pack(number, ANSWER if known else NO_SUCH_NAME, 1, bool(found), 0, 0)
        connection.sendto(head + asked + found, self.client_address)


class Names(socketserver.ThreadingUDPServer):
    """Answers that some names are this machine, and that there are no others."""

    def __init__(self, folder, *names):
        super().__init__((ADDRESS, 53), Handler)
        self.known = set(names)
        # What engines put there.
        (folder / "resolv.conf").write_text(f"nameserver {ADDRESS}\noptions ndots:0\n")
        (folder / "hosts").write_text("127.0.0.1 localhost\n")

    def __enter__(self):
        threading.Thread(target=self.serve_forever, daemon=True).start()
        return self

    def __exit__(self, *_):
        self.shutdown()
        self.server_close()
