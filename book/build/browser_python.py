"""The Python that runs in the page: Pyodide's core, and the packages that the chapters import.

Everything comes from what is locked already. The interpreter is the npm package; sympy and mpmath are the files of
the environment that builds the book, byte-compiled by that interpreter and without their tests; dhlib is that of
this build. numpy alone has to be compiled for the browser, and no package index carries it: see `find_numpy`.
What was compiled is kept under ``node_modules/.cache``, by the content of what it was made from.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
import os
import re
import shutil
import subprocess
import tempfile
import urllib.error
import urllib.request
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent.parent
PYODIDE = ROOT / "node_modules" / "pyodide"
CACHE = ROOT / "node_modules" / ".cache" / "dh-book"
#: What the interpreter asks for, by its own names.
CORE = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip")
#: Pure packages: what each needs, and the modules by which code asks for it.
PURE: dict[str, tuple[list[str], list[str]]] = {"mpmath": ([], ["mpmath"]), "sympy": (["mpmath"], ["sympy"])}
#: Not asked for by any chapter.
NEEDLESS = re.compile(
    r"(^|/)(tests|benchmarks|testing|__pycache__)/|\.pyc$|^sympy/parsing/(autolev|c|fortran|latex)/"
    r"|^sympy/physics/(biomechanics|continuum_mechanics|control|hep|mechanics|optics)/"
)
MOMENT = (2026, 1, 1, 0, 0, 0)
SECONDS_TO_WAIT = 30


@dataclass(frozen=True)
class Wheel:
    """A wheel for the browser: a file to serve, or the address of one that another host serves."""

    name: str
    version: str
    file_name: str
    sha256: str
    path: Path | None
    source: str

    @property
    def size(self) -> int:
        """Its bytes; 0 where they are not here."""
        return self.path.stat().st_size if self.path else 0


class NoInterpreter(Exception):
    """The npm package is not there."""


def pyodide_lock() -> dict[str, Any]:
    """Return what Pyodide's own distribution holds."""
    path = PYODIDE / "pyodide-lock.json"
    if not path.is_file():
        raise NoInterpreter("Pyodide is missing: run `make book`, or `npm ci`.")
    lock: dict[str, Any] = json.loads(path.read_text("utf-8"))
    return lock


def pyodide_version() -> str:
    """Return the version of the npm package."""
    return str(json.loads((PYODIDE / "package.json").read_text("utf-8"))["version"])


def digest(*parts: bytes) -> str:
    """Return a short hash of some content."""
    together = hashlib.sha256()
    for part in parts:
        together.update(hashlib.sha256(part).digest())
    return together.hexdigest()[:12]


def digest_of(files: Mapping[str, Path]) -> str:
    """Return a short hash of files and their names."""
    return digest(*(part for name, path in sorted(files.items()) for part in (name.encode(), path.read_bytes())))


# Wheels


