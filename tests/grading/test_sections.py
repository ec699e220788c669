"""What feedback points to is there, under that heading."""

import re
from pathlib import Path

from dhlib.grading.sections import CHAPTERS

BOOK = Path(__file__).parents[2] / "book"


def test_every_section_is_in_the_book():
    chapters = {}
    for page in BOOK.rglob("*.md"):
        text = page.read_text(encoding="utf-8")
        if title := re.search(r"^# (.+)$", text, re.MULTILINE):
            chapters[title[1]] = dict(re.findall(r"^\(([\w-]+)\)=\n#+ (.+)$", text, re.MULTILINE))
    for title, sections in CHAPTERS.items():
        assert title in chapters
        assert sections.items() <= chapters[title].items()
