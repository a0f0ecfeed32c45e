#!/usr/bin/env python3
"""Tables 1, 2 and 3 of both papers for simulated data of their sizes: to the letter, and by the pipelines of this project beside it.

    python3 tools/paper_tables.py OUT [--paper tang2024|zhang2023] [--data N]... [--share S] [--columns N] [--keep] [--plumb FILE]

OUT becomes a folder with the runs and tables.md, which is printed too. --data picks data sets of Tang et al. (1 to 4). --share makes all paths and their
frames that much shorter, --columns takes fewer rays a turn of the cars' scanners: for a look. A sequence of Tang et al. takes up to 3 GB and is removed
after its runs unless --keep is given. Nothing is taken from a cache, so that times are those of whole runs.
"""
import argparse
import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PRESETS = ROOT / "pipelines/presets"
TANG = {"to the letter": PRESETS / "tang2024_literal.yaml", "tang2024": ROOT / "pipelines/tang2024.yaml", "plumb": ROOT / "pipelines/plumb.yaml"}
ZHANG = {"unimproved": PRESETS / "zhang2023_literal_unimproved.yaml", "to the letter": PRESETS / "zhang2023_literal.yaml",
         "zhang2023": ROOT / "pipelines/zhang2023.yaml"}
HANDHELD = ["--lines", 32, "--columns", 512, "--lowest", "-35deg", "--highest", "35deg"]
# Table 1 of Tang et al.: route of ours, path [m], frames, scanning time [s], and as drift the match RMSE before [m] of their table 3.
DATA = {1: ("city_loop", 410, 2018, 797, 2.667), 2: ("blocks", 2930, 2700, 265, 10.348),
        3: ("blocks", 3580, 3420, 344, 19.018), 4: ("out_and_back", 2010, 3180, 322, 3.412)}
SEEDS = (1, 2, 3, 4, 5)  # Zhang et al. drive five times
MATCHING = ("followed", "matched", "judged", "fine.matched")  # steps of the 2-D pipelines that register scans


def plumb(options, *words):
    command = [str(options.plumb), *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"$ {' '.join(command)}\n{done.stdout}{done.stderr}")


def run(options, pipeline, out, *sets, preset=None):
    """{stage: {number: value}} of the metrics, and the events."""
    events = Path(f"{out}.jsonl")
    words = (["--preset", preset] if preset else []) + [word for each in sets for word in ("--set", each)]
    plumb(options, "run", pipeline, *words, "--no-cache", "--events", events, "--quiet", "-o", out)
    stages = json.loads((out / "metrics.json").read_text())["stages"]
    return ({stage["stage"]: {name: number["value"] for name, number in stage["numbers"].items()} for stage in stages},
            [json.loads(line) for line in events.read_text().splitlines()])


def path_and_time(truth):
    """Length [m], duration [s] and number of poses of a TUM trajectory."""
    rows = [[float(word) for word in line.split()[:4]] for line in truth.read_text().splitlines() if line and not line.startswith("#")]
    return sum(math.dist(a[1:], b[1:]) for a, b in zip(rows, rows[1:])), rows[-1][0] - rows[0][0], len(rows)


