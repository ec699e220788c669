"""Copies of what the book is built from, for tests that change it or build a book of one page."""

from __future__ import annotations

import shutil
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent


def copy_sources(copy: Path) -> Path:
    """Copy what the book is built from into a folder that does not exist yet."""
    copy.mkdir()
    ignore = shutil.ignore_patterns("__pycache__", ".ipynb_checkpoints", "*.png", "node_modules")
    for name in ("dhlib", "book", "exercises", "solutions", "requirements", "bench"):
        if (ROOT / name).exists():
            shutil.copytree(ROOT / name, copy / name, ignore=ignore)
    for name in ("_config.yml", "_toc.yml", "package-lock.json"):
        shutil.copy(ROOT / name, copy)
    for name in ("node_modules", ".tools"):
        if (ROOT / name).exists():
            (copy / name).symlink_to(ROOT / name)
    return copy


def book_of_one_page(copy: Path, text: str, name: str = "page") -> Path:
    """Copy what the book is built from, but for its contents: they are this page."""
    copy_sources(copy)
    put_page(copy, text, name)
    return copy


def put_page(copy: Path, text: str, name: str = "page") -> None:
    """Put a page into a copy of the book, and that page alone."""
    (copy / "book" / f"{name}.md").write_text(text, "utf-8")
    (copy / "_toc.yml").write_text(f"format: jb-book\nroot: book/{name}\n", "utf-8")
