"""The directive ``{dh-question}``: a question that the page checks, and whose answer does not stand in the page.

    ```{dh-question} reach
    How far does the arm reach?
    ```

What is right and wrong was kept under this name by `bookkit.question` or `bookkit.choice` in a cell above. The last
list of a choice holds its options. The written page has the question and what is sealed (see `sealing`); answers in
the clear go beside the site, into ``answers/``, for the printed book alone.
"""

from __future__ import annotations

import html
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from docutils import nodes
from formulas import ROOT, set_formula
from myst_nb.core.variables import RetrievalError
from myst_nb.ext.glue.utils import retrieve_glue_data
from scripts import bundle
from sealing import Keys, lock, seal
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

logger = logging.getLogger(__name__)

MARKUP = re.compile(
    r"\$(?P<tex>[^$]+)\$|`(?P<code>[^`]+)`|\*(?P<stress>[^*]+)\*|\[(?P<words>[^]]+)\]\(#(?P<label>[^)]+)\)"
)


class QuestionNode(nodes.General, nodes.Element):  # type: ignore[misc]
    """A question: its text, then its options if it is a choice."""


class OptionNode(nodes.General, nodes.Element):  # type: ignore[misc]
    """One option of a choice."""


class QuestionDirective(SphinxDirective):
    """Ask what a cell above has kept the answer of."""

    required_arguments = 1
    final_argument_whitespace = True
    has_content = True

    def run(self) -> list[nodes.Node]:
        """Return the question."""
        name = self.arguments[0]
        try:
            kept = retrieve_glue_data(self.state.document, f"question {name}")
        except RetrievalError:
            raise self.error(f"No question {name!r} is kept: a cell above should call question({name!r}, …).") from None
        number = self.env.temp_data["dh-questions"] = self.env.temp_data.get("dh-questions", 0) + 1
        node = QuestionNode(question=json.loads(kept.data["text/question"]), name=name, number=number)
        node["ids"].append(nodes.make_id(f"question-{name}"))
        self.set_source_info(node)
        self.state.nested_parse(self.content, self.content_offset, node)
        if node["question"]["kind"] == "choice":
            self.take_options(node)
        self.env.metadata[self.env.docname]["has_questions"] = True
        # What it will be sealed with is derived while pages are read and written.
        _, *of_keys = lock(node["question"], seed(self.env.docname, name))
        self.env.app.keys.begin(*of_keys)  # type: ignore[attr-defined]
        return [node]

    def take_options(self, node: QuestionNode) -> None:
        """Make options of the list that ends the text."""
        options = node.children[-1] if node.children else None
        if not isinstance(options, nodes.bullet_list | nodes.enumerated_list):
            raise self.error("The text of a choice ends in a list: its options.")
        numbers = {number for answer in node["question"]["answers"] for number in answer["value"]}
        if not numbers <= set(range(1, len(options) + 1)):
            raise self.error(f"There are {len(options)} options, and the answers speak of {sorted(numbers)}.")
        node.remove(options)
        for number, item in enumerate(options, 1):
            option = OptionNode(number=number, several=node["question"]["several"], name=node["name"])
            for part in item.children:
                option.extend(part.children if isinstance(part, nodes.paragraph) else [part])
            node.append(option)


def seed(page: str, name: str) -> str:
    """Return what a question is sealed by: the same each time."""
    return f"{page} {name}"


def feedback(translator: HTML5Translator, source: str, node: nodes.Element) -> str:
    """Return feedback as HTML; its formulas' glyphs are those of the page."""

    def mark(found: re.Match[str]) -> str:
        if tex := found["tex"]:
            return set_formula(translator, html.unescape(tex), node, display=False)
        if found["code"]:
            return f"<code>{found['code']}</code>"
        if found["stress"]:
            return f"<em>{found['stress']}</em>"
        return link(translator, html.unescape(found["label"]), found["words"], node)

    return MARKUP.sub(mark, html.escape(source, quote=False))


def link(translator: HTML5Translator, label: str, words: str, node: nodes.Element) -> str:
    """Return a link to a section of the book."""
    builder = translator.builder
    found = builder.env.domaindata["std"]["labels"].get(label)
    if found is None:
        logger.warning("undefined label in what a question says: %r", label, location=node)
        return words
    page, fragment = found[:2]
    here = builder.current_docname
    address = ("" if page == here else builder.get_relative_uri(here, page)) + f"#{fragment}"
    return f'<a href="{html.escape(address)}">{words}</a>'


def visit_question(translator: HTML5Translator, node: QuestionNode) -> None:
    """Begin a question."""
    identity = node["ids"][0]
    translator.body.append(
        f'<form class="dh-question" id="{identity}" novalidate autocomplete="off">'
        f"<fieldset><legend>Question {node['number']}</legend>\n"
    )


def depart_question(translator: HTML5Translator, node: QuestionNode) -> None:
    """Put down where to answer, and what is sealed."""
    question = node["question"]
    page = translator.builder.current_docname
    answers = [answer | {"says": feedback(translator, answer["says"], node)} for answer in question["answers"]]
    keys: Keys = translator.builder.app.keys  # type: ignore[attr-defined]
    sealed = seal(question | {"answers": answers}, seed(page, node["name"]), keys)
    translator.body.append(entries(translator, question, node) if question["kind"] == "number" else "")
    # Formulas within what is sealed need their glyphs: the page is told which, together with all that it uses.
    glyphs = " ".join(sorted(set(re.findall(r'href="#glyph-[^"]+"', "".join(answer["says"] for answer in answers)))))
    hint = feedback(translator, question["hint"], node)
    translator.body.append(
        '</fieldset><p class="dh-question-check"><button type="submit">Check</button>'
        '<output role="status" aria-live="polite"></output></p>'
        "<noscript><p>Answers are checked by JavaScript, which is off.</p></noscript>"
        f"<template>{hint}</template>"
        f"{f'<!-- {glyphs} -->' if glyphs else ''}"
        f'<script type="application/json">{json.dumps(sealed)}</script></form>\n'
    )
    keep_answer(translator, page, node, answers[0]["says"])


