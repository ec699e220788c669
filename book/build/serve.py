"""Serve the built book on this machine alone, and open it where there is a browser."""

from __future__ import annotations

import argparse
import functools
import http.server
import webbrowser
from pathlib import Path


class Quiet(http.server.SimpleHTTPRequestHandler):
    """A file server that does not print every request, and lets no browser keep old pages."""

    extensions_map = http.server.SimpleHTTPRequestHandler.extensions_map | {
        ".js": "text/javascript",
        ".mjs": "text/javascript",
        ".wasm": "application/wasm",
    }

    def log_message(self, *_: object) -> None:
        """Say nothing."""

    def end_headers(self) -> None:
        """Ask the browser to look again each time."""
        self.send_header("Cache-Control", "no-cache")
        super().end_headers()


def server(folder: Path, port: int = 0) -> http.server.ThreadingHTTPServer:
    """Return a server for `folder`, on a free port unless one is named."""
    return http.server.ThreadingHTTPServer(("127.0.0.1", port), functools.partial(Quiet, directory=str(folder)))


def main() -> None:
    """Serve until interrupted."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--port", type=int, default=0, help="a free one if not given")
    parser.add_argument("--no-open", action="store_true", help="do not open a browser")
    choice = parser.parse_args()
    if not (choice.folder / "index.html").exists():
        parser.error(f"{choice.folder} holds no index.html: run `make book` first")
    with server(choice.folder, choice.port) as httpd:
        address = f"http://localhost:{httpd.server_address[1]}/"
        print(f"The book is at {address} (Ctrl-C ends it)", flush=True)
        if not choice.no_open:
            webbrowser.open(address)
        try:
            httpd.serve_forever()
        except KeyboardInterrupt:
            print()


if __name__ == "__main__":
    main()
