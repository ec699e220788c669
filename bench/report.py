"""What was measured, as tables: for bench/RESULTS.md, and for the book's page on speed."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

Result = dict[str, Any]


@dataclass(frozen=True)
class Bar:
    """One bar of a chart."""

    label: str
    value: float
    shown: str
    ours: bool = False


@dataclass(frozen=True)
class Aim:
    """What we set out to reach, and whether the last measurement reached it."""

    aim: str
    found: str
    reached: bool


@dataclass(frozen=True)
class Table:
    """A table with what must be said of it.

    Parameters
    ----------
    title, says : str
    header, rows : sequences of str
        Markdown.
    missing : sequence of str
        Who is not in it, and why.
    aims : sequence of Aim
    bars : sequence of Bar
        The same as a picture, where a picture helps; on a logarithmic scale.
    axis : str
        What the bars show.
    """

    title: str
    says: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    missing: Sequence[str] = ()
    aims: Sequence[Aim] = ()
    bars: Sequence[Bar] = ()
    axis: str = ""


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

    >>> times(3.57), times(0.0784), times(1092.2)
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
            times(row["compiled_one"]["ratio"]),
            rate(row["many"]["peer"]),
            times(row["many"]["ratio"]),
            times(row["compiled"]["ratio"]),
        ]
        for row in result["rows"]
    ]
    ours = [
        ["dhlib", f"`{call}`", _span(result, one, "ours", seconds), *is_one, _span(result, many, "ours", rate), *is_one]
        for call, one, many, is_one in (
            ("arm.fk(q)", "one", "many", ("1 ×", "")),
            ("arm.compiled()(q)", "compiled_one", "compiled", ("", "1 ×")),
        )
    ]
    return [
        Table(
            "Forward kinematics of the PUMA 560",
            "All sixteen entries of every pose; 100 000 random joint vectors for whoever takes arrays, 5000 of them "
            "for a loop. The columns with × say how many times as long the peer takes for one pose as `fk`, or as "
            "the compiled form, in the same run: above 1 ours is faster, below 1 the peer is. The times of dhlib are "
            "the range over the runs.",
            ["library", "call", "one call", "of `fk`", "of compiled", "many", "of `fk`", "of compiled"],
            ours + rows,
            _missing(result),
            _aims_of_forward(result),
            [
                Bar("dhlib, compiled", 1 / _middle(result, "compiled"), _span(result, "compiled", "ours", rate), True),
                Bar("dhlib, fk", 1 / _middle(result, "many"), _span(result, "many", "ours", rate), True),
                *(Bar(row["call"], 1 / row["many"]["peer"], rate(row["many"]["peer"])) for row in result["rows"]),
            ],
            "poses a second, of many joint vectors",
        )
    ]


def _middle(result: Result, what: str) -> float:
    return median(row[what]["ours"] for row in result["rows"])


def _aims_of_forward(result: Result) -> list[Aim]:
    aims = [
        _at_most(f"one call of `{call}`", _middle(result, what), 10e-6, seconds)
        for call, what in (("arm.fk(q)", "one"), ("arm.compiled()(q)", "compiled_one"))
    ]
    for call, least in (("robot.ets().eval(q)", 3), ("pin.forwardKinematics(model, data, q)", 4)):
        for row in result["rows"]:
            if row["call"] == call:
                aims.append(_at_least(f"many poses, against `{call}`", row["many"]["ratio"], least, times))
    each = _middle(result, "compiled")
    aims.append(Aim("compiled form: at least 4 M/s", rate(each), each <= 1 / 4e6))
    return aims


def _at_most(what: str, value: float, limit: float, form: Callable[[float], str]) -> Aim:
    return Aim(f"{what}: at most {form(limit)}", form(value), value <= limit)


def _at_least(what: str, value: float, limit: float, form: Callable[[float], str]) -> Aim:
    return Aim(f"{what}: at least {form(limit)}", form(value), value >= limit)


def _span(result: Result, what: str, whose: str, form: Callable[[float], str]) -> str:
    return _between([row[what][whose] for row in result["rows"]], form)


def _between(values: Sequence[float], form: Callable[[float], str]) -> str:
    """From the least to the most of what is shown: of rates the longest time comes first."""
    first, *_, last = map(form, sorted([*values, values[0]], reverse=form is rate))
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
            [
                aim
                for row in _rows_of(result, "dhlib")
                for aim in (
                    _at_most(f"`{row['call']}`, rotation", row["rotation"], 2e-15, "{:.1e}".format),
                    _at_most(f"`{row['call']}`, position", row["position"], 2e-15, "{:.1e}".format),
                    _at_most(f"`{row['call']}`, crumbs", row["crumbs"], 0, str),
                )
            ],
        )
    ]


def _rows_of(result: Result, peer: str) -> list[dict[str, Any]]:
    """The rows of a peer, one for each call: ours is measured again beside each peer."""
    return list({row["call"]: row for row in result["rows"] if row["peer"] == peer}.values())


def symbolic(result: Result) -> list[Table]:
    """T_6 in symbols."""
    times_taken: dict[tuple[str, str], list[float]] = {}
    for row in result["rows"]:
        times_taken.setdefault((row["peer"], row["call"]), []).append(row["seconds"])
    seen: dict[str, list[str]] = {}
    for row in result["rows"]:
        if row["call"] not in seen:
            seen[row["call"]] = [
                row["peer"],
                row["call"],
                _between(times_taken[row["peer"], row["call"]], seconds),
                times(row["ratio"]),
                str(row["operations"]),
                str(row["shared"]),
            ]
    return [
        Table(
            "T₆ of the PUMA 560 in symbols",
            "From a cold cache of sympy. Operations are counted as written, and with repeated parts computed once. "
            "Ours is measured again beside each peer: its times are the range over the runs, a ratio is that of one.",
            ["library", "call", "time", "of ours", "operations", "shared"],
            list(seen.values()),
            _missing(result),
            _aims_of_symbolic(result),
            [
                Bar(call, median(taken), _between(taken, seconds), peer == "dhlib")
                for (peer, call), taken in times_taken.items()
            ],
            "time, less is better",
        )
    ]


def _aims_of_symbolic(result: Result) -> list[Aim]:
    (ours,) = _rows_of(result, "dhlib")
    others = [row for row in result["rows"] if row["peer"] != "dhlib"]
    fewest = min((row["operations"] for row in others), default=ours["operations"])
    toolbox = [row for row in others if row["peer"] == "roboticstoolbox"]
    return [
        _at_most("time", median(row["seconds"] for row in result["rows"] if row["peer"] == "dhlib"), 0.05, seconds),
        *(_at_least("against the toolbox with `simplify`", row["ratio"], 100, times) for row in toolbox),
        Aim(f"operations: no more than anybody, {fewest}", str(ours["operations"]), ours["operations"] <= fewest),
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
            [
                Aim("every kind right", str(sum(row["right"].values())), min(row["right"].values()) == row["of"])
                for row in _rows_of(result, "dhlib")
            ],
        )
    ]


def sameness(result: Result) -> list[Table]:
    """The same arm or not."""
    counts = [result["same"], result["others"], result["friends"]]
    asked = ("same_found", "others_refused", "friends_right")
    rows = [
        [row["peer"], row["call"], *(str(row[what]) for what in asked), seconds(row["median_seconds"])]
        for row in result["rows"]
    ]
    (ours,) = _rows_of(result, "dhlib")
    found = [ours[what] for what in asked]
    return [
        Table(
            "The same arm or not",
            f"Of {counts[0]} pairs of tables of one arm, how many are found to be the same; of {counts[1]} pairs of "
            f"different arms, how many are refused; and of {counts[2]} PUMAs with signs turned, of which half are the "
            "same arm and half its mirror image, how many are judged rightly. No library among the peers decides "
            "this; the others are what one does by hand.",
            ["who", "how", "same found", "others refused", "signs turned", "median time"],
            rows,
            _missing(result),
            [Aim("all pairs judged rightly", " and ".join(map(str, found)), found == counts)],
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
            [_at_most("over numpy's own CPU time", _over_numpy(result), 60, "{:.0f} ms".format)],
        )
    ]


def _over_numpy(result: Result) -> float:
    """Median over the runs: each peer's run measures numpy and dhlib beside it."""
    ours, numpy = ([row["cpu_ms"] for row in result["rows"] if row["peer"] == who] for who in ("dhlib", "numpy"))
    return median(one - other for one, other in zip(ours, numpy, strict=True))


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
    large = result["large"]
    return [
        Table(
            f"Grading the same {result['count']} notebooks of four parts",
            "The whole command each time, start and gradebook included. The marks of all were checked to be those that "
            "were planned. No peer has a sandbox here; nbclient only executes.",
            ["grader", "call", "for each", "in a minute", "of ours"],
            rows,
            _missing(result),
            [
                _at_least(f"{count} notebooks, against `{row['call']}`", row["ratio"], 30, times)
                for count, row in [*((result["count"], row) for row in result["rows"]), (large["count"], large)]
                if row["peer"] == "nbgrader"
            ],
            [
                Bar("dhlib, with its sandbox", 60 / median(ours), f"{60 / median(ours):.3g}", True),
                *(Bar(row["call"], 60 / row["each"], f"{60 / row['each']:.3g}") for row in result["rows"]),
            ],
            "notebooks a minute",
        ),
        Table(
            f"Grading the same class of {large['count']}",
            "The start of ours counts for little here. One run of the peer, between two of ours.",
            ["grader", "call", "for each", "in a minute", "of ours"],
            [
                ["dhlib", "`dhlib grade FOLDER`, with its sandbox", _each(large["ours"]), _rate(large["ours"]), "1 ×"],
                [
                    large["peer"],
                    f"`{large['call']}`",
                    _each(large["each"]),
                    _rate(large["each"]),
                    times(large["ratio"]),
                ],
            ],
        ),
    ]


