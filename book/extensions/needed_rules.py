"""Leave in a style sheet what some page can use: most of the theme's rules are for what no page here has.

A rule stays if every class, id and element that one of its selectors names is written in some page, or is a word of
what runs in the pages: scripts add classes, and cells write HTML. Attributes, what a selector excludes, and what stands
within ``:is()`` and its like, are not asked.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import tinycss2

WORD = re.compile(r"[A-Za-z_][\w-]*")
SCRIPT = re.compile(r"<script\b[^>]*>(.*?)</script>", re.DOTALL)
DATA = re.compile(r'<script\b[^>]*type="application/json"[^>]*>.*?</script>', re.DOTALL)
TAG = re.compile(r"<([a-zA-Z][\w-]*)")
NAMED = re.compile(r'\b(?:class|id)="([^"]*)"')
#: Elements of every page, and classes that scripts join of parts.
ALWAYS = {"html", "body", *(f"bs-tooltip-{side}" for side in ("auto", "top", "bottom", "start", "end"))}
#: Rules that hold rules.
NESTING = {"media", "supports", "layer", "container"}


def words_of_page(page: str) -> set[str]:
    """Return the elements, classes and ids of a page, and the words of its scripts.

    >>> sorted(words_of_page('<p class="a b" hidden>c d</p><script>toggle("e")</script>'))
    ['a', 'b', 'e', 'p', 'script', 'toggle']
    """
    found = {name.lower() for name in TAG.findall(page)}
    for names in set(NAMED.findall(page)):
        found.update(names.split())
    for script in SCRIPT.findall(DATA.sub("", page)):
        found.update(WORD.findall(script))
    return found


def vocabulary(pages: Iterable[Path], running: Iterable[Path]) -> set[str]:
    """Return all that a selector may name: what stands in `pages`, and the words of what is `running` in them."""
    found = set(ALWAYS)
    for path in pages:
        found |= words_of_page(path.read_text("utf-8"))
    for path in running:
        found.update(WORD.findall(path.read_text("utf-8", errors="ignore")))
    return found


def names_in(selector: list[Any]) -> set[str]:
    """Return the classes, ids and elements that something must have to be meant by a selector."""
    names: set[str] = set()
    before = None
    for token in selector:
        if token.type == "hash":
            names.add(token.value)
        elif token.type == "ident" and before != ":":
            names.add(token.value if before == "." else token.value.lower())
        before = token.value if token.type == "literal" else None
    return names


def split(prelude: list[Any]) -> list[list[Any]]:
    """Return the selectors of a list."""
    selectors: list[list[Any]] = [[]]
    for token in prelude:
        if token.type == "literal" and token.value == ",":
            selectors.append([])
        else:
            selectors[-1].append(token)
    return selectors


def pruned(sheet: str, words: set[str]) -> str:
    """Return a style sheet without the rules, and the selectors of rules, that name what is not in `words`.

    >>> pruned(".a, .b:not(.c){top:0} @media print{.c{top:0}} p>.a{top:1px}", {"a", "p"})
    '.a{top:0}p>.a{top:1px}'
    """
    return _written(tinycss2.parse_stylesheet(sheet, skip_comments=True, skip_whitespace=True), words)


def _written(rules: list[Any], words: set[str]) -> str:
    kept = []
    for rule in rules:
        if rule.type == "qualified-rule":
            used = [selector for selector in split(rule.prelude) if names_in(selector) <= words]
            if used:
                selectors = ",".join(tinycss2.serialize(selector).strip() for selector in used)
                kept.append(f"{selectors}{{{tinycss2.serialize(rule.content).strip()}}}")
        elif rule.type == "at-rule" and rule.lower_at_keyword in NESTING and rule.content is not None:
            inner = tinycss2.parse_rule_list(rule.content, skip_comments=True, skip_whitespace=True)
            if written := _written(inner, words):
                kept.append(f"@{rule.at_keyword}{tinycss2.serialize(rule.prelude)}{{{written}}}")
        else:
            kept.append(rule.serialize())
    return "".join(kept)
