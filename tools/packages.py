#!/usr/bin/env python3
"""Does it matter which part is used? Runs pipelines/experiments/packages.yaml and writes its tables into pipelines/experiments/README.md.

    python3 tools/packages.py OUT [--input SEQUENCE]... [--simulated N] [--columns N] [--replicates N] [--page FILE] [--plumb FILE]
    python3 tools/packages.py --from RESULT.json [--page FILE]

OUT becomes a folder with N simulated streets (ten, without which none of so many variants can be better or worse), the cache, and the result (packages.json, .csv, .md,
.svg). --input adds sequences of key frames from a car, with their truth.tum. What lies in OUT is not made again: killed, it goes on. Each time it says in
another file what it makes (events_1.jsonl, events_2.jsonl, ...). --from writes the tables of a result that is there. The ten take an hour or two.
"""
import argparse
import json
import math
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
EXPERIMENT = ROOT / "pipelines/experiments/packages.yaml"
PAGE = ROOT / "pipelines/experiments/README.md"
BEGIN, END = "<!-- tools/packages.py writes what follows -->\n", "<!-- and this is where it ends -->\n"
# Route of the simulator and its seed. A frame every 2 m, a drift of 1.5 % of the path.
STREETS = [("city_loop", 400, 1), ("figure_eight", 500, 1), ("out_and_back", 400, 1), ("blocks", 600, 1), ("city_loop", 400, 2),
           ("figure_eight", 500, 2), ("out_and_back", 400, 2), ("blocks", 600, 2), ("city_loop", 400, 3), ("out_and_back", 400, 3)]
DONE, FAILED, WORSE = 0, 3, 5  # of `plumb compare`: a run that failed and a variant that is worse are results


def called(options, *words, good=(DONE,)):
    command = [str(options.plumb), *map(str, words)]
    code = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
    if code not in good:
        sys.exit(f"exit {code}: $ {' '.join(command)}")


def streets(options):
    """The simulated inputs; one that is there is whole."""
    made = []
    for route, length, seed in STREETS[:options.simulated]:
        street = options.out / f"{route}_{seed}"
        if not street.is_dir():
            called(options, "simulate", route, "--length", f"{length}m", "--frames", length // 2, "--drift", f"{0.015 * length:g}m", "--seed", seed,
                   "--columns", options.columns, "-o", street)
        made.append(street)
    return made


def compared(options):
    """The result's file."""
    inputs = [word for each in [*streets(options), *options.input] for word in ("--input", each)]
    replicates = ["--replicates", options.replicates] if options.replicates else []
    saved = [word for ending in ("json", "csv", "md", "svg") for word in ("--save", options.out / f"packages.{ending}")]
    events = next(file for n in range(1, 1000) if not (file := options.out / f"events_{n}.jsonl").exists())
    called(options, "compare", EXPERIMENT, *inputs, *replicates, "--cache-dir", options.out / "cache", "--events", events, *saved, good=(DONE, FAILED, WORSE))
    return options.out / "packages.json"


def percent(ratio):
    return f"{100 * (ratio - 1):+.{0 if abs(ratio - 1) >= 0.095 else 1}f} %"


def number_of(outcome, name):
    return next((number for number in outcome["numbers"] if number["name"] == name), None)


def against(number, variant):
    """What a variant's number is against the pipeline's; {} where it has none."""
    return number["variants"].get(variant, {}).get("against", {}) if number else {}


def effect(found):
    """The ratio and its interval, in percent."""
    if "ratio" not in found:
        return "-"
    low_high = found.get("interval")
    return percent(found["ratio"]) + (f" ({percent(low_high[0])} to {percent(low_high[1])})" if low_high else "")


def table(head, rows):
    lines = [head, ["---"] + ["---:"] * (len(head) - 1), *rows]
    return "".join("| " + " | ".join(map(str, line)) + " |\n" for line in lines)


def verdict(found, outcome):
    if not found:
        return "no result"
    if found["failed_inputs"]:
        return f"no result on {found['failed_inputs']} of {len(outcome['inputs'])} inputs"
    return found["verdict"] + (", on these data" if found["on_these_data"] and found["method"] != "identical" else "")


def variants_of(outcome):
    primary, rmse = number_of(outcome, outcome["primary"]), number_of(outcome, "match_rmse.fine")
    rows = []
    for variant in outcome["variants"][1:]:
        found = against(primary, variant)
        lower = sum(one < 1 for one in found.get("by_input", []))
        higher = sum(one > 1 for one in found.get("by_input", []))
        p = found.get("adjusted_p")
        rows.append((found.get("ratio", math.inf),
                     [f"`{variant}`", effect(found), f"{lower} / {higher}", "-" if p is None else f"{p:.2g}", verdict(found, outcome), effect(against(rmse, variant))]))
    return table(["variant", "error (95 %)", "lower / higher on", "p", "verdict", "match RMSE (95 %)"], [row for _, row in sorted(rows, key=lambda row: row[0])])


def inputs_of(outcome):
    primary = number_of(outcome, outcome["primary"])
    reference, rows = outcome["reference"], []
    for k, name in enumerate(outcome["inputs"]):
        known = {variant: of["values"][k] for variant, of in primary["variants"].items() if of["values"][k] is not None}
        others = {variant: value for variant, value in known.items() if variant != reference}
        ends = [f"{others[v]:.3f} (`{v}`)" for pick in (min, max) for v in [pick(others, key=others.get)]] if others else ["-", "-"]
        rows.append([name, f"{known[reference]:.3f}" if reference in known else "-", *ends])
    return table(["input", f"`{reference}` [m]", "lowest [m]", "highest [m]"], rows)


def tables_of(outcome):
    n, m = len(outcome["inputs"]), len(outcome["variants"]) - 1
    if number_of(outcome, outcome["primary"]) is None:
        sys.exit(f"no two variants have the number {outcome['primary']}: nothing was compared")
    failed = sum("failed" in run for run in outcome["runs"])
    return (f"{m} variants on {n} inputs{', in ' + str(outcome['replicates']['count']) + ' replicates' if outcome['replicates']['count'] > 1 else ''}; "
            f"{failed or 'no'} runs failed. `{outcome['primary']}` decides; p is Holm's for {m} variants; up to {100 * outcome['margin']:g} % counts as equivalent.\n\n"
            + variants_of(outcome) + "\n" + inputs_of(outcome))


def write(page, text):
    before, begin, rest = page.read_text().partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        sys.exit(f"{page}: the lines between which the tables stand are not there")
    page.write_text(before + BEGIN + "\n" + text + "\n" + END + after)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("out", type=Path, metavar="OUT", nargs="?")
    arguments.add_argument("--from", type=Path, dest="result", metavar="RESULT.json")
    arguments.add_argument("--input", type=Path, action="append", default=[])
    arguments.add_argument("--simulated", type=int, choices=range(len(STREETS) + 1), default=len(STREETS), metavar="N")
    arguments.add_argument("--columns", type=int, default=512)
    arguments.add_argument("--replicates", type=int)
    arguments.add_argument("--page", type=Path, default=PAGE)
    arguments.add_argument("--plumb", type=Path, default=ROOT / "build/bin/plumb")
    options = arguments.parse_args()
    if (options.out is None) == (options.result is None):
        arguments.error("give OUT, or the result with --from")
    if options.out:
        options.out.mkdir(parents=True, exist_ok=True)
    text = tables_of(json.loads((options.result or compared(options)).read_text()))
    write(options.page, text)
    print(text, end="")


if __name__ == "__main__":
    main()