def many(result: Result) -> list[Table]:
    """How grading grows with the class."""
    rows = [
        [f"{row['count']}", seconds(row["seconds"]), seconds(row["seconds"] / row["count"]), seconds(row["cpu_each"])]
        + [f"{60 * row['count'] / row['seconds']:.0f}", f"{row['controller_mb']:.0f} MB", f"{row['tree_mb']:.0f} MB"]
        for row in result["rows"]
    ]
    aims = []
    if len(result["rows"]) > 1:
        before, last = result["rows"][-2:]
        growth = (last["seconds"] / last["count"]) / (before["seconds"] / before["count"])
        what = f"from {before['count']} to {last['count']}"
        aims = [
            _at_most(f"time for each, {what}", growth, 1.2, times),
            _at_most(f"memory of all processes, {what}", last["tree_mb"] / before["tree_mb"], 1.5, times),
        ]
    return [
        Table(
            "A class of any size",
            "`dhlib grade` with its sandbox, the whole command. CPU is that of the grader itself, not of what ran "
            "within the walls. Memory is the largest part of it that was theirs at any time: of the process that "
            "watches, and of all together.",
            ["notebooks", "time", "for each", "CPU for each", "in a minute", "watching", "all processes"],
            rows,
            _missing(result),
            aims,
        )
    ]


