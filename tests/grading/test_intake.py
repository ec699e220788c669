"""What was handed in is found, and its place says whose it is: downloads of platforms, folders, archives, clones."""

import io
import os
import stat
import sys
import zipfile
from types import SimpleNamespace

import pytest

from dhlib.errors import DHError
from dhlib.grading.batch import archives
from dhlib.grading.batch.intake import collect
from dhlib.grading.batch.rows import Certainty
from dhlib.grading.batch.trees import Reader

EXERCISES = ["quickshot", "one_link"]
NOTEBOOK = b'{"cells": [{"cell_type": "code", "source": "x = 1"}]}'


@pytest.fixture
def class_(tmp_path):
    """``class_(names)``: a folder with such files, each of which holds its own name."""

    def made(*names, root="class"):
        folder = tmp_path / root
        for name in names:
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(name, "utf-8")
        return folder

    return made


def packed(names, path=None):
    """A ZIP file; names to contents."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in names.items():
            archive.writestr(name, content)
    if path is None:
        return stream.getvalue()
    path.write_bytes(stream.getvalue())
    return path


def who(*sources, **options):
    return {h.source: h.origin.student for h in collect(sources, EXERCISES, **options).found}


def sentences(intake):
    return {problem.source: problem.what for problem in intake.problems}


def test_folders_are_called_like_students(class_):
    folder = class_("Müller, Ada/quickshot.ipynb", "bob/deep/down/quickshot.ipynb")
    assert who(folder) == {"Müller, Ada/quickshot.ipynb": "Müller, Ada", "bob/deep/down/quickshot.ipynb": "bob"}


def test_files_are_called_like_students_unless_like_the_exercise(class_):
    folder = class_("ada.ipynb", "quickshot_bob.ipynb", "carl-one_link.ipynb", "quickshot (2).ipynb", "Quickshot.ipynb")
    found = {h.source: (h.origin.student, h.origin.certainty) for h in collect([folder], EXERCISES).found}
    assert found == {
        "ada.ipynb": ("ada", Certainty.FILE_NAME),
        "quickshot_bob.ipynb": ("bob", Certainty.FILE_NAME),
        "carl-one_link.ipynb": ("carl", Certainty.FILE_NAME),
        "quickshot (2).ipynb": ("", Certainty.NOBODY),
        "Quickshot.ipynb": ("", Certainty.NOBODY),
    }


MOODLE = [
    "Ada Lovelace_1815_assignsubmission_file_/quickshot.ipynb",
    "Ada Lovelace_1815_assignsubmission_onlinetext_/onlinetext.html",
    "Müller, Bob_42_assignsubmission_file_/part/quickshot.ipynb",
]


@pytest.mark.parametrize("wrapped", ["", "course-quickshot-7/"])
@pytest.mark.parametrize("kind", ["folder", "archive"])
def test_moodle_is_read_as_it_comes(class_, tmp_path, kind, wrapped):
    names = [wrapped + name for name in MOODLE]
    source = (
        class_(*names)
        if kind == "folder"
        else packed(dict.fromkeys(names, NOTEBOOK), tmp_path / "course-quickshot-7.zip")
    )
    found = collect([source], EXERCISES).found
    assert [(h.origin.student, h.origin.name, h.source) for h in found] == [
        ("1815", "Ada Lovelace", names[0]),
        ("42", "Müller, Bob", names[2]),
    ]
    assert all(h.submitted for h in found)


def test_moodle_without_folders(class_):
    folder = class_("Ada L_1815_assignsubmission_file_quickshot.ipynb", "Bob_2_assignsubmission_file_a_1_2_b.ipynb")
    assert list(who(folder).values()) == ["1815", "2"]


def test_canvas_is_read_as_it_comes(tmp_path):
    names = [
        "lovelaceada_LATE_1815_4711_quickshot.ipynb",
        "lovelaceada_late_1815_4799_quickshot-1.ipynb",
        "mullerbob_42_4712_my_own_file.ipynb",
        "mullerbob_42_4713_picture.png",
    ]
    found = collect([packed(dict.fromkeys(names, NOTEBOOK), tmp_path / "submissions.zip")], EXERCISES).found
    assert [(h.origin.student, h.origin.late, h.origin.sequence) for h in found] == [
        ("1815", True, 4711),
        ("1815", True, 4799),
        ("42", False, 4712),
    ]
    assert len({h.origin.place for h in found}) == 2


@pytest.mark.parametrize("root", ["submitted", "course"])
def test_nbgrader_is_read_as_it_collects(class_, root):
    folder = class_("ada/ps1/quickshot.ipynb", "bob/ps1/quickshot.ipynb", root="course/submitted")
    (folder / "ada/ps1/timestamp.txt").write_text("2026-11-02 10:00:00 UTC")
    source = folder if root == "submitted" else folder.parent
    found = collect([source], EXERCISES).found
    assert [h.origin.student for h in found] == ["ada", "bob"]
    assert found[0].submitted.isoformat() == "2026-11-02T10:00:00+00:00"


def test_one_student_of_nbgrader_is_no_wrapper(class_):
    assert list(who(class_("ada/ps1/quickshot.ipynb", root="submitted")).values()) == ["ada"]
    assert list(who(class_("ada/ps1/quickshot.ipynb", root="other")).values()) == ["ada"]


def test_clones_of_github_classroom(class_):
    folder = class_(
        "hw-1-submissions/hw-1-ada-l/quickshot.ipynb",
        "hw-1-submissions/hw-1-ada-l/.git/config",
        "hw-1-submissions/hw-1-ada-m/quickshot.ipynb",
        "hw-1-submissions/hw-1-ada-m/.git/config",
    )
    found = collect([folder], EXERCISES).found
    assert [h.origin.student for h in found] == ["ada-l", "ada-m"]
    assert [h.submitted for h in found] == [None, None]  # the dates are those of the download


def test_a_clone_alone_is_told_by_the_name_of_the_exercise_or_not_at_all(class_):
    for clone, student in (("quickshot-ada", "ada"), ("one-link-ada", "ada"), ("hw-1-ada", "hw-1-ada")):
        folder = class_(f"{clone}/quickshot.ipynb", f"{clone}/.git/config", "bob/quickshot.ipynb", root=clone)
        assert sorted(who(folder).values()) == sorted(["bob", student])


def test_a_name_that_is_too_long_for_a_platform_is_that_of_a_folder(tmp_path):
    long = "A" * 600 + "_1815_assignsubmission_file_"
    source = packed({f"{long}/quickshot.ipynb": NOTEBOOK, "bob/quickshot.ipynb": NOTEBOOK}, tmp_path / "class.zip")
    assert sorted(who(source).values()) == [long, "bob"]


def test_an_archive_may_list_its_folders(tmp_path):
    names = {
        "ada/": b"",
        "ada/quickshot.ipynb": NOTEBOOK,
        "bob/quickshot.ipynb": NOTEBOOK,
        "dora/": b"",
        "../eve/": b"",
    }
    intake = collect([packed(names, tmp_path / "class.zip")], EXERCISES)
    assert [h.source for h in intake.found] == ["ada/quickshot.ipynb", "bob/quickshot.ipynb"]
    assert sentences(intake) == {"dora": "The folder is empty."}


def test_a_file_that_was_named_itself_is_what_was_handed_in(class_):
    folder = class_("essay.pdf", "notes.txt")
    assert who(folder / "essay.pdf") == {"essay.pdf": "essay.pdf"}
    with pytest.raises(DHError, match="no notebook"):
        collect([folder], EXERCISES)


def test_hidden_and_spare_files_are_left_out(class_):
    folder = class_(
        "ada/quickshot.ipynb",
        "ada/.ipynb_checkpoints/quickshot-checkpoint.ipynb",
        "ada/._quickshot.ipynb",
        "__MACOSX/ada/quickshot.ipynb",
        "bob/quickshot.ipynb",
        "bob/env/lib/x.ipynb",
        "bob/env/pyvenv.cfg",
    )
    assert list(who(folder)) == ["ada/quickshot.ipynb", "bob/quickshot.ipynb"]
    spare = ("__MACOSX/._quickshot.ipynb", ".ipynb_checkpoints/quickshot.ipynb", "term/quickshot.ipynb")
    (folder / "carl").mkdir()
    packed(dict.fromkeys(spare, NOTEBOOK), folder / "carl" / "term.zip")
    assert list(who(folder))[2:] == ["carl/term.zip/term/quickshot.ipynb"]


def test_whoever_handed_in_something_else_is_not_lost(class_):
    folder = class_("ada/essay.pdf", "ada/README.md", "bob/quickshot.ipynb.txt", "bob/notes.md", "carl/quickshot.ipynb")
    (folder / "dora").mkdir()
    intake = collect([folder], EXERCISES)
    assert [h.source for h in intake.found] == ["ada/essay.pdf", "bob/quickshot.ipynb.txt", "carl/quickshot.ipynb"]
    assert sentences(intake) == {"dora": "The folder is empty."}


def test_whoever_wrote_a_text_in_moodle_and_handed_in_no_file_is_listed(class_):
    folder = class_(*MOODLE, "Carl_3_assignsubmission_onlinetext_/onlinetext.html")
    intake = collect([folder], EXERCISES)
    assert [h.origin.student for h in intake.found] == ["1815", "42"]
    assert list(sentences(intake).values()) == ["Carl handed in no notebook."]


def test_links_are_not_followed(class_, tmp_path):
    folder = class_("ada/quickshot.ipynb", "bob/quickshot.ipynb")
    secret = tmp_path / "secret.ipynb"
    secret.write_text("secret")
    (folder / "ada/out.ipynb").symlink_to(secret)
    (folder / "ada/up").symlink_to(tmp_path)
    (folder / "bob/other.ipynb").symlink_to(folder / "ada/quickshot.ipynb")
    intake = collect([folder], EXERCISES)
    with Reader() as reader:
        for handed_in in intake.found:
            if handed_in.entry.fault:
                with pytest.raises(DHError, match="links are not followed"):
                    reader.read(handed_in.entry)
            else:
                assert reader.read(handed_in.entry) == handed_in.source.encode()
    assert len([problem for problem in intake.problems if "not followed" in problem.what]) == 3


def test_a_file_that_becomes_a_link_or_a_pipe_is_not_read(class_, tmp_path):
    folder = class_("ada/quickshot.ipynb", "bob/quickshot.ipynb")
    ada, bob = collect([folder], EXERCISES).found
    ada.entry.path.unlink()
    ada.entry.path.symlink_to(tmp_path / "class/bob/quickshot.ipynb")
    bob.entry.path.unlink()
    os.mkfifo(bob.entry.path)
    with Reader() as reader:
        with pytest.raises(DHError, match="is a link"):
            reader.read(ada.entry)
        with pytest.raises(DHError, match="no file that can be read"):
            reader.read(bob.entry)


def test_a_file_that_goes_or_grows_before_it_is_read_is_named(class_):
    folder = class_("ada/quickshot.ipynb", "bob/quickshot.ipynb")
    ada, bob = collect([folder], EXERCISES).found
    ada.entry.path.unlink()
    with bob.entry.path.open("wb") as file:
        file.truncate(50_000_001)
    with Reader() as reader:
        with pytest.raises(DHError, match=r"quickshot\.ipynb cannot be opened: No such file or directory\."):
            reader.read(ada.entry)
        with pytest.raises(DHError, match="larger than 50 MB; clear its outputs"):
            reader.read(bob.entry)


def test_a_pipe_among_the_files_is_left_out(class_):
    folder = class_("ada/quickshot.ipynb")
    os.mkfifo(folder / "ada" / "pipe.ipynb")
    assert list(who(folder)) == ["ada/quickshot.ipynb"]


def test_an_archive_that_is_gone_or_of_which_an_entry_leads_out_is_not_read(tmp_path):
    with pytest.raises(DHError, match=r"gone\.zip cannot be opened: No such file or directory\."):
        archives.Archive(tmp_path / "gone.zip", "gone.zip")
    archive = archives.Archive(packed({"../quickshot.ipynb": NOTEBOOK, "a.ipynb": NOTEBOOK}), "work.zip")
    with pytest.raises(DHError, match="outside of its folder"):
        archive.read(0)
    assert archive.read(1) == NOTEBOOK


@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such names")
def test_names_that_are_no_text_are_written_out(tmp_path):
    folder = os.fsencode(tmp_path / "class")
    os.makedirs(folder + b"/\xe4da")
    with open(folder + b"/\xe4da/quick\nshot.ipynb", "wb") as file:
        file.write(NOTEBOOK)
    (tmp_path / "class" / "Mu\u0308ller").mkdir()
    (tmp_path / "class" / "Mu\u0308ller" / "x.ipynb").write_bytes(NOTEBOOK)
    found = collect([tmp_path / "class"], EXERCISES).found
    assert [h.origin.student for h in found] == ["Müller", "\\xe4da"]
    with Reader() as reader:
        assert [reader.read(h.entry) for h in found] == [NOTEBOOK, NOTEBOOK]
    assert all(h.source.encode() for h in found)


def test_students_may_pack_what_they_hand_in(tmp_path):
    inner = packed({"work/quickshot.ipynb": b"inner"})
    source = packed(
        {"Ada_1_assignsubmission_file_/a.zip": inner, "Bob_2_assignsubmission_file_/quickshot.ipynb": b"bob"},
        tmp_path / "moodle.zip",
    )
    found = collect([source], EXERCISES).found
    with Reader() as reader:
        assert [(h.origin.student, reader.read(h.entry)) for h in found] == [("1", b"inner"), ("2", b"bob")]


def test_a_platform_inside_a_students_archive_says_nothing(class_):
    """Who packs a folder that looks like Moodle's does not become somebody else."""
    folder = class_("bob/quickshot.ipynb")
    (folder / "eve").mkdir()
    packed({"Ada_1_assignsubmission_file_/quickshot.ipynb": NOTEBOOK}, folder / "eve" / "work.zip")
    assert list(who(folder).values()) == ["bob", "eve"]
    packed({"Ada_1_assignsubmission_file_/quickshot.ipynb": NOTEBOOK}, folder / "mallory.zip")
    assert list(who(folder).values()) == ["bob", "eve", "mallory"]


