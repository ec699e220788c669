"""Figures say what is true, every frame is lettered, and no letter stands on another or leaves the picture."""

from __future__ import annotations

import itertools
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from dhlib import Axis, Chain, DHError, Prismatic, Revolute, Ry, Rz, Tx, Ty, classic, modified, palette, robots
from dhlib.drawing import Arc, draw
from dhlib.labels import Label, place
from dhlib.scene import Scene, Sketch
from dhlib.sketch import conditions, link, pose, right_and_wrong, right_handed, sketch, steps, two_lines
from dhlib.view import VIEW, View

SVG = "{http://www.w3.org/2000/svg}"
GENERIC = (0.4, -0.5, 0.9, 0.3, 0.7, 0.2, -0.6)
ROBOTS = [getattr(robots, name) for name in robots.__all__]
#: How much of the smaller of two labels may lie under the other.
SHARED = 0.02


def arms() -> Iterator[pytest.param]:
    for make, convention, where in itertools.product(ROBOTS, ("classic", "modified"), ("zero", "generic")):
        chain = make(convention=convention)
        q = [0.0] * chain.n if where == "zero" else list(GENERIC[: chain.n])
        yield pytest.param(chain, q, id=f"{make.__name__}-{convention}-{where}")


every_arm = pytest.mark.parametrize(("chain", "q"), list(arms()))
one_link = {
    convention: Chain([Revolute(d=0.8, a=1.1, alpha=0.9)], convention) for convention in ("classic", "modified")
}


def ready_made() -> dict[str, Sketch]:
    lines = Axis([0, 0, 0], [0, 0, 1]), Axis([1, 0.3, 0.4], [0.1, 0.8, 1])
    return {
        "link": link(one_link["classic"], 1, [0.7], names=("i-1", "i")),
        "modified link": link(one_link["modified"], 1, [0.7], names=("i-1", "i")),
        "quickshot link": link(robots.quickshot(), 1, [0.5, 0, 0, 0]),
        "steps": steps(one_link["classic"], 1, [0.7]),
        "modified steps": steps(one_link["modified"], 1, [0.7], names=("i-1", "i")),
        "right-handed": right_handed(),
        "pose": pose(Tx(0.9) @ Ty(0.9) @ Rz(0.5) @ Ry(2.2)),
        "two lines": two_lines(*lines),
        "conditions": right_and_wrong(),
    }


READY_MADE = ready_made()
every_figure = pytest.mark.parametrize("drawing", READY_MADE.values(), ids=READY_MADE.keys())


def shared(one: Label, other: Label) -> float:
    """The part of the smaller label that lies under the other."""
    a, b = one.box, other.box
    width = min(a[2], b[2]) - max(a[0], b[0])
    height = min(a[3], b[3]) - max(a[1], b[1])
    smaller = min((box[2] - box[0]) * (box[3] - box[1]) for box in (a, b))
    return width * height / smaller if min(width, height) > 0 else 0.0


def colliding(drawing: Sketch) -> list[tuple[str, str]]:
    pairs = itertools.combinations(drawing.labels, 2)
    return [(one.text, other.text) for one, other in pairs if shared(one, other) > SHARED]


def outside(drawing: Sketch) -> list[str]:
    def leaves(label: Label) -> bool:
        left, top, right, bottom = label.box
        return left < 0 or top < 0 or right > drawing.width or bottom > drawing.height

    return [label.text for label in drawing.labels if leaves(label)]


# What is drawn, in space


@every_arm
def test_lengths_lead_from_frame_to_frame(chain: Chain, q: list[float]) -> None:
    figure, frames = draw(chain, q), chain.frames(q)
    tolerance = 1e-12 * max(1.0, figure.size)
    for i, (joint, value) in enumerate(zip(chain.joints, q, strict=True), 1):
        offset, normal = figure.offsets[i - 1], figure.normals[i - 1]
        first, second = (offset, normal) if chain.convention == "classic" else (normal, offset)
        assert np.allclose(first.start, frames[i - 1, :3, 3], atol=tolerance)
        assert np.allclose(first.end, second.start, atol=tolerance)
        assert np.allclose(second.end, frames[i, :3, 3], atol=tolerance)
        assert normal.length == pytest.approx(abs(joint.a), abs=tolerance)
        assert offset.length == pytest.approx(abs(joint.at(value)[1]), abs=tolerance)