def _each(*values: float) -> str:
    return " – ".join(dict.fromkeys(seconds(value) for value in values))


def _rate(*values: float) -> str:
    return " – ".join(dict.fromkeys(f"{60 / value:.3g}" if value > 0.6 else f"{60 / value:.0f}" for value in values))


def hostile(result: Result) -> list[Table]:
    """One hostile notebook among honest ones."""
    calls = list(dict.fromkeys(row["call"] for row in result["rows"]))
    rows, beyond = [], result["beyond"]
    for attack in result["attacks"]:
        found = {row["call"]: row for row in result["rows"] if row["attack"] == attack}
        rows.append([attack, *(_verdict(found[call]) if call in found else "" for call in calls)])
    return [
        Table(
            "One hostile notebook between two honest ones",
            "‘Held’: no undeserved point, the honest two have all of theirs, nothing got out, and what the hostile "
            "notebook answers rightly beside its attack still counts. Nothing stands around a grader but what it puts "
            "there itself, so bombs, fillers of memory and disk, and whatever would harm the machine are left out: "
            f"the corpus that tests dhlib has {result['corpus']} attacks.",
            ["the notebook tries to …", *(f"`{call}`" for call in calls)],
            rows,
            _missing(result),
            [
                _at_least("attacks that dhlib holds against", _held(result, calls[0]), len(rows), str),
                _at_most(
                    f"the worst of {beyond['of']} notebooks that never end, beyond its limit, with dhlib",
                    max(0.0, beyond["seconds"]),
                    1.0,
                    seconds,
                ),
            ],
            [
                Bar(call, _held(result, call), f"{_held(result, call)} of {len(rows)}", call == calls[0])
                for call in calls
            ],
            "attacks held",
        )
    ]


