"""Runs cells in the page as a notebook's kernel does: output by output, in the notebook format's own words."""

from __future__ import annotations

import ast
import builtins
import importlib
import io
import json
import linecache
import os
import sys
import traceback
import warnings
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from typing import Any

from IPython.lib.pretty import pretty

from dhlib import live

Output = dict[str, Any]
#: What a notebook shows of a value, beside its text.
FORMS = {
    "_repr_html_": "text/html",
    "_repr_svg_": "image/svg+xml",
    "_repr_markdown_": "text/markdown",
    "_repr_latex_": "text/latex",
}


class Stream:
    """Standard output or error of a cell."""

    def __init__(self, name: str, send: Callable[[Output], None]) -> None:
        self.name, self.send = name, send

    def write(self, text: str) -> int:
        """Send a text."""
        if text:
            self.send({"output_type": "stream", "name": self.name, "text": text})
        return len(text)

    def flush(self) -> None:
        """Nothing is kept back."""

    def isatty(self) -> bool:
        """It is no terminal."""
        return False


class Kernel:
    """One namespace, and the cells that run in it.

    Parameters
    ----------
    send : callable
        Takes an output as JSON.
    """

    def __init__(self, send: Callable[[str], None]) -> None:
        self.names: dict[str, Any] = {"__name__": "__main__", "__builtins__": __builtins__}
        self.post = send

    def send(self, output: Output) -> None:
        """Send an output of the cell that runs."""
        self.post(json.dumps(output))

    def run(self, source: str, name: str, figures: str = "{}") -> bool:
        """Run a cell; says whether it ended well.

        Parameters
        ----------
        source : str
        name : str
            What a traceback calls it.
        figures : str
            The states of the page's live figures as JSON, for `dhlib.live`.
        """
        live.page = live.Page(json.loads(figures), self.show_in_figure)
        file = f"<{name}>"
        linecache.cache[file] = (len(source), None, source.splitlines(keepends=True), file)
        with redirect_stdout(Stream("stdout", self.send)), redirect_stderr(Stream("stderr", self.send)):
            try:
                # Each cell warns anew, as in a notebook.
                with warnings.catch_warnings():
                    warnings.simplefilter("default")
                    self.execute(source, file)
                    self.show_plots()
            except BaseException as error:  # whatever a cell raises is its output
                self.send(told(error, file))
                return False
        return True

    def execute(self, source: str, file: str) -> None:
        """Run statements; the value of a last expression is shown, unless a semicolon ends it."""
        tree = ast.parse(source, file)
        last = tree.body[-1] if tree.body else None
        shown = isinstance(last, ast.Expr) and not source.split("#")[-1].rstrip().endswith(";")
        shown = shown and not source.rstrip().endswith(";")
        statements = tree.body[:-1] if shown else tree.body
        exec(compile(ast.Module(statements, []), file, "exec"), self.names)
        if shown and isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), file, "eval"), self.names)
            if value is not None:
                self.names["_"] = value
                self.send({"output_type": "execute_result", "data": forms(value), "metadata": {}})

    def show_in_figure(self, name: str, entries: dict[str, Any]) -> None:
        """Let a live figure of the page show something."""
        self.send({"output_type": "figure", "name": name, "entries": entries})

    def show_plots(self) -> None:
        """Show what matplotlib has drawn and not shown, as a notebook does."""
        if plots := sys.modules.get("matplotlib.pyplot"):
            for number in plots.get_fignums():
                written = io.StringIO()
                plots.figure(number).savefig(written, format="svg", bbox_inches="tight")
                self.display({"image/svg+xml": written.getvalue()}, {})
            plots.close("all")

    def call(self, module: str, name: str, values: str) -> str:
        """Call ``module.name(names, *values)`` for the page, with JSON in and out; what it prints is not shown."""
        with redirect_stdout(Stream("stdout", lambda _: None)), redirect_stderr(Stream("stderr", lambda _: None)):
            function = getattr(importlib.import_module(module), name)
            return json.dumps(function(self.names, *json.loads(values)))

    def display(self, data: dict[str, Any], metadata: dict[str, Any]) -> None:
        """Show something on its way."""
        self.send({"output_type": "display_data", "data": data, "metadata": metadata})


def forms(value: Any) -> dict[str, Any]:
    """Return a value in every form that it has."""
    data: dict[str, Any] = {}
    for method, mime in FORMS.items():
        write = getattr(type(value), method, None)
        text = write(value) if callable(write) else None
        if text is not None:
            data[mime] = text
    return data | {"text/plain": pretty(value, max_width=79, max_seq_length=1000)}


def told(error: BaseException, file: str) -> Output:
    """Return an error as an output: its name, its words, where, and the traceback without the kernel's own part."""
    name, words = type(error).__name__, str(error)
    own = getattr(error, "_render_traceback_", None)
    if own is not None:  # what it has to say is all
        return {"output_type": "error", "ename": name, "evalue": words, "traceback": list(own()), "line": None}
    frames = traceback.extract_tb(error.__traceback__)
    first = next((k for k, frame in enumerate(frames) if frame.filename == file), len(frames))
    line = next((frame.lineno for frame in reversed(frames) if frame.filename == file), None)
    if isinstance(error, SyntaxError) and error.filename == file:
        line, words = error.lineno, error.msg
    lines = ["Traceback (most recent call last):\n", *traceback.format_list(frames[first:])]
    lines += traceback.format_exception_only(error)
    return {"output_type": "error", "ename": name, "evalue": words, "traceback": lines, "line": line}


def start(send: Callable[[str], None], folder: str) -> Kernel:
    """Start the kernel of a page, in a folder; what is displayed goes to it."""
    from IPython import display

    os.makedirs(folder, exist_ok=True)
    os.chdir(folder)
    sys.path.insert(0, folder)
    kernel = Kernel(send)
    display.show = kernel.display
    builtins.display = display.display  # type: ignore[attr-defined]  # a name that needs no import, as in any notebook
    return kernel
