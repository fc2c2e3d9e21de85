"""A page on this machine only.

Meshcat's own server listens on every interface (`Application.listen` without an address), so that anyone
on the network could look on and draw. This one binds 127.0.0.1, answers only to that name (no rebinding
of foreign names to it), and sends nothing but the page.
"""

from __future__ import annotations

import hashlib
import threading
import webbrowser
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any

from rover_pin.errors import InputError

if TYPE_CHECKING:
    from rover_pin.statics.stance import Stance

LOOPBACK = "127.0.0.1"


class Served:
    """A page being served.

    Attributes:
        url: where.
        port: of the server.
    """

    def __init__(self, html: str, port: int = 0, fragment: str = "") -> None:
        self._body = b""
        self._mark = ""
        self._put(html)
        try:
            self._server = ThreadingHTTPServer((LOOPBACK, port), _handler(self))
        except (OSError, OverflowError) as error:
            raise InputError(
                "this port cannot be served",
                element="port",
                value=port,
                cure="leave it out to take a free one",
            ) from error
        self._server.daemon_threads = True
        self.port = int(self._server.server_address[1])
        self.url = f"http://{LOOPBACK}:{self.port}/" + (f"#{fragment}" if fragment else "")
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.1,), daemon=True)
        self._thread.start()

    def _put(self, html: str) -> None:
        # The page asks for its mark and loads itself anew when it changed; only a served page may connect.
        live = html.replace("connect-src 'none'", "connect-src 'self'").replace(
            "<body", '<body data-live="mark"', 1
        )
        self._body = live.encode("utf-8")
        self._mark = hashlib.sha256(self._body).hexdigest()

    def replace(self, stance: Stance) -> None:
        """Show another stance; open pages take it over within a second, the camera where it was."""
        from rover_pin.viz.show import stance_page

        self._put(stance_page(stance))

    def wait(self) -> None:
        """Serve until interrupted (Ctrl-C)."""
        try:
            while self._thread.is_alive():
                self._thread.join(0.5)
        except KeyboardInterrupt:
            self.close()

    def close(self) -> None:
        """Stop serving."""
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def __enter__(self) -> Served:
        """Serve within a `with`."""
        return self

    def __exit__(self, *_: object) -> None:
        """Stop serving."""
        self.close()

    def answer(self, path: str) -> tuple[str, bytes] | None:
        """Content type and body for a path, None where there is nothing."""
        if path == "/":
            return "text/html; charset=utf-8", self._body
        return ("text/plain; charset=utf-8", self._mark.encode()) if path == "/mark" else None


def _handler(served: Served) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            allowed = {f"{name}:{served.port}" for name in (LOOPBACK, "localhost")}
            found = served.answer(self.path.split("?")[0]) if self.headers.get("Host") in allowed else None
            if found is None:
                self.send_error(404)
                return
            kind, body = found
            self.send_response(200)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(body)))
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_: Any) -> None:
            """Say nothing: the command line prints what people need."""

    return Handler


def serve(html: str, *, port: int = 0, fragment: str = "", open_browser: bool = True) -> Served:
    """Serve an HTML text on 127.0.0.1, and open the browser on it, at what follows `#` in its address.

    Raises:
        InputError: the port is taken.
    """
    served = Served(html, port, fragment)
    if open_browser:
        webbrowser.open(served.url)
    return served