def _held(result: Result, call: str) -> int:
    return sum(row["call"] == call and _verdict(row) == "held" for row in result["rows"])


def _verdict(row: dict[str, Any]) -> str:
    faults = [
        *(["undeserved point"] if row["undeserved"] else []),
        *([row["ended"].split(":")[0]] if row["ended"] else []),
        *(["honest ones lose"] if not row["others"] else []),
        *(["its other parts lost"] if row["others"] and not row["other_parts"] else []),
        *row["harm"],
    ]
    return ", ".join(faults) or "held"


def building(result: Result) -> list[Table]:
    """How long the book takes to build."""
    rows = [
        [row["peer"], *(seconds(row[what]) for what in ("first", "again", "changed"))]
        + [seconds(row["executing"]) if row["peer"] != "dhlib" else "side by side"]
        for row in result["rows"]
    ]
    aims = []
    if share := result["first_of_serial"]:
        aims = [_at_most("first build, of the time that executing takes one by one", share, 0.5, times)]
    return [
        Table(
            f"Building {result['chapters']} chapters",
            "The whole `jupyter-book build`: from nothing, again without a change, and after a sentence was added to "
            "one chapter. ‘Plain’ is a Jupyter Book of the same text and code with the default configuration; it "
            "leaves out questions, live figures and cells that run in the page, and typesets no formula.",
            ["book", "first", "again", "after a change", "of the first, executing"],
            rows,
            _missing(result),
            aims,
        )
    ]


def pages(result: Result) -> list[Table]:
    """What a reader gets."""
    rows = [
        [row["page"], row["peer"], str(row["scores"]["performance"]), str(row["scores"]["accessibility"])]
        + [seconds(row["firstPaint"] / 1e3), seconds(row["largestPaint"] / 1e3), f"{row['bytes'] / 1e3:.0f} kB"]
        + [str(row["requests"]), ", ".join(row["hosts"]) or "none", str(len(row["failed"]))]
        for row in sorted(result["rows"], key=lambda row: row["page"])
    ]
    aims = []
    for page in dict.fromkeys(row["page"] for row in result["rows"]):
        found = {row["peer"]: row for row in result["rows"] if row["page"] == page}
        if len(found) == 2:
            ours, plain = found["dhlib"], found["plain"]
            aims += [
                _at_most(f"{page}: first paint", ours["firstPaint"] / 1e3, plain["firstPaint"] / 1e3, seconds),
                _at_most(f"{page}: bytes", ours["bytes"] / 1e3, plain["bytes"] / 1e3, "{:.0f} kB".format),
                _at_most(f"{page}: other hosts", len(ours["hosts"]), 0, str),
            ]
    return [
        Table(
            "What a phone is sent",
            "Lighthouse with its simulated phone, the median of several runs. What the plain book fetches from other "
            "hosts came from this machine, so that nothing is waited for that is far away; ‘failed’ counts what was "
            "asked of them and is not in these copies. Lighthouse does not count what a live figure of ours does "
            "later.",
            ["page", "book", "performance", "accessibility", "first paint", "largest paint", "bytes", "requests"]
            + ["other hosts", "failed"],
            rows,
            _missing(result),
            aims,
        )
    ]


def live(result: Result) -> list[Table]:
    """Code that runs in the page."""
    rows = [
        [row["peer"], row["call"], seconds(row["first"]), seconds(row["next"]), f"{row['bytes'] / 1e6:.1f} MB"]
        for row in result["rows"]
    ]
    found = {row["peer"]: row for row in result["rows"]}
    aims = []
    if {"dhlib", "jupyterlite"} <= set(found):
        share = found["dhlib"]["first"] / found["jupyterlite"]["first"]
        aims = [_at_most("first Run, of JupyterLite’s", share, 0.5, times)]
    return [
        Table(
            "Code that runs in the page",
            "The same cell, with the same interpreter and libraries, served from this machine to a browser with an "
            "empty cache: from opening the page to the output of the cell, then from pressing Run again to the next "
            "output; and what was sent, compressed, until the first.",
            ["page", "how", "first Run", "next Run", "sent"],
            rows,
            _missing(result),
            aims,
        )
    ]