@every_arm
def test_angles_turn_one_axis_onto_the_next(chain: Chain, q: list[float]) -> None:
    figure, frames = draw(chain, q), chain.frames(q)
    for i in range(1, chain.n + 1):
        for arc, column in ((figure.angles[i - 1], 0), (figure.twists[i - 1], 2)):
            assert np.allclose(arc.start, frames[i - 1, :3, column], atol=1e-12)
            assert np.allclose(arc.points(1.0)[-1] - arc.centre, frames[i, :3, column], atol=1e-12)


@every_arm
def test_joints_stand_on_their_axes_and_apart(chain: Chain, q: list[float]) -> None:
    figure = draw(chain, q)
    if not np.any(q):
        for joint, axis in zip(figure.joints, chain.axes(), strict=True):
            assert np.linalg.norm(np.cross(joint.centre - axis.point, axis.direction)) < 1e-9 * figure.size
            assert abs(joint.axis @ axis.direction) == pytest.approx(1)
    for one, other in itertools.combinations(figure.joints, 2):
        assert np.linalg.norm(one.centre - other.centre) > 0.05 * figure.size


@every_arm
def test_the_arm_reaches_its_tool(chain: Chain, q: list[float]) -> None:
    figure = draw(chain, q)
    assert np.allclose(figure.links[0][0], figure.frames[0].origin)
    assert np.allclose(figure.links[-1][1], chain.fk(q)[:3, 3], atol=1e-9 * figure.size)
    for one, other in itertools.pairwise(figure.links):
        assert np.allclose(one[1], other[0], atol=1e-8 * figure.size)


def test_a_wrong_length_would_be_found() -> None:
    figure, frames = draw(robots.quickshot(), [0.1] * 4), robots.quickshot().frames([0.2] * 4)
    assert not np.allclose(figure.normals[1].end, frames[2, :3, 3])


def test_an_arm_without_lengths_can_be_drawn() -> None:
    figure = draw(Chain([Revolute(), Revolute(alpha=1)], "classic"), [0, 0])
    assert figure.size == 1
    assert not figure.links
    assert not outside(sketch(Chain([Revolute(), Revolute(alpha=1)], "classic"), [0, 0]))


def test_a_drawing_needs_one_joint_vector_of_numbers() -> None:
    import sympy

    with pytest.raises(DHError, match="symbols"):
        draw(robots.planar(2), sympy.symbols("q1 q2"))
    with pytest.raises(DHError, match="one joint vector"):
        draw(robots.planar(2), np.zeros((3, 2)))
    with pytest.raises(DHError, match="2 joints"):
        draw(robots.planar(2), [0, 0, 0])


def test_an_arc_keeps_its_radius() -> None:
    arc = Arc(np.array([1.0, 2, 3]), np.array([0, 0, 1.0]), np.array([1.0, 0, 0]), -2.0)
    assert np.allclose(np.linalg.norm(arc.points(0.5) - arc.centre, axis=1), 0.5)


# What is seen


@every_arm
def test_every_frame_is_lettered(chain: Chain, q: list[float]) -> None:
    words = [word for label in sketch(chain, q).labels for word in label.text.split(", ")]
    expected = [f"{letter}_{i}" for letter in "xz" for i in range(chain.n + 1)]
    assert sorted(word for word in words if word[0] in "xyz") == sorted(expected)


@every_arm
def test_every_length_is_lettered(chain: Chain, q: list[float]) -> None:
    words = [label.text for label in sketch(chain, q).labels]
    first = 0 if chain.convention == "modified" else 1
    expected = [f"a_{i}" for i, joint in enumerate(chain.joints, first) if joint.a]
    for i, (joint, value) in enumerate(zip(chain.joints, q, strict=True), 1):
        if joint.at(value)[1]:
            expected.append(f"d_{i}")
    assert sorted(word for word in words if word[0] in "ad") == sorted(expected)


@every_arm
def test_labels_stand_free(chain: Chain, q: list[float]) -> None:
    drawing = sketch(chain, q)
    assert not colliding(drawing)
    assert not outside(drawing)


@every_figure
def test_labels_of_ready_made_figures_stand_free(drawing: Sketch) -> None:
    assert not colliding(drawing)
    assert not outside(drawing)


def test_labels_that_collide_or_leave_would_be_found() -> None:
    drawing = sketch(robots.puma560(), [0] * 6)
    drawing.labels[1].centre = drawing.labels[0].centre + 1
    drawing.labels[2].centre = np.array([drawing.width, 10.0])
    assert (drawing.labels[0].text, drawing.labels[1].text) in colliding(drawing)
    assert drawing.labels[2].text in outside(drawing)


