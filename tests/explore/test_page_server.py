import asyncio
import json
import socket
import stat

import pytest

from flockana.base.errors import ArgumentError
from flockana.explore import page_server as module
from flockana.explore.page_server import HOST, Server, kept_token, serve

tornado = pytest.importorskip("tornado.httpclient", reason="tornado is not installed: flockana[explore]")
websocket = pytest.importorskip("tornado.websocket")

TOKEN = "a" * 43
FIRST = {"kind": "scenario", "name": "hexagon"}


class Echo:
    """A process that answers at once with what it was asked, or when told to not at all."""

    made: list = []  # noqa: RUF012  # emptied by the fixture
    quick = True

    def __init__(self, limit):
        self.pipe, self.process, self.asked, self.ended = self, self, [], False
        self.deliver, self.deaf, self.ready = lambda message: None, False, Echo.quick
        Echo.made.append(self)

    def send(self, question):
        self.asked.append(question)
        number, case = question
        if not self.deaf:
            asyncio.get_running_loop().call_soon(self.say, number, case)

    def say(self, number, case):
        self.deliver((number, "begun", {}))
        self.deliver((number, "run", b"FLK1"))
        self.deliver((number, "ran", {"case": case}))

    def is_alive(self):
        return not self.ended

    def end(self):
        self.ended, self.deliver = True, lambda message: None


@pytest.fixture
def served(monkeypatch):
    """Call a coroutine with the address of a server whose processes echo."""
    monkeypatch.setattr(module, "Process", Echo)
    monkeypatch.setattr(module, "_PATIENCE", (0.05, 0.3))
    Echo.made = []

    def call(use, first=FIRST):
        async def both():
            address = asyncio.get_running_loop().create_future()
            task = asyncio.create_task(serve(Server(TOKEN, first, 60.0), 0, address.set_result))
            try:
                return await use(await address)
            finally:
                task.cancel()
                await asyncio.gather(task, return_exceptions=True)

        return asyncio.run(asyncio.wait_for(both(), 20.0))

    return call


async def got(url, **options):
    return await tornado.AsyncHTTPClient().fetch(url, raise_error=False, **options)


async def opened(url):
    return await websocket.websocket_connect(url.replace("http:", "ws:").replace("/?", "/socket?"))


async def answer(tab, number, case):
    """(frames, what the echo says) of a question."""
    await tab.write_message(json.dumps({"number": number, "case": case}))
    begun, frames, ran = [await tab.read_message() for _ in range(3)]
    assert json.loads(begun)["kind"] == "begun"
    assert frames == number.to_bytes(4, "little") + b"FLK1"
    assert json.loads(ran)["number"] == number
    return json.loads(ran)["case"]


def test_the_page_is_given_to_who_knows_the_token_alone(served):
    async def use(url):
        bare = url.split("?")[0]
        assert url.startswith(f"http://{HOST}:")
        for wrong in (bare, f"{bare}?token=", f"{bare}?token={TOKEN[:-1]}b", f"{bare}?token=%C3%A9", f"{bare}socket"):
            reply = await got(wrong)
            assert reply.code == 403
            assert b"<script" not in reply.body
        foreign = await got(url, headers={"Host": "attacker.example"})
        assert foreign.code == 403
        return await got(url)

    page = served(use)
    assert page.code == 200
    assert "script-src 'nonce-" in page.headers["Content-Security-Policy"]
    assert page.headers["Referrer-Policy"] == "no-referrer"
    text = page.body.decode()
    assert TOKEN not in text
    assert '"first": {"kind": "scenario", "name": "hexagon"}' in text
    assert not any(word in text for word in ("/*SCRIPT*/", "/*STYLE*/", "/*DATA*/", "NONCE"))


def test_a_socket_needs_the_token_and_the_pages_own_origin(served):
    async def use(url):
        for wrong in (url.replace(TOKEN, "b" * 43), url.split("?")[0] + "?"):
            with pytest.raises(tornado.HTTPClientError, match="403"):
                await opened(wrong)
        request = tornado.HTTPRequest(
            url.replace("http:", "ws:").replace("/?", "/socket?"), headers={"Origin": "http://attacker.example"}
        )
        with pytest.raises(tornado.HTTPClientError, match="403"):
            await websocket.websocket_connect(request)

    served(use)
    assert sum(len(each.asked) for each in Echo.made) == 0