def coverage(result: Result) -> list[Table]:
    """How much of dhlib its tests run."""
    rows = [[row["part"], f"{row['lines']:.1f} %", f"{row['branches']:.1f} %"] for row in result["rows"]]
    (whole,) = (row for row in result["rows"] if row["part"] == "dhlib")
    return [
        Table(
            "How much of the library its tests run",
            "Lines, and ways that a branch can go; without the five files that run within the sandbox, which can write "
            "nothing down.",
            ["part", "lines", "branches"],
            rows,
            _missing(result),
            [_at_least(what, whole[what], 95, "{:.1f} %".format) for what in ("lines", "branches")],
        )
    ]


def mutation(result: Result) -> list[Table]:
    """Whether tests notice a change in the code."""
    rows = []
    for module in dict.fromkeys(row["module"] for row in result["rows"]):
        tried = [row for row in result["rows"] if row["module"] == module]
        noticed = sum(row["outcome"] != "survived" for row in tried)
        rows.append([f"`{module}`", str(tried[0]["changes"]), str(len(tried)), str(noticed)])
    return [
        Table(
            "Whether a test notices",
            "The code was changed in one place at a time, a seeded sample of all changes that the tool knows, and the "
            "quickest tests of that module were run. `bench/mutants.md` judges what no test noticed.",
            ["module", "possible changes", "tried", "noticed"],
            rows,
            _missing(result),
        )
    ]


def _missing(result: Result) -> list[str]:
    return [f"{peer}: {why}" for peer, why in sorted(result.get("missing", {}).items())]


#: The order of the report.
REPORTED: tuple[Callable[[Result], list[Table]], ...] = (
    forward, accuracy, symbolic, placing, sameness, imports, grading, many, hostile, building, pages, live, coverage,
    mutation,
)  # fmt: skip


def tables(folder: Path, name: str) -> tuple[list[Table], str]:
    """What a workload measured last, and of what, when and where; no tables where it was never measured.

    Raises
    ------
    KeyError
        If there is no such workload.
    """
    make = {each.__name__: each for each in REPORTED}[name]
    result = load(folder, name)
    return (make(result), provenance(result)) if result else ([], "")


def provenance(result: Result) -> str:
    """Say when and where something was measured."""
    machine = result["machine"]
    parts = [f"{result['date']}, {machine['processor']}, {machine['cores']} cores, Python {machine['python']}"]
    if machine.get("load") is not None:
        parts.append(f"load {machine['load']:.1f} at the start")
    if versions := result.get("versions"):
        parts.append(", ".join(f"{peer} {version}" for peer, version in sorted(versions.items())))
    return "; ".join(parts) + "."


def report(folder: Path) -> str:
    """Return the report: a view of what is stored in a folder."""
    lines = ["# Measured against the best", "", "Made by `make bench`; see README.md beside this file.", ""]
    for make in REPORTED:
        found, where = tables(folder, make.__name__)
        for table in found:
            lines += [f"## {table.title}", "", table.says, "", *markdown(table), ""]
            lines += [f"- {said}" for said in sentences(table)] + ([""] if table.aims or table.missing else [])
        if found:
            lines += [f"*{where}*", ""]
    return "\n".join(lines).rstrip() + "\n"


def sentences(table: Table) -> list[str]:
    """What was aimed at, and who is missing."""
    verdict = {True: "Reached", False: "**Not reached**"}
    aims = [f"{verdict[each.reached]}: {each.aim}; found {each.found}." for each in table.aims]
    return aims + [f"Not to be had: {line}." for line in table.missing]


def write_report(folder: Path, target: Path) -> None:
    """Write the report."""
    target.write_text(report(folder), encoding="utf-8")


def markdown(table: Table) -> Iterable[str]:
    """The table as Markdown, line by line."""
    yield "| " + " | ".join(table.header) + " |"
    yield "|" + "---|" * len(table.header)
    for row in table.rows:
        yield "| " + " | ".join(row) + " |"