def test_a_label_avoids_a_line() -> None:
    tip = np.zeros(2)
    label = Label("x", "", [(tip, np.array([1.0, 0]), 0.0), (tip, np.array([-1.0, 0]), 1.0)])
    free = np.zeros((0, 5))
    place([label], free, (-50, -50, 50, 50))
    assert label.centre[0] > 0
    place([label], np.array([[12.0, -20, 12, 20, 1]]), (-50, -50, 50, 50))
    assert label.centre[0] < 0


def test_coincident_axes_of_one_letter_share_an_arrow_and_of_two_stand_side_by_side() -> None:
    alike, unlike = Scene(), Scene()
    for scene, turn in ((alike, Rz(0)), (unlike, Ry(np.pi / 2))):
        scene.add_frame(np.eye(4), "0", axes="z")
        scene.add_frame(turn, "1", axes="z" if scene is alike else "x")
    assert [label.text for label in alike.sketch().labels] == ["z_0, z_1"]
    other = Scene()
    other.add_frame(np.eye(4), "0", axes="x")
    other.add_frame(Ry(np.pi / 2), "1", axes="z")
    starts = re.findall(r'<path class="[xz]" d="M([\d.]+) ([\d.]+)L', other.svg())
    (x0, y0), (x1, y1) = ((float(x), float(y)) for x, y in starts)
    assert 2 < np.hypot(x1 - x0, y1 - y0) < 5


def test_an_axis_that_is_seen_end_on_is_a_ring() -> None:
    scene = Scene()
    scene.add_frame(np.eye(4), "0")
    assert 'class="ring"' in scene.svg(view=(0, 0))
    assert 'class="ring"' not in scene.svg()
    assert 'class="z' in scene.svg(view=(0, 90))


def test_the_ring_holds_a_dot_towards_the_reader_and_a_cross_away_from_the_reader() -> None:
    scene = Scene()
    scene.add_frame(np.eye(4), "0")
    towards, away = (scene.svg(view=view).split('class="ring"')[1].split("</g>")[0] for view in ((0, 0), (180, 0)))
    assert (towards.count("<circle"), towards.count("<path")) == (1, 0)
    assert (away.count("<circle"), away.count("<path")) == (0, 1)


def test_a_length_along_the_line_of_sight_is_lettered_beside_its_end() -> None:
    scene = Scene()
    scene.add_segment([0, -1, 0], [0, 1, 0], kind="line")
    scene.add_segment([0, 0, 0], [1, 0, 0], "d")
    drawing = scene.sketch(view=(0, 0))
    (label,) = drawing.labels
    assert label.text == "d"
    assert not outside(drawing)
    assert abs(label.centre[0] - drawing.width / 2) < 40


def test_an_angle_without_a_symbol_is_an_arc_alone() -> None:
    named, bare = Scene(), Scene()
    for scene, label in ((named, "θ"), (bare, "")):
        scene.add_arc([0, 0, 0], [0, 0, 1], [1, 0, 0], 1.0, label)
    assert [label.text for label in named.sketch().labels] == ["θ"]
    assert not bare.sketch().labels
    assert bare.svg().count('class="ar"') == named.svg().count('class="ar"') == 1


def test_a_scene_without_directions_is_seen_as_usual() -> None:
    scene = Scene()
    scene.add_point([0, 0, 0], "P")
    assert scene.best_view() == VIEW


def test_the_usual_view_hides_no_axis_of_the_world() -> None:
    seen = View(*VIEW).project(np.eye(3))
    assert np.hypot(seen[:, 0], seen[:, 1]).min() > 0.6
    assert seen[2, 1] < 0  # z is up
    assert seen[0, 0] > 0  # x to the right


def test_a_chosen_view_shows_every_direction() -> None:
    frames = np.eye(4), classic(0.7, 0.8, 1.1, 0.9)
    scene = Scene()
    for frame in frames:
        scene.add_frame(frame)
    seen = View(*scene.best_view()).project(np.concatenate([frame[:3, :3].T for frame in frames]))
    assert np.hypot(seen[:, 0], seen[:, 1]).min() > 0.3


def test_frame_before_is_dashed_and_frame_after_is_not() -> None:
    body = link(one_link["classic"], 1, [0.7]).body
    assert len(re.findall(r'class="[xyz] da"', body)) == 3
    assert len(re.findall(r'<path class="[xyz]" ', body)) == 3


