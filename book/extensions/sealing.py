"""Seal the answers of a question, so that they do not stand in the page.

What the reader enters is the key. Each entry of an answer is a number on a line that is cut into cells, and the
numbers of the cells, joined, are a password. PBKDF2 makes of it the key of an AES-GCM record with what there is to
say. Where the cuts lie is public, and so chosen that every foreseen answer stands clear of them: an answer as exact
as was asked for opens its record. The record itself holds the exact values, to compare with, and is packed before it is
sealed: afterwards nothing makes it smaller.

This keeps answers from the source and from a glance. A single number has few digits, and whoever lets a computer
try them all will find it: questions are for learning, never for marks. ``book/web/questions.js`` opens records.
"""

from __future__ import annotations

import base64
import hashlib
import hmac
import json
import math
import os
import random
import zlib
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

from cryptography.hazmat.primitives.ciphers.aead import AESGCM

ROUNDS = 20_000
CELL = 8.0
"""Width of a cell, in tolerances."""
CLEAR = 1.5
"""How far from a cut every foreseen answer stands, in tolerances."""
LENGTH = 4
"""Bytes before what is packed that say how long it is; the rest of a record fills it up."""

Values = Sequence[float]


def tolerance(decimals: int) -> float:
    """Return how far an answer may be off that is right in `decimals` decimals."""
    return 0.5 * 10.0**-decimals * (1 + 1e-6)


def cell(value: float, start: float, width: float, period: float | None) -> int:
    """Return the number of the cell that holds a value."""
    beyond = value - start
    return math.floor((beyond if period is None else beyond - period * math.floor(beyond / period)) / width)


def is_clear(value: float, start: float, width: float, period: float | None, clear: float) -> bool:
    """Say whether a value stands clear of every cut."""
    return cell(value - clear, start, width, period) == cell(value + clear, start, width, period)


def cuts(columns: Sequence[Values], decimals: int, periods: Sequence[float | None], seed: str) -> dict[str, Any]:
    """Return where to cut the line of each entry: ``width``, and a ``start`` for each.

    Parameters
    ----------
    columns : sequence of sequences of float
        For each entry, the values foreseen.
    decimals : int
        How many are asked for.
    periods : sequence of float or None
        For each entry.
    seed : str
        Makes the choice repeatable.
    """
    within, choose = tolerance(decimals), random.Random(seed)
    width = CELL * within
    while True:
        starts = []
        for values, period in zip(columns, periods, strict=True):
            draws = (round(-choose.uniform(0, period or width), decimals + 3) for _ in range(2000))
            start = next((s for s in draws if all(is_clear(v, s, width, period, CLEAR * within) for v in values)), None)
            if start is None:
                break
            starts.append(start)
        else:
            return {"width": width, "starts": starts}
        width *= 2


def derive(password: str, salt: bytes) -> bytes:
    """Return the key that a password stands for."""
    return hashlib.pbkdf2_hmac("sha256", password.encode(), salt, ROUNDS)


class Keys:
    """Derives keys beside whatever else goes on, and keeps them in a file: each costs a good part of a second."""

    def __init__(self, store: Path | None = None) -> None:
        self.store = store
        self.known: dict[str, str] = json.loads(store.read_text("utf-8")) if store and store.exists() else {}
        self.threads = ThreadPoolExecutor(max(1, (os.cpu_count() or 1) - 1))  # one core is left to who reads pages
        self.begun: dict[str, Future[bytes]] = {}

    def begin(self, passwords: list[str], salt: bytes) -> None:
        """Start to derive the keys that some passwords stand for."""
        for word in passwords:
            name = self._name(word, salt)
            if name not in self.known and name not in self.begun:
                self.begun[name] = self.threads.submit(derive, word, salt)

    def of(self, passwords: list[str], salt: bytes) -> list[bytes]:
        """Return the keys that some passwords stand for."""
        self.begin(passwords, salt)
        names = [self._name(word, salt) for word in passwords]
        for name in names:
            if name in self.begun:
                self.known[name] = _text(self.begun.pop(name).result())
        return [base64.b64decode(self.known[name]) for name in names]

    def _name(self, password: str, salt: bytes) -> str:
        return hashlib.sha256(f"{ROUNDS} {_text(salt)} {password}".encode()).hexdigest()

    def save(self) -> None:
        """Keep the keys, and end."""
        self.threads.shutdown(cancel_futures=True)
        if self.store:
            self.store.parent.mkdir(parents=True, exist_ok=True)
            draft = self.store.with_suffix(f".{os.getpid()}")
            draft.write_text(json.dumps(self.known), "utf-8")
            draft.replace(self.store)


def lock(question: dict[str, Any], seed: str) -> tuple[dict[str, Any], list[str], bytes]:
    """Return what is public of a question, and what its keys are derived from: a password for each answer, and a salt.

    Parameters
    ----------
    question : dict
        What ``bookkit.question`` or ``bookkit.choice`` keeps.
    seed : str
        The page and the name of the question: the same question is sealed in the same way each time.
    """
    salt = hashlib.sha256(f"salt {seed}".encode()).digest()[:16]
    public: dict[str, Any] = {"rounds": ROUNDS, "salt": _text(salt), "kind": question["kind"]}
    answers = question["answers"]
    if question["kind"] != "number":
        return public, [",".join(map(str, answer["value"])) for answer in answers], salt
    periods = question["periods"]
    columns = list(zip(*(answer["value"] for answer in answers), strict=True))
    lines = cuts(columns, question["decimals"], periods, seed)
    public |= {"tolerance": tolerance(question["decimals"]), "periods": periods, "unit": question["unit"], **lines}
    passwords = [
        ",".join(
            str(cell(value, start, lines["width"], period))
            for value, start, period in zip(answer["value"], lines["starts"], periods, strict=True)
        )
        for answer in answers
    ]
    return public, passwords, salt


def seal(question: dict[str, Any], seed: str, keys: Keys | None = None) -> dict[str, Any]:
    """Return what the page may hold of a question.

    Parameters
    ----------
    question : dict
        As for `lock`; what its answers say is HTML by now.
    seed : str
    keys : Keys, optional
        Where keys of earlier builds are kept.
    """
    public, passwords, salt = lock(question, seed)
    records, packed = [], [zlib.compress(json.dumps(answer).encode(), 9) for answer in question["answers"]]
    length = max(map(len, packed))
    for plain, key in zip(packed, (keys or Keys()).of(passwords, salt), strict=True):
        # nor may their length tell which is right
        padded = len(plain).to_bytes(LENGTH, "big") + plain.ljust(length, b"\0")
        nonce = hmac.new(key, padded, "sha256").digest()[:12]  # of the content: no nonce serves twice
        records.append(_text(nonce + AESGCM(key).encrypt(nonce, padded, None)))
    public["records"] = sorted(records)  # nor their order
    return public


def _text(raw: bytes) -> str:
    return base64.b64encode(raw).decode()
