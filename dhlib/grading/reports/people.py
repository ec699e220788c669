"""Whom the instructor means."""

from __future__ import annotations

from dhlib.errors import DHError
from dhlib.grading.batch.store import Store
from dhlib.grading.reports.pseudonyms import KEY, pseudonym

#: How many names a message lists.
MOST = 8


def find_student(store: Store, said: str) -> str:
    """The student of a name: the one that stays, what they are called, or a pseudonym.

    Raises
    ------
    DHError
        If nobody or more than one fits; the message lists who does.
    """
    students = store.students()
    if any(student.student == said for student in students):
        return said
    key = store.meta(KEY)
    plain = said.strip().casefold()
    found = [
        student
        for student in students
        if plain in (student.student.casefold(), student.name.casefold())
        or (key and pseudonym(student.student, key) == plain)
    ]
    if len(found) == 1:
        return found[0].student
    if found:
        listed = ", ".join(f"{student.student} ({student.name})" for student in found[:MOST])
        raise DHError(f"{said!r} may be {listed}: say which by the first of the two.")
    near = [s for s in students if plain and (plain in s.name.casefold() or plain in s.student.casefold())]
    if near:
        listed = ", ".join(f"{s.student} ({s.name})" for s in near[:MOST])
        raise DHError(f"nobody is called {said!r}; there is {listed}.")
    raise DHError(f"nobody is called {said!r} among the {len(students)} students; grades.csv lists them all.")


def find_exercise_of(store: Store, student: str, said: str) -> str:
    """The exercise that is meant: the one named, or the only one the student handed in.

    Raises
    ------
    DHError
        If there is none, or more than one.
    """
    rows = store.query("SELECT DISTINCT exercise FROM submission WHERE student = ? OR ? = ''", (student, student))
    names = sorted(str(row["exercise"]) for row in rows if row["exercise"])
    if said in names:
        return said
    if not said and len(names) == 1:
        return names[0]
    if said:
        raise DHError(f"there is no exercise {said!r} among these results; there is {', '.join(names) or 'none'}.")
    raise DHError(f"there are several exercises: {', '.join(names)}. Say which with --exercise NAME.")