def test_two_tabs_have_processes_of_their_own(served):
    async def use(url):
        one, two = await opened(url), await opened(url)
        assert await answer(one, 1, {"kind": "law", "name": "a"}) == {"kind": "law", "name": "a"}
        assert await answer(two, 1, {"kind": "law", "name": "b"}) == {"kind": "law", "name": "b"}
        assert await answer(one, 2, {"kind": "law", "name": "c"}) == {"kind": "law", "name": "c"}
        asked = [[case["name"] for _, case in each.asked] for each in Echo.made if each.asked]
        assert sorted(asked) == [["a", "c"], ["b"]]
        two.close()
        await asyncio.sleep(0.1)
        assert [each.ended for each in Echo.made if each.asked] == [False, True]
        assert await answer(one, 3, {"kind": "law", "name": "d"}) == {"kind": "law", "name": "d"}

    served(use)
    assert all(each.ended for each in Echo.made)


@pytest.mark.parametrize("quick", [True, False])
def test_the_newest_alone_is_answered_and_a_deaf_process_replaced(served, monkeypatch, quick):
    monkeypatch.setattr(Echo, "quick", quick)

    async def use(url):
        tab = await opened(url)
        await answer(tab, 1, FIRST)
        (busy,) = (each for each in Echo.made if each.asked)
        busy.deliver((0, "ran", {"of": "an older question"}))
        assert await answer(tab, 1, FIRST) == FIRST  # with nothing before it
        busy.deaf = True
        await tab.write_message(json.dumps({"number": 2, "case": FIRST}))
        for _ in range(100):
            if busy.ended:
                break
            await asyncio.sleep(0.02)
        assert busy.ended
        found = [await tab.read_message() for _ in range(3)]
        assert json.loads(found[2])["number"] == 2

    served(use)


def test_processes_that_end_before_they_say_anything_are_not_started_without_end(served, monkeypatch):
    class Stillborn(Echo):
        def __init__(self, limit):
            super().__init__(limit)
            asyncio.get_running_loop().call_soon(self.die)

        def die(self):
            self.deliver(None)

    async def use(url):
        monkeypatch.setattr(module, "Process", Stillborn)
        Echo.made[0].ended = True  # the server's first spare
        tab = await opened(url)
        for _ in range(module._TRIES):
            assert "ended" in json.loads(await tab.read_message())["text"]
        await asyncio.sleep(0.1)
        made = len(Echo.made)
        assert made == module._TRIES + 1
        await tab.write_message(json.dumps({"number": 1, "case": FIRST}))  # who asks anew gets one more
        assert "ended" in json.loads(await tab.read_message())["text"]
        assert len(Echo.made) == made + 1

    served(use)


@pytest.mark.parametrize(
    "text", ["no json", "[]", '{"number": 1}', '{"number": "x", "case": {}}', '{"number": 1, "case": 3}']
)
def test_what_is_no_question_is_answered_with_an_error(served, text):
    async def use(url):
        tab = await opened(url)
        await tab.write_message(text)
        assert json.loads(await tab.read_message())["kind"] == "error"

    served(use)


def test_no_file_is_opened_but_that_of_the_start(served):
    mine = {"kind": "file", "name": "/runs/mine.nc"}

    async def use(url):
        tab = await opened(url)
        await tab.write_message(json.dumps({"number": 1, "case": {"kind": "file", "name": "/etc/passwd"}}))
        assert "expected the file" in json.loads(await tab.read_message())["text"]
        assert await answer(tab, 2, mine) == mine

    served(use, first=mine)


def test_a_port_that_is_taken_is_an_error_that_says_so():
    with socket.socket() as taken:
        taken.bind((HOST, 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(ArgumentError, match=f"--port {port}: .*give another"):
            asyncio.run(serve(Server(TOKEN, FIRST, 60.0), port, lambda address: None))


def test_the_token_is_kept_for_this_user_alone(tmp_path, monkeypatch):
    monkeypatch.setattr(module.Path, "home", lambda: tmp_path)
    token = kept_token()
    assert len(token) == 43
    assert kept_token() == token
    path = tmp_path / ".flockana" / "explore-token"
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    path.write_text("short")
    assert len(kept_token()) == 43  # what anybody could guess is not taken
    monkeypatch.setattr(module.Path, "home", lambda: path)  # where nothing can be kept
    assert len({kept_token(), kept_token()}) == 2