def table(title, head, rows):
    text = [f"**{title}**", "", "| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(text + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def number(value, digits=3):
    return "-" if value is None else f"{value:.{digits}f}"


def tang(options):
    first, second, third = [], [], []
    for n in options.data or DATA:
        route, length, frames, seconds, drift = DATA[n]
        length, drift, few = length * options.share, drift * options.share, max(24, round(frames * options.share))
        sequence = options.out / f"data_{n}"
        scanner = HANDHELD if n == 1 else ["--columns", options.columns]
        plumb(options, "simulate", route, "--length", f"{length:.6f}m", "--frames", few, "--rate", f"{frames / seconds:.6f}Hz", "--drift", f"{drift:.6f}m", "--seed", n,
              *scanner, "-o", sequence)
        path, time, poses = path_and_time(sequence / "truth.tum")
        first.append([f"Data {n}", number(path, 0), poses, number(time, 0)])
        for name, pipeline in TANG.items():
            cut = [] if name == "plumb" else [f"ranges.frames={min(60, max(4, few // 12))}"]
            numbers, events = run(options, pipeline, options.out / f"data_{n}_{pipeline.stem}", f"input={sequence}", f"truth={sequence / 'truth.tum'}", *cut)
            passes = {repeat: sum(e["event"] == "pass_begins" and e["step"] == repeat for e in events) or None for repeat in ("coarse", "fine")}
            second.append([f"Data {n}", name, number(events[-1]["duration"], 0), passes["coarse"] or "-", passes["fine"] or "-"])
            rmse, error = numbers["match_rmse"], numbers["error"]
            for stage in ("before", "local", "drift", "coarse", "fine"):
                if stage in rmse:
                    third.append([f"Data {n}", name, stage, number(rmse[stage]), number(error.get(f"{stage}.ate"))])
        if not options.keep:
            shutil.rmtree(sequence)
    return [table("Tang et al., table 1: simulated data", ["", "path [m]", "frames", "scanning time [s]"], first),
            table("Tang et al., table 2", ["", "pipeline", "time [s]", "coarse passes", "fine passes"], second),
            table("Tang et al., table 3, eq. (3), and beside it the error against the truth",
                  ["", "pipeline", "stage", "match RMSE [m]", "ATE [m]"], third)]


def mean(values):
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else None


def zhang(options):
    runs = {name: [] for name in ZHANG}
    for seed in SEEDS if options.share == 1 else SEEDS[:1]:
        building = options.out / f"corridor_{seed}"
        length = [] if options.share == 1 else ["--length", f"{max(14, 36 * options.share):.6f}m"]
        plumb(options, "simulate", "corridor", *length, "--seed", seed, "-o", building)
        for name, pipeline in ZHANG.items():
            numbers, events = run(options, pipeline, options.out / f"corridor_{seed}_{pipeline.stem}", f"input={building / 'log.clf'}",
                                  f"truth={building / 'truth.tum'}", f"plan={building / 'plan.txt'}")
            cpu = {step: sum(e["cpu_seconds"] for e in events if e["event"] == "step_ends" and e["step"] == step) for step in MATCHING}
            runs[name].append((numbers, cpu))

    def row(what, digits, value, names=ZHANG):
        values = {name: mean([value(*one) for one in runs[name]]) for name in names}
        first = values["unimproved"]
        less = ["-" if v is None or not first else f"{100 * (1 - v / first):.1f} %" for v in list(values.values())[1:]]
        return [what, *(number(v, digits) for v in values.values()), *less]

    both = ["unimproved", "to the letter"]
    head = ["", *ZHANG, *(f"{name}: less by" for name in list(ZHANG)[1:])]
    return [table("Zhang et al., table 1: adjacent scans", ["", "ICP", "IA-ICP", "less by"],
                  [row("iterations", 2, lambda numbers, cpu: numbers["chain"]["iterations"], both),
                   row("time [CPU ms]", 3, lambda numbers, cpu: 1e3 * cpu["followed"] / numbers["chain"]["registrations"], both)]),
            table("Zhang et al., table 2: mean displacement error", head,
                  [row(f"{axis} [m]", 3, lambda numbers, cpu, axis=axis: numbers["error"].get(f"fine.displacement_{axis}")) for axis in "xy"]),
            table("Zhang et al., table 3: map", head,
                  [row("largest error [m]", 3, lambda numbers, cpu: numbers["map_error"].get("largest")),
                   row("mean error [m]", 3, lambda numbers, cpu: numbers["map_error"].get("mean")),
                   row("matching [CPU s]", 3, lambda numbers, cpu: sum(cpu.values())),
                   row("accuracy", 3, lambda numbers, cpu: numbers["map_error"].get("accuracy"))])]


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("out", type=Path, metavar="OUT")
    arguments.add_argument("--paper", choices=["tang2024", "zhang2023"])
    arguments.add_argument("--data", type=int, choices=list(DATA), action="append")
    arguments.add_argument("--share", type=float, default=1)
    arguments.add_argument("--columns", type=int, default=1024)
    arguments.add_argument("--keep", action="store_true")
    arguments.add_argument("--plumb", type=Path, default=ROOT / "build/bin/plumb")
    options = arguments.parse_args()
    if not 0 < options.share <= 1:
        arguments.error("--share takes a number from 0 to 1")
    options.out.mkdir(parents=True, exist_ok=True)
    tables = [] if options.paper == "zhang2023" else tang(options)
    tables += [] if options.paper == "tang2024" else zhang(options)
    (options.out / "tables.md").write_text("\n".join(tables))
    print("\n".join(tables), end="")


if __name__ == "__main__":
    main()