def test_prismatic_joints_are_blocks() -> None:
    turning, sliding = (
        sketch(Chain([kind(a=1.0)], "classic"), [0.0], show=("joints",)).body for kind in (Revolute, Prismatic)
    )
    assert "A" in turning
    assert "A" not in sliding


def test_conditions_are_judged() -> None:
    good = classic(0.5, 1, 1, 0.7)
    told = [
        conditions(np.eye(4), after).alt
        for after in (good, Rz(0.5) @ Ry(0.4) @ Tx(1), Rz(0.5) @ Ty(0.4) @ Tx(1), good @ Ry(0.3))
    ]
    verdicts = [tuple(re.findall("DH[12] (holds|fails)", alt)) for alt in told]
    assert verdicts == [("holds", "holds"), ("fails", "holds"), ("holds", "fails"), ("fails", "fails")]
    assert "DH1 fails" not in conditions(np.eye(4), modified(0.7, 1, 0.5, 1), "modified").alt
    assert "x_i-1" in conditions(np.eye(4), modified(0.7, 1, 0.5, 1), "modified").alt


def test_conditions_at_their_worst_can_be_drawn() -> None:
    along = Ry(-np.pi / 2) @ Tx(1)  # x_i runs along z_{i-1}
    assert "DH1 fails" in conditions(np.eye(4), along).alt
    assert "DH1 holds" in conditions(np.eye(4), np.eye(4)).alt


@pytest.mark.parametrize(
    ("other", "word"),
    [
        (Axis([1, 0, 0], [0, 1, 0]), "do not meet"),
        (Axis([0, 0, 2], [0, 1, 1]), "meet: a is 0"),
        (Axis([2, 0, 1], [0, 0, 1]), "parallel"),
        (Axis([2, 0, 1], [0, 0, -1]), "opposite"),
        (Axis([0, 0, 1], [0, 0, 1]), "coincide"),
    ],
)
def test_two_lines_however_they_lie(other: Axis, word: str) -> None:
    drawing = two_lines(Axis([0, 0, 0], [0, 0, 1]), other)
    assert word in drawing.alt
    assert not outside(drawing)


def test_a_length_or_an_angle_of_zero_is_not_drawn() -> None:
    pillar = Chain([Revolute(d=0.8, alpha=0.9)], "classic")
    said = {label.text for label in link(pillar, 1, [0.7]).labels}
    assert {"d_1", "θ_1", "α_1"} <= said
    assert "a_1" not in said
    arm = Chain([Revolute(d=0.8, a=1.1)], "classic")
    words = [label.text for label in steps(arm, 1, [0.7]).labels]
    assert {"θ_1", "d_1", "a_1"} <= set(words)
    assert "α_1" not in words


def test_steps_end_in_the_link() -> None:
    for convention, order in (("classic", "RTTR"), ("modified", "RTRT")):
        drawing = steps(one_link[convention], 1, [0.7])
        assert "".join(label.text[0] for label in drawing.labels if "(" in label.text) == order
        assert {"x_0", "x′", "x″", "x‴", "x_1"} <= {
            word.replace("′′′", "‴").replace("′′", "″") for label in drawing.labels for word in label.text.split(", ")
        }


@pytest.mark.parametrize(
    ("part", "words"),
    [
        ("links", set()),
        ("joints", set()),
        ("frames", {f"{letter}_{i}" for letter in "xz" for i in range(5)}),
        ("lengths", {"d_1", "a_1", "a_2", "d_3", "d_4"}),
        ("axes", {"1", "2", "3", "4"}),
        ("angles", {"θ_1", "θ_2", "θ_3", "θ_4", "α_1", "α_3"}),
    ],
)
def test_each_part_of_a_figure_can_stand_alone(part: str, words: set[str]) -> None:
    drawing = sketch(robots.quickshot(), [0.3] * 4, show=(part,))
    assert {label.text for label in drawing.labels} == words
    assert drawing.body != sketch(robots.quickshot(), [0.3] * 4, show=()).body


def test_misuse_is_explained() -> None:
    arm = robots.quickshot()
    with pytest.raises(DHError, match="'bones'"):
        sketch(arm, [0] * 4, show=("bones",))
    with pytest.raises(DHError, match="axes='w'"):
        sketch(arm, [0] * 4, axes="w")
    with pytest.raises(DHError, match="no link 5"):
        link(arm, 5, [0] * 4)
    with pytest.raises(DHError, match="theme='blue'"):
        sketch(arm, [0] * 4).svg("blue")
    with pytest.raises(DHError, match="three finite numbers"):
        Scene().add_point([0, np.nan, 0])
    with pytest.raises(DHError, match="kind='thick'"):
        Scene().add_segment([0, 0, 0], [1, 0, 0], kind="thick")
    with pytest.raises(DHError, match="point somewhere"):
        Scene().add_line([0, 0, 0], [0, 0, 0])


