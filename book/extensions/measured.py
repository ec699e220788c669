"""The directive ``{dh-measured}``: what a workload of the bench measured last, as a section of the page.

    ```{dh-measured} forward
    ```

The numbers come from ``bench/results`` while the page is built. What was never measured leaves nothing, not even the
heading above it.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bookkit import inline_svg
from docutils import nodes
from docutils.statemachine import StringList
from sphinx.util.docutils import SphinxDirective

sys.path.append(str(Path(__file__).parents[2] / "bench"))

import charts
import report

if TYPE_CHECKING:
    from sphinx.application import Sphinx


#: Between a number and its unit.
UNIT = re.compile(r"(?<=\d) (?=[^\W\d]|[×%/])")


class NotMeasured(nodes.Invisible, nodes.Element):  # type: ignore[misc]
    """Stands where there is nothing to show, until the page has been read."""


class MeasuredDirective(SphinxDirective):
    """Show the tables and the pictures of one workload."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return a section for each table, or nothing."""
        name = self.arguments[0]
        bench = Path(self.env.srcdir) / "bench"
        for part in ("RESULTS.md", "report.py", "charts.py"):  # the report changes with every result
            self.env.note_dependency(str(bench / part))
        try:
            tables, where = report.tables(bench / "results", name)
        except KeyError:
            raise self.error(f"There is no workload {name!r}.") from None
        return (
            [NotMeasured()]
            if not tables
            else [self._section(f"measured-{name}-{k}", table, where) for k, table in enumerate(tables)]
        )

    def _section(self, identity: str, table: report.Table, where: str) -> nodes.section:
        section = nodes.section(ids=[identity], names=[identity])
        section += nodes.title(table.title, table.title)
        self._parse([table.says], section)
        if table.bars:
            svg = inline_svg(charts.chart(table), charts.words(table), identity)
            section += nodes.raw("", f'<figure class="dh-measured">{svg}</figure>', format="html")
        # On a phone the columns are narrow: a time breaks between numbers, not before its unit.
        self._parse((UNIT.sub("\N{NO-BREAK SPACE}", row) for row in report.markdown(table)), section)
        self._parse([f"- {line}" for line in report.sentences(table)], section)
        self._parse([f"*{where}*"], section)
        return section

    def _parse(self, lines: Any, into: nodes.Element) -> None:
        """Read Markdown as if it stood in the page."""
        self.state.nested_parse(StringList(list(lines), self.get_source_info()[0]), self.content_offset, into)


def leave_out(_app: Sphinx, doctree: nodes.document) -> None:
    """Take out what was not measured, and sections that are left with a title alone."""
    for nothing in list(doctree.findall(NotMeasured)):
        section = nothing.parent
        section.remove(nothing)
        if all(isinstance(child, nodes.title) for child in section.children):
            section.parent.remove(section)


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.add_directive("dh-measured", MeasuredDirective)
    app.connect("doctree-read", leave_out, priority=400)  # before the contents of the page are read
    return {"parallel_read_safe": True, "parallel_write_safe": True}
