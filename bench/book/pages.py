"""What a reader's phone gets: our pages beside the same chapters as a plain Jupyter Book.

``python pages.py`` in the book's own environment prints one JSON object. Lighthouse opens both with its simulated
phone, several times each. What the plain pages fetch from other hosts is served from this machine, under the names of
those hosts, compressed as there, so that the measurement needs no network; what was asked of them and is not in these
copies is named. Real hosts are farther away than that: the comparison is kind to the plain book.
"""

from __future__ import annotations

import datetime
import functools
import gzip
import http.server
import ipaddress
import json
import os
import ssl
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "book" / "build"))

import books
import chromium
from environment import BENCH, NotToBeHad, size

WEB = BENCH / "web"
RUNS = size(3, 1)
PAGES = {"front page": "book/index.html", "a chapter": "book/classic.html", "a robot": "book/pa10.html"}
PAGES = {name: page for name, page in PAGES.items() if page.removesuffix(".html") in books.chapters()}
#: Path on the host to the file that stands for it; npm's hosts name package, version and file.
COPIES = {
    "/npm/mathjax@3/": "mathjax/",
    "/ajax/libs/require.js/2.3.4/require.min.js": "requirejs/require.js",
    "/npm/@jupyter-widgets/html-manager@1.0.6/": "@jupyter-widgets/html-manager/",
}


class Copies(http.server.BaseHTTPRequestHandler):
    """Serves the copies, to whatever host the request was meant for."""

    protocol_version = "HTTP/1.1"

    def do_GET(self) -> None:
        """Send a file, compressed."""
        path = self.path.split("?")[0]
        begin = next((begin for begin in COPIES if path.startswith(begin)), None)
        file = WEB / "node_modules" / (COPIES[begin] + path.removeprefix(begin)) if begin else None
        content = gzip.compress(file.read_bytes()) if file and file.is_file() else b""
        self.send_response(200 if content else 404)
        kind = "text/javascript" if path.endswith(".js") else "application/octet-stream"
        headers = {"Content-Type": kind, "Content-Encoding": "gzip"} if content else {}
        headers |= {
            "Content-Length": str(len(content)),
            "Access-Control-Allow-Origin": "*",
            "Cache-Control": "max-age=600",
        }
        for name, value in headers.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_: object) -> None:
        """Say nothing."""


@contextmanager
def other_hosts() -> Iterator[int]:
    """Serve the copies with a certificate of our own; yields the port."""
    with tempfile.TemporaryDirectory() as folder:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(certificate(Path(folder)))
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Copies))
        server.socket = context.wrap_socket(server.socket, server_side=True)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server.server_address[1]
        server.shutdown()


def certificate(folder: Path) -> Path:
    """Make a key and a certificate that nobody but this run's browser accepts."""
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.asymmetric import ec

    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, "copies of other hosts")])
    now = datetime.datetime.now(datetime.UTC)
    made = (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now)
        .not_valid_after(now + datetime.timedelta(days=1))
        .add_extension(x509.SubjectAlternativeName([x509.IPAddress(ipaddress.ip_address("127.0.0.1"))]), critical=False)
        .sign(key, hashes.SHA256())
    )
    private = key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    path = folder / "copies.pem"
    path.write_bytes(private + made.public_bytes(serialization.Encoding.PEM))
    return path


def seen_by_lighthouse(site: Path, port: int) -> dict[str, Any]:
    """Open the pages of a site; other hosts are this machine."""
    browser = chromium.find()
    if browser is None:
        raise NotToBeHad(f"no Chromium. {chromium.ADVICE}")
    flags = [f"--host-resolver-rules=MAP * 127.0.0.1:{port}, EXCLUDE 127.0.0.1", "--ignore-certificate-errors"]
    told = {"RUNS": str(RUNS), "REPORT": "json", "PAGES": json.dumps(PAGES), "FLAGS": "\n".join(flags)}
    node = os.environ.get("DHBOOK_NODE", "node")
    said = subprocess.run(
        [node, WEB / "lighthouse.mjs", site, browser],
        env=os.environ | told,
        stdout=subprocess.PIPE,
        text=True,
        check=False,
    )
    if not said.stdout.strip():
        raise NotToBeHad("Lighthouse said nothing")
    found: dict[str, Any] = json.loads(said.stdout.strip().splitlines()[-1])
    return found


def npm() -> list[str]:
    """Return the call of npm: that which came with the Node of the book, where the machine has none."""
    node = os.environ.get("DHBOOK_NODE")
    return [node, str(Path(node).parents[1] / "lib/node_modules/npm/bin/npm-cli.js")] if node else ["npm"]


def main() -> None:
    """Build both, and open them."""
    subprocess.run([*npm(), "ci", "--no-progress", "--silent"], cwd=WEB, check=True)
    rows = []
    with other_hosts() as port:
        for who, lay_out in (("dhlib", books.ours), ("plain", books.plain)):
            print(f"  pages: building {who}", file=sys.stderr, flush=True)
            books.build(folder := lay_out())  # anew: a site that stands there may be of another day
            print(f"  pages: {who}", file=sys.stderr, flush=True)
            found = seen_by_lighthouse(books.site_of(folder), port)
            rows += [{"peer": who, "page": page, **values} for page, values in found.items()]
    lighthouse = json.loads((WEB / "package.json").read_text("utf-8"))["dependencies"]["lighthouse"]
    json.dump({"rows": rows, "runs": RUNS, "versions": {"lighthouse": lighthouse}}, sys.stdout)


if __name__ == "__main__":
    main()
