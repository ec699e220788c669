"""The figure of each exercise: it says what to see, gives nothing away, and fits everybody's numbers."""

import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from dhlib import robots
from dhlib.errors import DHError
from dhlib.grading.course.assign import Assigning
from dhlib.grading.course.papers import load_paper
from dhlib.grading.course.variants import Variants
from dhlib.grading.forms import Frames
from dhlib.grading.pictures import FIGURE, as_cell, described, read_cell
from dhlib.scene import Scene
from dhlib.sketch import sketch

ROOT = Path(__file__).parents[2]
KEY = bytes(range(32))
FOLDERS = ("solutions", "exercises")
#: Drawn with the angles of each student; the others are drawn once.
OWN = {"axes_to_table", "convert"}
#: Frames that are shown because nobody has to place them: those of one step, and of one link in general.
GENERAL = {"transforms": {"′"}, "one_link": {"_i", "_{i-1}"}}


def figure_of(notebook):
    (cell,) = (cell for cell in notebook["cells"] if cell["metadata"]["dh"].get("part") == FIGURE)
    assert (cell["cell_type"], cell["metadata"]["dh"]["role"]) == ("markdown", "given")
    return "".join(cell["source"])


def frames_shown(drawing):
    """What the axes of frames in a drawing are called, without their letters."""
    names = [name for label in drawing.labels for name in label.text.split(", ")]
    return {name[1:] for name in names if re.fullmatch(r"[xyz](_.+|′+)", name)}


def numbers_shown(drawing):
    """Numbers that a drawing states: what is neither an index nor the number of an axis."""
    texts = [re.sub(r"_\w+|_\{[^}]*\}|ax[ei]s [\di, +-]+|\b[a-z]\d\b", "", label.text) for label in drawing.labels]
    return [text for text in texts if re.search(r"\d", text)]


@pytest.fixture(scope="module")
def variants(name):
    return Variants(name, ROOT / "exercises")


def test_every_edition_has_the_figure_with_its_words(name):
    sources = {figure_of(json.loads((ROOT / folder / f"{name}.ipynb").read_text("utf-8"))) for folder in FOLDERS}
    assert len(sources) == 1
    svg, alt, caption = read_cell(sources.pop())
    drawing = ET.fromstring(svg)
    assert drawing.tag.endswith("}svg")
    assert alt == drawing.findtext("{http://www.w3.org/2000/svg}desc")
    assert len(alt.split()) > 20
    assert alt.endswith(".")
    assert 3 < len(caption.split()) < 25
    assert caption not in alt


def test_no_frame_is_shown_that_is_asked_for(name, variants):
    drawing = variants.of().figure()
    assert frames_shown(drawing) - {"_0"} == GENERAL.get(name, set())
    if any(isinstance(part.asks, Frames) for part in variants.of().exercise.parts):
        assert name not in GENERAL


def test_a_frame_that_is_asked_for_would_be_seen():
    """Negative control: an arm with all of its frames."""
    arm = robots.stanford("classic")
    assert frames_shown(sketch(arm, np.zeros(6))) == {f"_{i}" for i in range(7)}
    assert frames_shown(described(arm, "An arm", "An arm.")) == {"_0"}


def test_the_figure_fits_everybodys_numbers(name, variants):
    drawn = [variants.of(KEY, f"student {k}").figure() for k in range(8)]
    different = len({as_cell(drawing) for drawing in drawn})
    assert different > 1 if name in OWN else different == 1
    for drawing in drawn:
        assert numbers_shown(drawing) == []
        assert name in GENERAL or "not to scale" in drawing.title


def test_a_number_in_a_figure_would_be_seen():
    scene = Scene()
    scene.add_segment([0, 0, 0], [1, 0, 0], "160 mm")
    scene.add_segment([0, 0, 0], [0, 1, 0], "d1")
    scene.add_frame(np.eye(4), "0")
    assert numbers_shown(scene.sketch("A scene", "A scene.")) == ["160 mm"]


@pytest.mark.parametrize("student", ["s1", "s2", "s3"])
def test_the_axes_of_a_student_point_where_the_page_has_them(student):
    """By another way: the directions of the page, as somebody sees them who stands where the figure is seen from."""
    variant = Variants("axes_to_table", ROOT / "exercises").of(KEY, student)
    names = {"np": np}
    exec(variant.given["axes"], names)
    azimuth, elevation = np.deg2rad([-60, 22])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0])
    up = np.array([-np.sin(elevation) * np.cos(azimuth), -np.sin(elevation) * np.sin(azimuth), np.cos(elevation)])
    flat = np.array([along for _, along in names["axes"]]) @ np.array([right, -up]).T
    lines = re.findall(r'class="muted ax" d="M(\S+) (\S+)L(\S+) (\S+)"', variant.figure().body)
    seen = np.array(lines, dtype=float)
    seen = seen[:, 2:] - seen[:, :2]
    scale = np.linalg.norm(seen[0]) / np.linalg.norm(flat[0])
    assert seen.shape == (5, 2)
    assert np.abs(seen - scale * flat).max() < 0.3
    assert np.abs(seen - scale * flat[::-1]).max() > 10  # negative control


def test_an_assigned_notebook_has_the_figure_of_its_numbers(name):
    notebook = Assigning(name, KEY, ROOT / "exercises").notebook("s1")
    assert figure_of(notebook) == as_cell(Variants(name, ROOT / "exercises").of(KEY, "s1").figure())


def test_graders_draw_nothing(monkeypatch):
    def drawn(*_):
        raise AssertionError

    monkeypatch.setattr("dhlib.scene.Scene.sketch", drawn)
    assert load_paper("axes_to_table", ROOT / "exercises", KEY, "s1").exercise.points


def test_a_figure_without_words_is_refused():
    scene = Scene()
    for title, alt in (("", "An arm."), ("An arm", " ")):
        with pytest.raises(DHError, match="alt text"):
            as_cell(scene.sketch(title, alt))
    with pytest.raises(DHError, match="run make exercises"):
        read_cell("![An arm](arm.svg)")
    with pytest.raises(DHError, match="no length d_9"):
        described(robots.quickshot(), "An arm", "An arm.", lengths={"d_9": "far"})


def test_what_is_in_quotes_and_brackets_comes_back():
    told = 'The "arm" <of> {0} & its [axes]'
    assert read_cell(as_cell(Scene().sketch("Caption", told)))[1:] == (told, "Caption")


def test_the_metal_of_an_arm_can_be_left_out():
    arm = robots.quickshot()
    drawn = {
        show: described(arm, "An arm", "An arm.", lengths={"a_2": "upper_arm"}, show=show)
        for show in (("links", "joints"), ("links",), ("joints",), ())
    }
    assert len({tuple(label.text for label in drawing.labels) for drawing in drawn.values()}) == 1
    joints = [drawing.body.count('class="jo"') for drawing in drawn.values()]
    assert joints == [4, 0, 4, 0]
    pieces = [drawing.body.count('class="body b"') for drawing in drawn.values()]
    assert pieces[0] > pieces[2]
    assert pieces[1] > pieces[3] == 0