def test_the_download_of_a_class_among_others_is_said(class_):
    folder = class_("bob/quickshot.ipynb")
    packed(dict.fromkeys(MOODLE, NOTEBOOK), folder / "moodle.zip")
    intake = collect([folder], EXERCISES)
    assert [h.origin.student for h in intake.found] == ["bob"]
    assert "a source of its own" in sentences(intake)["moodle.zip"]


def test_the_same_path_in_two_sources_is_told_apart(class_):
    first, second = class_("ada/quickshot.ipynb", root="week1"), class_("ada/quickshot.ipynb", root="week2")
    assert who(first, second) == {"ada/quickshot.ipynb": "ada", "week2/ada/quickshot.ipynb": "ada"}
    third = class_("ada/quickshot.ipynb", root="term2/week2")
    (again,) = who(first, second, third).keys() - {"ada/quickshot.ipynb", "week2/ada/quickshot.ipynb"}
    assert again == f"{third}/ada/quickshot.ipynb (2)"


def test_the_roster_says_who_is_who(class_):
    people = {"lovelace, ada": SimpleNamespace(id="s1", name="Ada Lovelace")}
    folder = class_("Lovelace, Ada/quickshot.ipynb", "Mallory/quickshot.ipynb", "final.ipynb")
    intake = collect(
        [folder], EXERCISES, roster=lambda names: next((people[n.lower()] for n in names if n.lower() in people), None)
    )
    assert [h.origin.student for h in intake.found] == ["s1", "Mallory", ""]
    assert [problem.what for problem in intake.problems] == ["Mallory is not on the roster."]


