"""A proxy between processes and a server of databases that cuts, delays and half-closes connections."""

import asyncio
import random
import threading

CHUNK = 65536


class Connection:
    """A connection that passes through: from its process to the server and back."""

    def __init__(self, streams):
        self.streams = streams
        # Both directions wait until here, s of the loop's clock.
        self.held_until = 0.0

    def cut(self):
        """Ends it for both at once, without a farewell."""
        for _, writer in self.streams:
            writer.transport.abort()

    def half_close(self, side):
        """Tells one side that nothing more comes; what it sends still passes."""
        _, writer = self.streams[side]
        if writer.can_write_eof() and not writer.transport.is_closing():
            writer.write_eof()

    async def pump(self, reader, writer):
        """Passes on what comes until its end."""
        loop = asyncio.get_running_loop()
        try:
            while data := await reader.read(CHUNK):
                while (wait := self.held_until - loop.time()) > 0:
                    await asyncio.sleep(wait)
                writer.write(data)
                await writer.drain()
            if writer.can_write_eof():
                writer.write_eof()
        except (OSError, RuntimeError):
            self.cut()

    async def pass_through(self):
        (process, to_process), (server, to_server) = self.streams
        try:
            await asyncio.gather(self.pump(process, to_server), self.pump(server, to_process))
        finally:
            self.cut()


class Proxy:
    """Listens for one process, so that its connections alone can be disturbed."""

    def __init__(self, socket, seed):
        self.socket, self.state = str(socket), random.Random(seed)
        self.connections, self.refusing = set(), False
        self.loop = asyncio.new_event_loop()
        self.thread = threading.Thread(target=self.loop.run_forever, daemon=True)

    def __enter__(self):
        self.thread.start()
        self.listener = self.run(asyncio.start_server(self.serve, "127.0.0.1", 0))
        self.port = self.listener.sockets[0].getsockname()[1]
        return self

    def __exit__(self, *_):
        self.listener.close()
        self.cut()
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join()

    def run(self, coroutine):
        return asyncio.run_coroutine_threadsafe(coroutine, self.loop).result(10.0)

    async def serve(self, reader, writer):
        if self.refusing:
            return writer.transport.abort()
        try:
            server = await asyncio.open_unix_connection(self.socket)
        except OSError:
            return writer.transport.abort()
        connection = Connection([(reader, writer), server])
        self.connections.add(connection)
        try:
            await connection.pass_through()
        finally:
            self.connections.discard(connection)

    def each(self, act, share=1.0):
        """Does something to a share of the connections."""

        async def acted():
            chosen = [one for one in list(self.connections) if self.state.random() < share]
            for one in chosen:
                act(one)
            return len(chosen)

        return self.run(acted())

    def cut(self, share=1.0):
        return self.each(Connection.cut, share)

    def half_close(self, share=1.0):
        """Closes one direction of each, whichever."""
        return self.each(lambda one: one.half_close(self.state.randrange(2)), share)

    def delay(self, seconds, share=1.0):
        """Holds back what passes in the next seconds."""

        def hold(one):
            one.held_until = self.loop.time() + seconds

        return self.each(hold, share)

    def refuse(self, refusing):
        """Whether new connections are refused, and those that are there are cut."""
        self.refusing = refusing
        if refusing:
            self.cut()
