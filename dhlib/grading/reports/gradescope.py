"""Gradescope: the ``results.json`` that an autograder leaves for a student."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from dhlib.grading.marks import HEADLINES
from dhlib.grading.reports import comments
from dhlib.grading.reports.formats import Files, Wishes, known
from dhlib.grading.reports.names import file_names
from dhlib.grading.reports.records import Record
from dhlib.grading.sections import where


def write(records: Sequence[Record], wishes: Wishes) -> Files:
    """One file for each student and exercise."""
    records = known(records)
    names = file_names([f"{record.student}-{record.exercise}" for record in records])
    return {
        f"gradescope/{name}/results.json": json.dumps(result(record), ensure_ascii=False, indent=1).encode()
        for name, record in zip(names, records, strict=True)
    }


def result(record: Record) -> dict[str, Any]:
    """What Gradescope reads; every text in it is shown as text."""
    told = [text for text in (record.submission.message, record.about_time) if text]
    told += [f"{comments.signed(bonus.points)} points: {bonus.reason}" for bonus in record.bonuses]
    return {
        "score": record.points,
        "execution_time": round(record.submission.seconds, 3),
        "output": "\n".join(told),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "stdout_visibility": "hidden",
        "tests": [
            {
                "score": answer.points,
                "max_score": answer.row.out_of,
                "status": "passed" if answer.passed else "failed",
                "name": f"{answer.row.part}: {answer.row.title}" if answer.row.title else answer.row.part,
                "number": str(k),
                "output": _output(record, k - 1),
                "visibility": "visible",
            }
            for k, answer in enumerate(record.answers, 1)
        ],
    }


def _output(record: Record, k: int) -> str:
    answer = record.answers[k]
    row = answer.row
    pieces = [f"{HEADLINES[row.verdict].capitalize()}.", row.message, where(row.section)]
    if answer.adjustment:
        pieces.append(f"Changed by hand: {answer.adjustment.reason}")
    return " ".join(piece for piece in pieces if piece)