def write_wheel(into: Path, name: str, version: str, files: Mapping[str, Path], *, tag: str = "py3-none-any") -> Wheel:
    """Write files into a wheel whose name tells its content, so that no browser keeps an old one."""
    information = f"{name}-{version}.dist-info"
    target = into / f"{name}-{version}-0{digest_of(files)}-{tag}.whl"
    if not target.exists():
        metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        about = {
            f"{information}/METADATA": metadata.encode(),
            f"{information}/WHEEL": f"Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: {tag}\n".encode(),
        }
        into.mkdir(parents=True, exist_ok=True)
        draft = target.with_suffix(f".{os.getpid()}")
        with zipfile.ZipFile(draft, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
            contents = {member: path.read_bytes() for member, path in files.items()} | about
            record = "".join(f"{member},,\n" for member in sorted(contents))
            contents[f"{information}/RECORD"] = record.encode()
            for member in sorted(contents):
                entry = zipfile.ZipInfo(member, MOMENT)
                entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
                archive.writestr(entry, contents[member])
        draft.replace(target)
    return Wheel(name, version, target.name, hashlib.sha256(target.read_bytes()).hexdigest(), target, "this build")


def compile_files(files: Mapping[str, Path], node: str, *, keep: bool = False) -> dict[str, Path]:
    """Return files with their modules byte-compiled for the browser, in place of the source or beside it."""
    program = Path(__file__).with_name("compile_for_browser.mjs")
    key = digest(pyodide_version().encode(), program.read_bytes(), digest_of(files).encode(), b"keep" * keep)
    done = CACHE / f"compiled-{key}"
    if not done.is_dir():
        CACHE.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=CACHE) as folder:
            source, target = Path(folder) / "source", Path(folder) / "target"
            target.mkdir()
            for name, path in files.items():
                (source / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(path, source / name)
            ran = subprocess.run(
                [node, str(program), str(source), str(target), *(["keep"] if keep else [])],
                cwd=ROOT,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                encoding="utf-8",
                check=False,
            )
            if ran.returncode:
                raise NoInterpreter(f"Python for the page does not start:\n{ran.stdout}")
            try:
                target.rename(done)
            except OSError:  # somebody else was quicker
                if not done.is_dir():
                    raise
    compiled = {path.relative_to(done).as_posix(): path for path in done.rglob("*.pyc")}
    return compiled | {name: path for name, path in files.items() if keep or path.suffix != ".py"}


def pure_wheel(name: str, node: str) -> Wheel:
    """Return the wheel of a pure package of this environment, byte-compiled and without its tests."""
    distribution = importlib.metadata.distribution(name)
    files = {
        str(member): Path(str(distribution.locate_file(member)))
        for member in distribution.files or []
        if not NEEDLESS.search(str(member)) and str(member).startswith(f"{name}/")
    }
    return write_wheel(CACHE, name, distribution.version, compile_files(files, node))


def dhlib_wheel(node: str) -> Wheel:
    """Return the wheel of the library as it is now: sources too, so that an error can show its line."""
    files = {
        path.relative_to(ROOT).as_posix(): path
        for path in sorted((ROOT / "dhlib").rglob("*"))
        if path.is_file() and path.suffix in {".py", ".html", ".css"} and "__pycache__" not in path.parts
    }
    version = re.search(r'^__version__ = "([^"]+)"', (ROOT / "dhlib" / "__init__.py").read_text("utf-8"), re.MULTILINE)
    assert version is not None
    return write_wheel(CACHE, "dhlib", version[1], compile_files(files, node, keep=True))


def find_numpy() -> Wheel:
    """Return numpy for the browser.

    From the folder named by ``DHBOOK_WHEELS``, else from ``../shared/wasm`` where that exists; else Pyodide's own
    build, whose sha256 stands in the lock of the npm package; else, without internet, its address, for the reader's
    browser to take it from.
    """
    lock = pyodide_lock()
    entry = lock["packages"]["numpy"]
    abi = re.sub(r"^numpy-[^-]+-", "", entry["file_name"])
    asked = os.environ.get("DHBOOK_WHEELS")
    for folder in [Path(asked)] if asked else [ROOT.parent / "shared" / "wasm"]:
        for path in sorted(folder.glob(f"numpy-*-{abi}"), reverse=True):
            sha256 = hashlib.sha256(path.read_bytes()).hexdigest()
            return Wheel("numpy", path.name.split("-")[1], path.name, sha256, path, str(folder))
    address = cdn_address() + entry["file_name"]
    kept = CACHE / entry["file_name"]
    if not kept.exists() and (content := download(address)) is not None:
        if hashlib.sha256(content).hexdigest() != entry["sha256"]:
            raise NoInterpreter(f"{address} is not what the lock of the pyodide package names; nothing was taken.")
        CACHE.mkdir(parents=True, exist_ok=True)
        draft = kept.with_suffix(f".{os.getpid()}")
        draft.write_bytes(content)
        draft.replace(kept)
    if kept.exists():
        return Wheel("numpy", entry["version"], kept.name, entry["sha256"], kept, "Pyodide's own distribution")
    return Wheel("numpy", entry["version"], address, entry["sha256"], None, "the reader's own connection")


def cdn_address() -> str:
    """Return where Pyodide's own distribution is, as the npm package itself names it."""
    found = re.search(r"`(https://[^`$]+/v)\$\{\w+\}(/full/)`", (PYODIDE / "pyodide.mjs").read_text("utf-8"))
    if not found:
        raise NoInterpreter("pyodide.mjs no longer names the address of its distribution; numpy cannot be found.")
    return f"{found[1]}{pyodide_version()}{found[2]}"


def elsewhere(name: str, here: set[str]) -> dict[str, Any]:
    """Return the entries of a package that the book does not serve, and of what it needs, with their addresses."""
    known, found, waiting = pyodide_lock()["packages"], {}, [name]
    while waiting:
        name = waiting.pop()
        if name not in here and name not in found:
            entry = known[name]
            found[name] = entry | {"file_name": cdn_address() + entry["file_name"]}
            waiting += entry["depends"]
    return found


def download(address: str) -> bytes | None:
    """Return what an address serves, None where it cannot be reached."""
    try:
        with urllib.request.urlopen(address, timeout=SECONDS_TO_WAIT) as answer:
            content: bytes = answer.read()
            return content
    except (urllib.error.URLError, OSError):
        return None


# The distribution


@dataclass(frozen=True)
class Distribution:
    """What the site serves under ``run/``: the interpreter in a folder of its version, and the wheels."""

    wheels: tuple[Wheel, ...]

    @property
    def lock(self) -> dict[str, Any]:
        """Return the lock that the interpreter reads in the page."""
        needs: dict[str, tuple[list[str], list[str]]] = PURE | {
            "numpy": ([], ["numpy"]),
            "dhlib": (["numpy", "sympy"], ["dhlib"]),
        }
        packages = {
            wheel.name: {
                "name": wheel.name,
                "version": wheel.version,
                "file_name": wheel.file_name,
                "install_dir": "site",
                "sha256": wheel.sha256,
                "package_type": "package",
                "imports": needs[wheel.name][1],
                "depends": needs[wheel.name][0],
                "unvendored_tests": False,
            }
            for wheel in self.wheels
        }
        return {"info": pyodide_lock()["info"], "packages": elsewhere("matplotlib", set(packages)) | packages}

    @property
    def edition(self) -> str:
        """Return a short hash of it all."""
        return digest(json.dumps(self.lock).encode(), pyodide_version().encode())

    @property
    def description(self) -> dict[str, Any]:
        """Return what the page needs to know: where things are, and how many bytes each has."""
        sizes = {name: (PYODIDE / name).stat().st_size for name in CORE}
        sizes |= {wheel.file_name: wheel.size for wheel in self.wheels}
        return {"interpreter": f"pyodide-{pyodide_version()}/", "lock": f"lock-{self.edition}.json", "bytes": sizes}

    @property
    def numpy_from(self) -> str:
        """Return, in a sentence, where numpy comes from."""
        (numpy,) = (wheel for wheel in self.wheels if wheel.name == "numpy")
        if numpy.path:
            return f"numpy {numpy.version} for the page: from {numpy.source}; the site serves it."
        return (
            f"numpy {numpy.version} for the page: NOT SERVED. No wheel for the browser is here and none could be "
            f"fetched, so that the reader's browser takes it from {numpy.file_name}. "
            "DHBOOK_WHEELS may name a folder that holds one."
        )

    def write(self, into: Path) -> None:
        """Write it into a folder of the site, and remove what an earlier build left there."""
        interpreter = into / self.description["interpreter"]
        interpreter.mkdir(parents=True, exist_ok=True)
        wanted = {interpreter / name: PYODIDE / name for name in CORE}
        wanted |= {into / wheel.file_name: wheel.path for wheel in self.wheels if wheel.path}
        for target, source in wanted.items():
            if not target.exists() or target.stat().st_size != source.stat().st_size:
                shutil.copyfile(source, target)
        lock = into / self.description["lock"]
        lock.write_text(json.dumps(self.lock), "utf-8")
        for old in [*into.glob("*.whl"), *into.glob("lock-*.json"), *into.glob("pyodide-*/*")]:
            if old not in wanted and old != lock:
                old.unlink()


def distribution(node: str) -> Distribution:
    """Return the distribution of this build; compiles what is not compiled yet."""
    wheels = [find_numpy(), *(pure_wheel(name, node) for name in PURE), dhlib_wheel(node)]
    return Distribution(tuple(wheels))
