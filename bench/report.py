"""What was measured, as tables: for bench/RESULTS.md, and for the book's page on speed."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

Result = dict[str, Any]


@dataclass(frozen=True)
class Table:
    """A table with what must be said of it."""

    title: str
    says: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    missing: Sequence[str] = ()


def load(folder: Path, name: str) -> Result | None:
    """What a workload measured last, or nothing."""
    path = folder / f"{name}.json"
    if not path.exists():
        return None
    result: Result = json.loads(path.read_text(encoding="utf-8"))
    return result


def seconds(value: float) -> str:
    """A time with its unit.

    >>> seconds(1.23e-5), seconds(0.0042), seconds(12.3)
    ('12.3 µs', '4.2 ms', '12.3 s')
    """
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if value >= size:
            return f"{value / size:.3g} {unit}"
    return f"{value / 1e-9:.3g} ns"


def rate(seconds_each: float) -> str:
    """How many in a second.

    >>> rate(2.5e-7), rate(4e-5)
    ('4 M/s', '25 k/s')
    """
    each = 1 / seconds_each
    return f"{each / 1e6:.3g} M/s" if each >= 1e6 else f"{each / 1e3:.3g} k/s" if each >= 1e3 else f"{each:.3g} /s"


def times(ratio: float) -> str:
    """How many times as long the peer takes.

    >>> times(3.57), times(0.0785), times(1092.2)
    ('3.6 ×', '0.078 ×', '1100 ×')
    """
    return f"{float(f'{ratio:.2g}'):g} ×"


def forward(result: Result) -> list[Table]:
    """One call and many."""
    rows = [
        [
            row["peer"],
            f"`{row['call']}`",
            seconds(row["one"]["peer"]),
            times(row["one"]["ratio"]),
            rate(row["many"]["peer"]),
            times(row["many"]["ratio"]),
            times(row["compiled"]["ratio"]),
        ]
        for row in result["rows"]
    ]
    ours = [
        ["dhlib", "`arm.fk(q)`", _span(result, "one", "ours", seconds), "1 ×", _span(result, "many", "ours", rate)]
        + ["1 ×", ""],
        ["dhlib", "`arm.compiled()(q)`", "", "", _span(result, "compiled", "ours", rate), "", "1 ×"],
    ]
    return [
        Table(
            "Forward kinematics of the PUMA 560",
            "All sixteen entries of every pose; 100 000 random joint vectors for whoever takes arrays, 5000 of them "
            "for a loop. The columns with × say how many times as long the peer takes for one pose as `fk`, or as "
            "the compiled form, in the same run: above 1 ours is faster, below 1 the peer is. The times of dhlib are "
            "the range over the runs.",
            ["library", "call", "one call", "of `fk`", "many", "of `fk`", "of compiled"],
            ours + rows,
            _missing(result),
        )
    ]


def _span(result: Result, what: str, whose: str, form: Callable[[float], str]) -> str:
    values = sorted(row[what][whose] for row in result["rows"])
    first, last = form(values[0]), form(values[-1])
    return first if first == last else f"{first} – {last}"


def accuracy(result: Result) -> list[Table]:
    """Against 50 digits."""
    seen: dict[tuple[str, str], list[str]] = {}
    for row in result["rows"]:
        seen[row["peer"], row["call"]] = [
            row["peer"],
            f"`{row['call']}`",
            f"{row['rotation']:.1e}",
            f"{row['position']:.1e}",
            str(row["crumbs"]),
        ]
    return [
        Table(
            "Accuracy against 50 digits",
            "Largest error of an entry of the rotation, and of a position as a part of the reach, over 500 random "
            "joint vectors; and how many entries of 200 poses at quarter turns are left as something like 6e-17 "
            "where 0 is meant.",
            ["library", "call", "rotation", "position / reach", "crumbs"],
            list(seen.values()),
            _missing(result),
        )
    ]


def symbolic(result: Result) -> list[Table]:
    """T_6 in symbols."""
    seen: dict[str, list[str]] = {}
    for row in result["rows"]:
        if row["call"] not in seen:
            seen[row["call"]] = [
                row["peer"],
                row["call"],
                seconds(row["seconds"]),
                times(row["ratio"]),
                str(row["operations"]),
                str(row["shared"]),
            ]
    return [
        Table(
            "T₆ of the PUMA 560 in symbols",
            "From a cold cache of sympy. Operations are counted as written, and with repeated parts computed once.",
            ["library", "call", "time", "of ours", "operations", "shared"],
            list(seen.values()),
            _missing(result),
        )
    ]


def placing(result: Result) -> list[Table]:
    """Axes to tables."""
    kinds = list(result["rows"][0]["right"])
    rows = [
        [row["peer"], f"`{row['call']}`", *(str(row["right"][kind]) for kind in kinds)]
        + [f"{sum(row['right'].values())} of {row['of'] * len(kinds)}", f"{row['median_ms']:.2g} ms"]
        for row in result["rows"]
    ]
    return [
        Table(
            "From joint axes to a table",
            "Random arms of six joints with one pair of neighbours of the kind named (in ‘mixed’ all five), right if "
            "the table moves as the product of exponentials does, to 1e-6.",
            ["library", "call", *kinds, "right", "median time"],
            rows,
            _missing(result),
        )
    ]


def imports(result: Result) -> list[Table]:
    """What importing costs."""
    seen: dict[str, list[str]] = {}
    for row in result["rows"]:
        seen.setdefault(row["peer"], [row["peer"], f"{row['cpu_ms']:.0f} ms", f"{row['memory_mb']:.0f} MB"])
    return [
        Table(
            "Importing",
            "CPU time and memory of a fresh process, over those of a bare Python.",
            ["library", "CPU", "memory"],
            sorted(seen.values(), key=lambda row: float(row[1].split()[0])),
            _missing(result),
        )
    ]


def grading(result: Result) -> list[Table]:
    """The same thirty notebooks."""
    ours = sorted(row["ours"] for row in result["rows"])
    rows = [
        ["dhlib", "`dhlib grade FOLDER`, with its sandbox", _each(ours[0], ours[-1]), _rate(ours[0], ours[-1]), "1 ×"]
    ]
    rows += [
        [row["peer"], f"`{row['call']}`", _each(row["each"]), _rate(row["each"]), times(row["ratio"])]
        for row in result["rows"]
    ]
    return [
        Table(
            f"Grading the same {result['count']} notebooks of four parts",
            "The whole command each time, start and gradebook included. The marks of all were checked to be those that "
            "were planned. No peer has a sandbox here; nbclient only executes.",
            ["grader", "call", "for each", "in a minute", "of ours"],
            rows,
            _missing(result),
        )
    ]


def _each(*values: float) -> str:
    return " – ".join(dict.fromkeys(seconds(value) for value in values))


def _rate(*values: float) -> str:
    return " – ".join(dict.fromkeys(f"{60 / value:.3g}" for value in values))


def hostile(result: Result) -> list[Table]:
    """One hostile notebook among honest ones."""
    calls = list(dict.fromkeys(row["call"] for row in result["rows"]))
    rows = []
    for attack in result["attacks"]:
        found = {row["call"]: row for row in result["rows"] if row["attack"] == attack}
        rows.append([attack, *(_verdict(found[call]) if call in found else "" for call in calls)])
    return [
        Table(
            "One hostile notebook between two honest ones",
            "‘Held’: no undeserved point, the honest two have all of theirs, nothing got out, and what the hostile "
            "notebook answers rightly after its attack still counts.",
            ["the notebook …", *(f"`{call}`" for call in calls)],
            rows,
            _missing(result),
        )
    ]


def _verdict(row: dict[str, Any]) -> str:
    faults = [
        *(["undeserved point"] if row["undeserved"] else []),
        *([row["ended"].split(":")[0]] if row["ended"] else []),
        *(["honest ones lose"] if not row["others"] else []),
        *(["its later parts lost"] if row["others"] and not row["later_parts"] else []),
        *row["harm"],
    ]
    return ", ".join(faults) or "held"


def _missing(result: Result) -> list[str]:
    return [f"{peer}: {why}" for peer, why in sorted(result.get("missing", {}).items())]


#: The order of the report.
TABLES: dict[str, Callable[[Result], list[Table]]] = {
    "forward": forward,
    "accuracy": accuracy,
    "symbolic": symbolic,
    "placing": placing,
    "imports": imports,
    "grading": grading,
    "hostile": hostile,
}


def measured(folder: Path) -> dict[str, Result]:
    """Every workload that has been measured, in the order of the report."""
    return {name: result for name in TABLES if (result := load(folder, name))}


def write_report(folder: Path, target: Path) -> None:
    """Write the report: a view of what is stored."""
    lines = ["# Measured against the best", "", "Made by `make bench`; see README.md beside this file.", ""]
    for name, result in measured(folder).items():
        machine = result["machine"]
        versions = ", ".join(f"{peer} {version}" for peer, version in sorted(result.get("versions", {}).items()))
        for table in TABLES[name](result):
            lines += [f"## {table.title}", "", table.says, "", *_markdown(table), ""]
            lines += [f"Not to be had: {line}" for line in table.missing] + ([""] if table.missing else [])
        lines += [
            f"*{result['date']}, {machine['processor']}, {machine['cores']} cores, Python {machine['python']}"
            + (f"; {versions}" if versions else "")
            + ".*",
            "",
        ]
    target.write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")


def _markdown(table: Table) -> Iterable[str]:
    yield "| " + " | ".join(table.header) + " |"
    yield "|" + "---|" * len(table.header)
    for row in table.rows:
        yield "| " + " | ".join(row) + " |"
