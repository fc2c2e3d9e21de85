"""Serving: on this machine only."""

from __future__ import annotations

import socket
import urllib.error
import urllib.request

import pytest
import viz_doubles as doubles

from rover_pin.errors import InputError
from rover_pin.viz import serve as serve_module
from rover_pin.viz.serve import serve

HTML = "<meta content=\"connect-src 'none'\"><body>hello</body>"


@pytest.fixture
def served():
    with serve(HTML, open_browser=False) as running:
        yield running


def get(url, host=None):
    request = urllib.request.Request(url, headers={"Host": host} if host else {})
    with urllib.request.urlopen(request, timeout=5) as reply:
        return reply.read().decode()


def test_it_listens_on_loopback_only(served):
    assert served._server.socket.getsockname() == ("127.0.0.1", served.port)
    outside = {info[4][0] for info in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)}
    for address in outside | {"127.0.0.2"}:
        if address != "127.0.0.1":
            with pytest.raises(OSError, match=r"refused|timed out"):
                socket.create_connection((address, served.port), timeout=1).close()


def test_it_answers_with_the_page_and_to_its_own_name_only(served):
    assert "hello" in get(served.url)
    assert "connect-src 'self'" in get(served.url)
    assert "hello" in get(served.url, host=f"localhost:{served.port}")
    for url, host in ((served.url, "evil.example"), (served.url + "etc/passwd", None)):
        with pytest.raises(urllib.error.HTTPError, match="404"):
            get(url, host)


def test_another_stance_changes_the_mark(served):
    before = get(served.url + "mark")
    served.replace(doubles.stance(status="tips"))
    assert get(served.url + "mark") != before
    assert "stand-in" in get(served.url)


def test_a_taken_port_is_said(served):
    with pytest.raises(InputError, match=r"port: this port cannot be served \(got \d+\); leave it out"):
        serve(HTML, port=served.port, open_browser=False)
    with pytest.raises(InputError, match="port: this port cannot be served"):
        serve(HTML, port=70_000, open_browser=False)


def test_the_browser_opens_on_it(monkeypatch):
    opened = []
    monkeypatch.setattr(serve_module.webbrowser, "open", opened.append)
    with serve(HTML) as running:
        assert opened == [running.url]


def test_closing_twice_does_no_harm():
    running = serve(HTML, open_browser=False)
    running.close()
    running.close()
    with pytest.raises(OSError, match="refused"):
        socket.create_connection(("127.0.0.1", running.port), timeout=1).close()
