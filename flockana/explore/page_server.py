"""Explorer's local web server: one page, one web socket per tab, one worker process per socket."""

import asyncio
import hmac
import json
import os
import secrets
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from flockana.base.errors import ArgumentError, FlockanaError
from flockana.base.interrupts import block_sigint
from flockana.ensemble.worker_processes import single_threaded_children
from flockana.explore.page import page
from flockana.explore.page_case import run_file
from flockana.explore.page_worker import work

HOST = "127.0.0.1"
_TABS = 6
_LENGTH = 32  # letters that a token has at least
_TRIES = 3  # processes in a row that end before they say anything: then only a new question starts one
_PATIENCE = (0.12, 1.0)  # seconds in which a process must begin the newest question: with, and without, a spare one
_QUESTION = 1_000_000  # bytes at most
_POLICY = "default-src 'none'; style-src 'unsafe-inline'; script-src 'nonce-{0}'; connect-src 'self'; img-src data:"


class Process:
    """Worker process of the explorer, whose messages are handed to the web server's thread."""

    def __init__(self, limit: float) -> None:
        context = get_context("spawn")
        self.pipe, worker_pipe = context.Pipe()
        self.process = context.Process(target=work, args=(worker_pipe, limit), daemon=True)
        with block_sigint(), single_threaded_children():
            self.process.start()
        worker_pipe.close()
        self.ready = False
        self.deliver: Callable[[Any], None] = lambda message: None
        loop = asyncio.get_running_loop()
        threading.Thread(target=self._read, args=(loop,), daemon=True).start()

    def _read(self, loop: asyncio.AbstractEventLoop) -> None:
        with suppress(RuntimeError):  # the server is gone
            with suppress(EOFError, OSError):
                while True:
                    loop.call_soon_threadsafe(self._forward, self.pipe.recv())
            loop.call_soon_threadsafe(self._forward, None)

    def _forward(self, message: Any) -> None:
        self.ready = True
        self.deliver(message)  # to the tab that owns the process now

    def end(self) -> None:
        """End the explorer's worker process at once."""
        self.deliver = lambda message: None
        self.process.kill()


@dataclass
class Server:
    """State of the explorer's web server, shared by all tabs."""

    token: str  # requests without it are refused
    first: dict[str, Any]  # the case that a page begins with
    limit: float
    tabs: set[Any] = field(default_factory=set)
    spare: Process | None = None

    def take(self) -> Process:
        """Return a worker process, ready if possible, and start a spare one."""
        spare_worker, self.spare = self.spare, None
        process = spare_worker if spare_worker is not None and spare_worker.process.is_alive() else Process(self.limit)
        asyncio.get_running_loop().call_later(2.0, self.prepare)
        return process

    def prepare(self) -> None:
        """Start a spare worker process."""
        if self.spare is None or not self.spare.process.is_alive():
            self.spare = Process(self.limit)

    def end(self) -> None:
        """End all worker processes of the explorer's web server."""
        for process in (self.spare, *(tab.process for tab in self.tabs)):
            if process is not None:
                process.end()

    def admitted(self, case: Any) -> Any:
        """Return a case; raise if it names a file other than the one that the explorer was started with."""
        if case.get("kind") == "file" and case != {**case, "kind": self.first["kind"], "name": self.first["name"]}:
            raise ArgumentError("expected the file that the explorer was started with")
        return case

    def admits(self, handler: RequestHandler) -> bool:
        """Return whether a request has the token and addresses this machine by its own name."""
        host = handler.request.host.rpartition(":")[0]
        token = handler.get_query_argument("token", "")
        return host in (HOST, "localhost") and hmac.compare_digest(token.encode(), self.token.encode())


class _Guarded(RequestHandler):
    def prepare(self) -> None:
        """Reject web requests without the explorer's token."""
        self.server: Server = self.application.settings["explorer"]
        if not self.server.admits(self):
            raise HTTPError(403)


class _Page(_Guarded):
    def get(self) -> None:
        """Answer a web request with the explorer's page."""
        nonce = secrets.token_urlsafe(16)
        self.set_header("Content-Security-Policy", _POLICY.format(nonce))
        self.set_header("Referrer-Policy", "no-referrer")
        self.set_header("Cache-Control", "no-store")
        self.finish(page(self.server.first, nonce))

    def write_error(self, status_code: int, **_: Any) -> None:
        """Write the error of a web request in one line."""
        error_text = "wrong or missing token: open the address that flockana explore printed"
        self.finish(error_text if status_code == 403 else f"{status_code}")