def entries(translator: HTML5Translator, question: dict[str, Any], node: nodes.Element) -> str:
    """Return the fields of a number, vector or matrix, and how many digits are asked for."""
    shape, unit, labels = question["shape"], question["unit"], question["labels"]
    rows, columns = (shape + [1, 1])[:2] if len(shape) != 1 else (1, shape[0])
    fields = []
    for row in range(rows):
        for column in range(columns):
            shown = feedback(translator, labels[column], node) if labels else ""
            spoken = re.sub(r"[$*`\\{}_]", "", labels[column]) if labels else _place(shape, row, column)
            own = next((u for u in ("rad", "°", "mm", "m") if labels and labels[column].rstrip("$").endswith(u)), unit)
            field = late_field(type="text", data_unit=own, aria_label=spoken)
            fields.append(f"<span>{shown} {field}</span>" if shown else field)
    digits = {0: "whole numbers", 1: "one decimal"}.get(question["decimals"], f"{question['decimals']} decimals")
    if len(fields) == 1 and question["decimals"] == 0:
        digits = "a whole number"
    asked = ", ".join(part for part in (unit and f"in {unit}", digits) if part)
    kind = "dh-entries" + (" dh-matrix" if len(shape) == 2 else "")
    return (
        f'<div class="dh-answer"><div class="{kind}" style="--columns: {columns}">{"".join(fields)}</div> '
        f'<span class="dh-asked">{asked}</span></div>'
    )


def late_field(**attributes: object) -> str:
    """Return the place of a field, with the attributes that the script of the page gives it.

    Of each field that stands in a page when it opens the browser asks whether it is seen, to fill it in, and so has
    what is far from the screen laid out.
    """
    given = json.dumps({name.replace("_", "-"): str(value) for name, value in attributes.items()})
    return f'<span class="dh-field {attributes["type"]}" data-field="{html.escape(given)}"></span>'


def _place(shape: list[int], row: int, column: int) -> str:
    return {0: "Answer", 1: f"Entry {column + 1}", 2: f"Row {row + 1}, column {column + 1}"}[len(shape)]


def visit_option(translator: HTML5Translator, node: OptionNode) -> None:
    """Begin an option."""
    kind = "checkbox" if node["several"] else "radio"
    translator.body.append(
        f'<label class="dh-option">{late_field(type=kind, name=node["name"], value=node["number"])} '
        f"<span>({letter(node['number'])}) "
    )


def letter(number: int) -> str:
    """Return the letter of an option."""
    return chr(96 + number)


def depart_option(translator: HTML5Translator, _node: OptionNode) -> None:
    """End an option."""
    translator.body.append("</span></label>\n")


def keep_answer(translator: HTML5Translator, page: str, node: QuestionNode, says: str) -> None:
    """Keep the answer in the clear, beside the site."""
    question = node["question"]
    value = question["answers"][0]["value"]
    if question["kind"] == "choice":
        shown = ", ".join(f"({letter(number)})" for number in value)
    else:
        columns = question["shape"][-1] if question["shape"] else 1
        numbers = [f"{entry:.{question['decimals']}f}".replace("-", "−") for entry in value]
        rows = [numbers[k : k + columns] for k in range(0, len(numbers), columns)]
        shown = "; ".join(", ".join(row) for row in rows) + (f" {question['unit']}" if question["unit"] else "")
    kept = {"id": node["ids"][0], "number": node["number"], "answer": shown, "says": says}
    translator.builder.app.answers.setdefault(page, []).append(kept)  # type: ignore[attr-defined]


def begin(app: Sphinx) -> None:
    """Know no answers yet, and the keys of earlier builds."""
    app.answers = {}  # type: ignore[attr-defined]
    app.keys = Keys(ROOT / "_build" / ".keys.json")  # type: ignore[attr-defined]


def add_script(
    app: Sphinx, page: str, _template: str, _context: dict[str, Any], _doctree: nodes.document | None
) -> None:
    """Give the script to pages with questions alone."""
    if app.env.metadata.get(page, {}).get("has_questions"):
        app.add_js_file("questions.js", loading_method="defer")


def finish(app: Sphinx, exception: Exception | None) -> None:
    """Bundle the script into the site, and keep the answers and keys beside it."""
    app.keys.save()  # type: ignore[attr-defined]
    if exception is not None or app.builder.format != "html":
        return
    if any(of_page.get("has_questions") for of_page in app.env.metadata.values()):
        bundle(Path(app.outdir) / "_static", ["web/questions"])
    for page, kept in app.answers.items():  # type: ignore[attr-defined]
        path = Path(app.outdir).parent / "answers" / f"{page}.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(kept), "utf-8")


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.add_directive("dh-question", QuestionDirective)
    app.add_node(QuestionNode, html=(visit_question, depart_question))
    app.add_node(OptionNode, html=(visit_option, depart_option))
    app.connect("builder-inited", begin)
    app.connect("html-page-context", add_script)
    app.connect("build-finished", finish)
    return {"parallel_read_safe": True, "parallel_write_safe": False}
