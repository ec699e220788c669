"""What feedback points to is there, under that heading."""

import re
from pathlib import Path

from dhlib.grading.sections import CHAPTERS

BOOK = Path(__file__).parents[2] / "book"


def test_every_section_is_in_the_book():
    for page, title, sections in CHAPTERS:
        text = (BOOK / f"{page}.md").read_text(encoding="utf-8")
        assert re.search(r"^# (.+)$", text, re.MULTILINE)[1] == title
        assert sections.items() <= dict(re.findall(r"^\(([\w-]+)\)=\n#+ (.+)$", text, re.MULTILINE)).items()