class _Run(_Guarded):
    async def get(self) -> None:
        """Simulate a case once more and send the run as netCDF."""
        try:
            case = self.server.admitted(json.loads(self.get_query_argument("case")))
            data = await asyncio.to_thread(run_file, case)
            self.set_header("Content-Type", "application/x-netcdf")
        except (ValueError, AttributeError, FlockanaError) as error:
            self.set_status(400)
            data = f"the run cannot be written: {error}".encode()
        self.finish(data)


class _Tab(_Guarded, WebSocketHandler):
    """Web socket of a browser tab, with its own worker process that answers the newest question."""

    process: Process | None = None
    number, begun, asked = 0, 0, None
    analysing, silent = False, 0

    def open(self, *_: Any) -> None:
        """Take a worker process for a newly opened page."""
        if len(self.server.tabs) >= _TABS:
            self.close(4000, f"{_TABS} tabs are open: close one")
            return
        self.server.tabs.add(self)
        self._take()

    def _take(self) -> Process:
        if self.process is not None:
            self.process.end()
        process, self.analysing = self.server.take(), False
        self.process, process.deliver = process, self.deliver
        return process

    def on_message(self, message: str | bytes) -> None:
        """Send a question of the page to the worker process."""
        try:
            request = json.loads(message)
            number, case = int(request["number"]), self.server.admitted(request["case"])
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            self._say({"number": -1, "kind": "error", "text": f"no question: {error}"})
            return
        if request.get("cancel"):
            self._take()
            self._say({"number": number, "kind": "cancelled"})
            return
        self.number, self.asked = number, case
        self._ask()
        if self.analysing:
            for seconds, is_immediate in zip(_PATIENCE, (True, False), strict=True):
                asyncio.get_running_loop().call_later(seconds, self._replace_if_unresponsive, number, is_immediate)

    def _ask(self) -> None:
        process = self.process or self._take()
        with suppress(OSError):  # it has ended; `deliver` hears of it
            process.pipe.send((self.number, self.asked))

    def _replace_if_unresponsive(self, number: int, at_once: bool) -> None:
        """Replace a worker process that ignores a newer question, once another is ready."""
        spare_worker = self.server.spare
        if at_once and not (spare_worker is not None and spare_worker.ready):
            return
        if self.begun < number == self.number and self.process is not None:
            self._take()
            self._ask()

    def deliver(self, message: Any) -> None:
        """Send a worker process's message to the page if it answers the newest question."""
        if message is None:
            text = "the process of this run ended: too little memory, or an error that the terminal shows"
            self._say({"number": self.number, "kind": "error", "text": text})
            self.silent += 1
            self.process = None
            if self.silent < _TRIES:
                self._take()
            return
        self.silent = 0
        number, kind, content = message
        self.begun = max(self.begun, number)
        if number != self.number:
            return
        self.analysing = kind not in ("begun", "form", "run", "done")
        self._say(
            number.to_bytes(4, "little") + content if kind == "run" else {"number": number, "kind": kind, **content}
        )

    def _say(self, data: dict[str, Any] | bytes) -> None:
        try:
            self.write_message(data, binary=isinstance(data, bytes))  # a dictionary becomes JSON
        except WebSocketClosedError:
            self.on_close()

    def on_close(self) -> None:
        """End the worker process of a closed page."""
        self.server.tabs.discard(self)
        if self.process is not None:
            self.process.end()
            self.process = None


def kept_token() -> str:
    """Return the user's stored token of the explorer, or a temporary one where nothing can be stored."""
    path = Path.home() / ".flockana" / "explore-token"
    try:
        path.parent.mkdir(mode=0o700, exist_ok=True)
        flags = os.O_CREAT | os.O_EXCL | os.O_WRONLY
        with suppress(FileExistsError), os.fdopen(os.open(path, flags, 0o600), "w") as token_file:
            token_file.write(secrets.token_urlsafe(32))
        token = path.read_text(encoding="ascii").strip()
    except (OSError, ValueError):
        token = ""
    return token if len(token) >= _LENGTH else secrets.token_urlsafe(32)


async def serve(server: Server, port: int, opened: Callable[[str], None]) -> None:
    """Run the explorer's web server until it is cancelled."""
    routes = [("/", _Page), ("/socket", _Tab), ("/run", _Run)]
    application = Application(routes, explorer=server, websocket_max_message_size=_QUESTION, websocket_ping_interval=20)
    http = HTTPServer(application)
    try:
        sockets = bind_sockets(port, HOST)
    except OSError as error:
        raise ArgumentError(f"--port {port}: {error.strerror}; give another, or 0 for any that is free") from None
    http.add_sockets(sockets)
    server.prepare()
    opened(f"http://{HOST}:{sockets[0].getsockname()[1]}/?token={server.token}")
    try:
        await asyncio.Event().wait()
    finally:
        http.stop()
        server.end()