def test_nothing_at_all_is_an_error(tmp_path):
    with pytest.raises(DHError, match=r"no notebook \(\*\.ipynb\)"):
        collect([tmp_path])
    with pytest.raises(DHError, match="no file or folder"):
        collect([tmp_path / "nowhere"])


# ── archives of strangers ──


def hostile(kind):
    match kind:
        case "traversal":
            return packed({"../../quickshot.ipynb": NOTEBOOK})
        case "absolute":
            return packed({"/etc/quickshot.ipynb": NOTEBOOK})
        case "drive":
            return packed({"C:\\quickshot.ipynb": NOTEBOOK})
        case "backslashes":
            return packed({"..\\..\\quickshot.ipynb": NOTEBOOK})
        case "link":
            stream = io.BytesIO()
            with zipfile.ZipFile(stream, "w") as archive:
                info = zipfile.ZipInfo("quickshot.ipynb")
                info.external_attr = (stat.S_IFLNK | 0o777) << 16
                archive.writestr(info, "/etc/passwd")
            return stream.getvalue()
        case "bomb":
            data = bytearray(packed({"quickshot.ipynb": b"0" * 4_000_000}))
            at = data.rfind(b"PK\x01\x02")
            data[at + 24 : at + 28] = (2**31).to_bytes(4, "little")
            return bytes(data)
        case "large":
            return packed({"quickshot.ipynb": b"01" * 30_000_000})
        case "encrypted":
            data = bytearray(packed({"quickshot.ipynb": NOTEBOOK}))
            data[6] |= 1
            data[data.rfind(b"PK\x01\x02") + 8] |= 1
            return bytes(data)
        case "damaged":
            data = bytearray(packed({"quickshot.ipynb": os.urandom(2000)}))
            data[500:600] = bytes(100)
            return bytes(data)
        case "cut":
            return packed({"quickshot.ipynb": os.urandom(2000)})[:900]
        case "lies about its size":
            data = bytearray(packed({"quickshot.ipynb": b"0" * 4_000_000}))
            at = data.rfind(b"PK\x01\x02")
            data[at + 24 : at + 28] = (10).to_bytes(4, "little")
            return bytes(data)
        case "lies about its list":
            data = bytearray(packed({"quickshot.ipynb": NOTEBOOK}))
            at = data.rfind(b"PK\x05\x06")
            data[at + 12 : at + 16] = (46 * 100_001).to_bytes(4, "little")
            return bytes(data)
        case "archives in archives":
            data = packed({"quickshot.ipynb": NOTEBOOK})
            for k in range(4):
                data = packed({f"{k}.zip": data})
            return data
        case "no archive":
            return b"%PDF-1.7"
    raise AssertionError(kind)


