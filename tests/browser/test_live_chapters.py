"""Every cell of every chapter, run in its page: it shows what the build shows.

Each page needs a Python of its own, so a seeded sample of chapters is run; ``FULL=1`` runs all.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from content_key import content_key
from jupyter_cache import get_cache
from live import needs_numpy
from sampling import some

pytestmark = [pytest.mark.book, pytest.mark.browser]

ROOT = Path(__file__).parents[2]
CHAPTERS = sorted(
    path.stem
    for path in (ROOT / "book").glob("*.md")
    if len(re.findall(r"^```\{code-cell\}", path.read_text("utf-8"), re.M)) > 1
)
CHOSEN = some(CHAPTERS, 2)
FIVE_MINUTES = 300_000
TOLERANCE = 1e-6
NUMBER = re.compile(r"-?(?:\d+\.\d*|\.\d+|\d+)(?:e[-+]?\d+)?")

#: Cells whose output may differ from that of the build: chapter, words of the cell, and why.
MAY_DIFFER: list[tuple[str, str, str]] = []

#: Cells that draw with matplotlib are left out: they would fetch it from another host.
RUN_ALL = """async () => {
    const told = [];
    for (const item of DhCells.items) if (item.about?.mpl) item.ran = item.text;
    for (const cell of DhCells.cells) {
        if (cell.about.mpl) { told.push({source: cell.text, mpl: true}); continue; }
        if (cell.about.elsewhere) { told.push({source: cell.text, elsewhere: cell.about.elsewhere}); continue; }
        await cell.start();
        told.push({source: cell.text, outputs: cell.outputs?.list ?? [], status: cell.status.textContent});
    }
    return told;
}"""


def shown(outputs: list[Any]) -> list[tuple[str, str]]:
    """Return what outputs show, as kind and text; streams joined, and nothing of what is kept for the text."""
    found: list[tuple[str, str]] = []
    for output in outputs:
        kind = output["output_type"]
        if kind == "stream":
            if found and found[-1][0] == output["name"]:
                found[-1] = (output["name"], found[-1][1] + output["text"])
            else:
                found.append((output["name"], output["text"]))
        elif kind == "error":
            found.append((kind, f"{output['ename']}: {output['evalue']}"))
        elif "scrapbook" not in output.get("metadata", {}):
            found += sorted((mime, "".join(text)) for mime, text in output["data"].items())
    return found


def difference(one: str, other: str) -> str:
    """Return in what two texts differ, beyond rounding and white space; ``""`` if in nothing."""
    words, others = NUMBER.sub("#", one).split(), NUMBER.sub("#", other).split()
    if "".join(words) != "".join(others):
        return f"{one!r} against {other!r}"
    for number, another in zip(NUMBER.findall(one), NUMBER.findall(other), strict=True):
        if abs(float(number) - float(another)) > TOLERANCE * max(1, abs(float(another))):
            return f"{number} against {another} in {other!r}"
    return ""


def differences(here: list[Any], built: list[Any]) -> list[str]:
    """Return in what the outputs of a cell differ from those of the build."""
    mine, theirs = shown(here), shown(built)
    if [kind for kind, _ in mine] != [kind for kind, _ in theirs]:
        return [f"shows {mine} against {theirs}"]
    return [said for (_, one), (_, other) in zip(mine, theirs, strict=True) if (said := difference(one, other))]


def executed(chapter: str) -> Any:
    """Return a chapter's notebook as the build has executed it."""
    cache = get_cache(str(ROOT / "_build" / ".jupyter_cache" / content_key(ROOT)))
    records = [record for record in cache.list_cache_records() if Path(record.uri).stem == chapter]
    latest = max(records, key=lambda record: record.created)
    return cache.get_cache_bundle(latest.pk).nb


@pytest.mark.parametrize("chapter", CHOSEN)
def test_cells_show_what_the_build_shows(browser: Any, site: Path, address: str, chapter: str) -> None:
    needs_numpy(site)
    page = browser.new_page()
    page.set_default_timeout(FIVE_MINUTES)
    page.goto(f"{address}/book/{chapter}.html")
    ran = page.evaluate(RUN_ALL) if page.evaluate("typeof DhCells") == "object" else []
    page.close()
    built = [
        cell
        for cell in executed(chapter).cells
        if cell.cell_type == "code" and not {"remove-cell", "remove-input"} & set(cell.metadata.get("tags", []))
    ]
    assert [cell["source"].strip() for cell in ran] == [cell.source.strip() for cell in built]
    faults = []
    skipped = {"mpl": 0, "elsewhere": 0}
    for here, cell in zip(ran, built, strict=True):
        if why := skipped.keys() & here.keys():
            skipped[why.pop()] += 1
            continue
        excused = any(chapter == name and words in cell.source for name, words, _ in MAY_DIFFER)
        found = differences(here["outputs"], cell.outputs)
        if not here["status"].startswith("Done"):
            found.append(here["status"])
        if bool(found) != excused:
            faults.append(f"{cell.source}\n→ {found or 'no longer differs'}")
        assert "mpl" not in cell.metadata.get("tags", [])
    missing = {cell["elsewhere"] for cell in ran if "elsewhere" in cell}
    print(f"{chapter}: {skipped['mpl']} of {len(ran)} cells draw with matplotlib and were skipped")
    if missing:
        print(f"{chapter}: {skipped['elsewhere']} cells cannot run in a page, for want of {', '.join(missing)}")
    assert not faults, "\n\n".join(faults)


def test_a_difference_would_be_found() -> None:
    output = {"output_type": "execute_result", "metadata": {}, "data": {"text/plain": "array([1. , 0.4318])"}}

    def with_text(text: str) -> list[Any]:
        return [json.loads(json.dumps(output)) | {"data": {"text/plain": text}}]

    assert not differences(with_text("array([1., 0.43180000001])"), [output])
    assert differences(with_text("array([1., 0.4319])"), [output])
    assert differences(with_text("matrix([1., 0.4318])"), [output])
    assert differences([], [output])
    assert differences([{"output_type": "stream", "name": "stderr", "text": "!"}], [])
