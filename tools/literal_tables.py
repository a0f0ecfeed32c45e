#!/usr/bin/env python3
"""The two tables of README.md, "The papers to the letter": the literal presets beside our pipelines, on simulated data and on sequences of your own.

    python3 tools/literal_tables.py OUT [--input SEQUENCE]... [--share S] [--columns N] [--corridors N] [--plumb FILE]

OUT becomes a folder with the runs and tables.md, which is printed too. --input adds rows for sequences of key frames from a car, with their truth.tum. --share
makes the simulated city and its frames that much smaller, --columns takes fewer rays a turn of its scanner, --corridors fewer drives in the plane: for a look.
The whole takes about a quarter of an hour. Tables 1 to 3 of the papers themselves, at their sizes: tools/paper_tables.py.
"""
import argparse
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from paper_tables import MATCHING, PRESETS, ROOT, mean, number, plumb, run, table  # noqa: E402

LETTER = PRESETS / "tang2024_literal.yaml"
OURS = ROOT / "pipelines/tang2024.yaml"
PLANAR = ROOT / "pipelines/zhang2023.yaml"
WITHOUT_OURS = ["followed.metric=point", "followed.search_below=none", "followed.odometry_sigma=none"]
# Column: (unimproved, with the paper's two improvements, what is set in both, where the registrations are counted).
PAIRS = {"to the letter": (PRESETS / "zhang2023_literal_unimproved.yaml", PRESETS / "zhang2023_literal.yaml", [], "chain"),
         "`zhang2023.yaml`, point to point, without search": (PRESETS / "zhang2023_unimproved.yaml", PLANAR, WITHOUT_OURS, "stitched"),
         "`zhang2023.yaml` as it is": (PRESETS / "zhang2023_unimproved.yaml", PLANAR, [], "stitched")}
# Row: (what the paper has, the value of a run).
REDUCTIONS = {"iterations of a registration": ("50.22 %", lambda numbers, cpu, stage: numbers[stage]["iterations"]),
              "time of a registration": ("39.67 %", lambda numbers, cpu, stage: cpu["followed"] / numbers[stage]["registrations"]),
              "mean displacement error, x": ("61.90 %", lambda numbers, cpu, stage: numbers["error"].get("fine.displacement_x")),
              "mean displacement error, y": ("62.86 %", lambda numbers, cpu, stage: numbers["error"].get("fine.displacement_y")),
              "largest map error": ("61.70 %", lambda numbers, cpu, stage: numbers["map_error"].get("largest")),
              "mean map error": ("43.24 %", lambda numbers, cpu, stage: numbers["map_error"].get("mean")),
              "time of matching": ("36.62 %", lambda numbers, cpu, stage: sum(cpu.values()))}


def in_space(options, title, sequence, *sets, preset=None):
    """A row: errors and eq. (3), to the letter and by tang2024.yaml."""
    found = []
    for pipeline in (LETTER, OURS):
        numbers, _ = run(options, pipeline, options.out / f"{sequence.name}_{pipeline.stem}", f"input={sequence}", f"truth={sequence / 'truth.tum'}", *sets,
                         preset=preset)
        found.append((numbers["error"], numbers["match_rmse"]))
    errors = [error.get(stage) for error, stage in ((found[0][0], "before.ate"), (found[0][0], "fine.ate"), (found[1][0], "fine.ate"))]
    rmse = [f"{number(one.get('before'), 2)} -> {number(one.get('fine'), 2)} m" for _, one in found]
    return [title, *(f"{number(error, 2)} m" for error in errors), *rmse]


def simulated(options, name, *words):
    plumb(options, "simulate", *words, "-o", options.out / name)
    return options.out / name


def rows_in_space(options):
    street = simulated(options, "street", "out_and_back", "--frames", 90, "--length", "180m", "--lines", 16, "--columns", 512, "--drift", 4)
    yield in_space(options, "simulated street, out and back, 180 m", street, "ranges.frames=6")
    length, frames = 2900 * options.share, max(48, round(2700 * options.share))
    city = simulated(options, "city", "blocks", "--frames", frames, "--length", f"{length:g}m", "--drift", 10 * options.share, "--columns", options.columns)
    cut = [] if options.share == 1 else [f"ranges.frames={max(4, round(60 * options.share))}"]
    yield in_space(options, f"simulated city, {length / 1000:.1f} km, 64 x {options.columns}", city, *cut)
    shutil.rmtree(city)
    for sequence in options.input:
        yield in_space(options, sequence.name, sequence, preset=PRESETS / "car_64line.yaml")


def runs_in_the_plane(options):
    """{column: ([runs unimproved], [runs improved])}, each run (numbers, CPU time by step)."""
    runs = {column: ([], []) for column in PAIRS}
    for seed in range(1, options.corridors + 1):
        building = simulated(options, f"corridor_{seed}", "corridor", "--seed", seed)
        for k, (column, (*both, sets, _)) in enumerate(PAIRS.items()):
            for to, pipeline in zip(runs[column], both):
                numbers, events = run(options, pipeline, options.out / f"corridor_{seed}_{k}_{pipeline.stem}", f"input={building / 'log.clf'}",
                                      f"truth={building / 'truth.tum'}", f"plan={building / 'plan.txt'}", *sets)
                cpu = {step: sum(event["cpu_seconds"] for event in events if event["event"] == "step_ends" and event["step"] == step) for step in MATCHING}
                to.append((numbers, cpu))
    return runs


def reduction(runs, stage, value):
    unimproved, improved = (mean([value(*one, stage) for one in each]) for each in runs)
    return "-" if improved is None or not unimproved else f"{100 * (1 - improved / unimproved):.1f} %"


def rows_in_the_plane(options):
    runs = runs_in_the_plane(options)
    for what, (paper, value) in REDUCTIONS.items():
        yield [what, paper, *(reduction(runs[column], stage, value) for column, (*_, stage) in PAIRS.items())]


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("out", type=Path, metavar="OUT")
    arguments.add_argument("--input", type=Path, action="append", default=[])
    arguments.add_argument("--share", type=float, default=1)
    arguments.add_argument("--columns", type=int, default=1024)
    arguments.add_argument("--corridors", type=int, default=5)
    arguments.add_argument("--plumb", type=Path, default=ROOT / "build/bin/plumb")
    options = arguments.parse_args()
    if not 0 < options.share <= 1:
        arguments.error("--share takes a number from 0 to 1")
    options.out.mkdir(parents=True, exist_ok=True)
    tables = [table("To the letter and ours", ["sequence", "ATE before", "to the letter", "`tang2024.yaml`", "eq. (3) to the letter", "`tang2024.yaml`"],
                    rows_in_space(options))]
    if options.corridors > 0:
        tables.append(table("What the improvements bring in the plane", ["reduction", "in the paper", *PAIRS], rows_in_the_plane(options)))
    (options.out / "tables.md").write_text("\n".join(tables))
    print("\n".join(tables), end="")


if __name__ == "__main__":
    main()