@pytest.mark.parametrize(
    ("kind", "says"),
    [
        ("traversal", "outside of its folder"),
        ("absolute", "outside of its folder"),
        ("drive", "outside of its folder"),
        ("backslashes", "outside of its folder"),
        ("link", "links are not followed"),
        ("bomb", "larger than 50 MB"),
        ("large", "larger than 50 MB"),
        ("encrypted", "encrypted"),
        ("damaged", "damaged"),
        ("cut", "damaged, or no ZIP file"),
        ("lies about its size", "damaged"),
        ("lies about its list", "more than 100,000 entries"),
        ("archives in archives", "an archive in an archive"),
        ("no archive", "damaged, or no ZIP file"),
    ],
)
def test_hostile_archives_cost_their_authors_only(class_, kind, says):
    folder = class_("bob/quickshot.ipynb")
    (folder / "eve").mkdir()
    (folder / "eve" / "work.zip").write_bytes(hostile(kind))
    before = sorted(folder.rglob("*"))
    intake = collect([folder], EXERCISES)
    assert [h.origin.student for h in intake.found] == ["bob", "eve"]
    with Reader() as reader:
        assert reader.read(intake.found[0].entry) == b"bob/quickshot.ipynb"
        with pytest.raises(DHError, match=says):
            reader.read(intake.found[1].entry)
    assert sorted(folder.rglob("*")) == before