# What is written


def is_accessible(svg: str) -> bool:
    root = ET.fromstring(svg)
    told = [root.findtext(f"{SVG}{name}", "").strip() for name in ("title", "desc")]
    return root.tag == f"{SVG}svg" and root.get("role") == "img" and all(told)


@every_arm
def test_an_arm_is_small_accessible_and_the_same_on_every_run(chain: Chain, q: list[float]) -> None:
    svg = sketch(chain, q).svg()
    assert is_accessible(svg)
    assert len(svg.encode()) < 15_000
    assert sketch(chain, q).svg() == svg
    assert not re.search(r"nan|inf|[ M L]-0[ L\"]", svg.split("</style>")[1])


@every_figure
def test_ready_made_figures_are_small_and_accessible(drawing: Sketch) -> None:
    assert is_accessible(drawing.svg())
    assert len(drawing.svg().encode()) < 15_000


def test_a_figure_without_description_would_be_found() -> None:
    scene = Scene()
    scene.add_frame(np.eye(4))
    assert not is_accessible(scene.svg())
    assert is_accessible(scene.svg(title="A frame", alt="Three axes."))


def test_figures_are_the_same_in_another_process() -> None:
    code = "from dhlib import robots; from dhlib.sketch import sketch; print(sketch(robots.puma560(), [0.1] * 6))"
    runs = {
        subprocess.run(
            [sys.executable, "-c", code], env={"PYTHONHASHSEED": seed}, cwd=Path(__file__).parents[2],
            capture_output=True, text=True, check=True,
        ).stdout
        for seed in ("1", "2")
    }  # fmt: skip
    assert runs == {sketch(robots.puma560(), [0.1] * 6).svg() + "\n"}


def test_what_is_said_is_escaped() -> None:
    svg = sketch(Chain([Revolute(a=1)], "classic", name="a < b & c"), [0]).svg()
    assert ET.fromstring(svg).findtext(f"{SVG}title") == "a < b & c"


def test_the_page_gives_the_colours_and_a_theme_its_own() -> None:
    drawing = sketch(robots.quickshot(), [0] * 4)
    assert "var(--dh-x," in drawing.svg()
    for theme, values in (("light", palette.LIGHT), ("dark", palette.DARK)):
        svg = drawing.svg(theme)
        assert "var(" not in svg
        assert values["x"] in svg
        assert values["ground"] in svg


def test_colours_are_those_of_the_style_sheet(root: Path) -> None:
    light, dark, *_ = (root / "book/style/colours.css").read_text("utf-8").split("}")
    for values, block in ((palette.LIGHT, light), (palette.DARK, dark)):
        assert values == dict(re.findall(r"--dh-([a-z]+): (#[0-9a-f]{6});", block))


def test_colours_without_a_style_sheet_can_be_read() -> None:
    def luminance(colour: np.ndarray) -> float:
        linear = np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)
        return float(linear @ [0.2126, 0.7152, 0.0722])

    def channels(colour: str) -> np.ndarray:
        return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255

    for theme in (palette.LIGHT, palette.DARK):
        for between in palette.BETWEEN.values():
            seen = 0.72 * channels(between) + 0.28 * channels(theme["ink"])
            low, high = sorted((luminance(seen), luminance(channels(theme["ground"]))))
            assert (high + 0.05) / (low + 0.05) >= 4.5


def test_a_drawing_can_be_saved(tmp_path: Path) -> None:
    drawing = sketch(robots.quickshot(), [0] * 4)
    drawing.save(tmp_path / "arm.svg", "dark")
    assert (tmp_path / "arm.svg").read_text("utf-8") == drawing.svg("dark")


def test_a_drawing_shows_itself() -> None:
    drawing = right_handed()
    assert drawing._repr_html_() == drawing._repr_svg_() == str(drawing) == drawing.svg()


def test_dhlib_does_not_import_what_it_may_not_need() -> None:
    heavy = "('matplotlib', 'sympy', 'dhlib.sketch', 'dhlib.plot')"
    code = f"import sys, dhlib; print([name for name in {heavy} if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
    code = "import sys, dhlib.sketch; print('matplotlib' in sys.modules, 'sympy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False False\n"