def test_what_one_student_packed_has_a_bound_of_its_own(tmp_path, monkeypatch):
    inner = packed({f"{k}.ipynb": NOTEBOOK for k in range(20)})
    source = packed({"ada/work.zip": inner, "bob/quickshot.ipynb": NOTEBOOK}, tmp_path / "class.zip")
    assert len(collect([source], EXERCISES).found) == 21
    monkeypatch.setattr(archives, "MOST_BYTES_OF_ONE", 10)
    found = collect([source], EXERCISES).found
    assert [(h.origin.student, "left alone" in h.entry.fault) for h in found] == [("ada", True), ("bob", False)]


def test_output_that_says_one_thing_over_and_over_is_no_bomb(class_):
    folder = class_("bob/quickshot.ipynb")
    (folder / "ada").mkdir()
    (folder / "ada" / "work.zip").write_bytes(packed({"quickshot.ipynb": b"0" * 20_000_000}))
    with Reader() as reader:
        assert len(reader.read(collect([folder], EXERCISES).found[0].entry)) == 20_000_000


@pytest.mark.parametrize("what", ["MOST_ENTRIES", "MOST_BYTES"])
def test_archives_have_bounds(tmp_path, monkeypatch, what):
    source = packed({f"s{k}/quickshot.ipynb": NOTEBOOK for k in range(20)}, tmp_path / "class.zip")
    assert len(collect([source], EXERCISES).found) == 20
    monkeypatch.setattr(archives, what, 10)
    with pytest.raises(DHError, match="left alone"):
        collect([source], EXERCISES)


def test_names_of_a_mac_are_read(tmp_path):
    data = bytearray(packed({"Mxxller/quickshot.ipynb": NOTEBOOK, "bob/quickshot.ipynb": NOTEBOOK}))
    at = 0
    while (at := data.find(b"Mxxller", at)) >= 0:  # UTF-8 that no flag tells of
        data[at : at + 7] = "Müller".encode()
        at += 1
    path = tmp_path / "class.zip"
    path.write_bytes(data)
    assert list(who(path).values()) == ["Müller", "bob"]
