#!/usr/bin/env python3
"""How much of the loops may be wrong? Spoils some of them inside of a shipped pipeline and compares its error with that of the clean run.

    python3 tools/false_loops.py OUT [--pipeline plumb|tang2024] [--share PERCENT]... [--how alone|fives] [--input SEQUENCE]...
                                     [--simulated N] [--seeds N] [--columns N] [--set NAME=VALUE]... [--plumb FILE] [--modules DIR]

OUT becomes a folder with N simulated streets (four), the cache, the runs, and false_loops.json and .md, which is printed too. The step test.false_loops (of
the tests' modules) stands before the pipeline judges its loops: it moves the given shares of them (10, 30 and 50 %) by 2 to 20 m and turns them by up to 20
degrees, each in a way of its own ("alone"), or five near each other in the same way, so that they agree ("fives"). Each share is drawn --seeds times.
Exit 1 where the error rises by more than 10 % on some input: by up to 30 % wrong ones alone, or by any share of fives of which one was kept.
What lies in OUT is not made again: killed, it goes on.
"""
import argparse
import json
import math
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# Route of the simulator and its length [m]: a frame every 2 m, a drift of 1.5 % of the path.
STREETS = [("out_and_back", 400), ("figure_eight", 600), ("city_loop", 800), ("blocks", 1500)]
HOW = {"alone": 1, "fives": 5}
DONE, FAILED, WORSE = 0, 3, 5  # of `plumb compare`; a variant that is worse is a result
KEPT = ("accepted", "down-weighted")
HIGHEST_RATIO, HIGHEST_SHARE = 1.1, 30

# What a variant does to the pipeline: loops are spoilt before they are judged, and metrics.json says which.
EDITS = {"plumb": """
    add:
      drift.spoilt:
        use: test.false_loops
        from: {registrations: registered, poses: poses, scale: scale}
        with: {share: %(share)g %%, together: %(together)d}
    replace:
      drift.loops: {use: prune.loop_consistency, from: {registrations: spoilt, poses: poses, scale: scale}, with: {translation_per_metre: $drift}}
      metrics: {use: write.metrics, from: {metrics: {spoilt: drift.spoilt.metrics, loops: drift.loops.metrics, error: error}}}
""", "tang2024": """
    add:
      drift.spoilt:
        use: test.false_matches
        from: {matches: matches, poses: ranges.poses}
        with: {share: %(share)g %%, together: %(together)d}
    replace:
      drift.near:
        use: prune.distance
        from: {matches: spoilt, poses: ranges.poses, edges: edges}
        with: {max_correspondence_distance: $drift_max_correspondence_distance, loop_margin: $loop_margin}
      metrics: {use: write.metrics, from: {metrics: {spoilt: drift.spoilt.metrics, loops: drift.solved.metrics, error: error}}}
"""}


def called(options, *words, good=(DONE,)):
    command = [str(options.plumb), "--plugin-path", str(options.modules), *map(str, words)]
    code = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
    if code not in good:
        sys.exit(f"exit {code}: $ {' '.join(command)}")


def streets(options):
    """The simulated inputs; one that is there is whole."""
    made = []
    for route, length in STREETS[:options.simulated]:
        street = options.out / f"{route}_{length}m"
        if not street.is_dir():
            called(options, "simulate", route, "--length", f"{length}m", "--frames", length // 2, "--drift", f"{0.015 * length:g}m",
                   "--columns", options.columns, "-o", street)
        made.append(street)
    return made


def variants(options):
    """{name: (how, share [%])}."""
    return {f"{how}_{share:g}": (how, share) for how in options.how for share in options.share}


def compared(options):
    """Runs the experiment; [(variant, input, replicate, error [m])]."""
    (options.out / "clean.yaml").write_text(f"plumb: 1\nname: clean\nextends: {ROOT / 'pipelines' / options.pipeline}.yaml\nremove: [map]\n")
    text = "experiment: 1\nname: false_loops\npipeline: clean.yaml\nprimary: error.fine.ate\nmargin: 10 %\nvariants:\n"
    for name, (how, share) in variants(options).items():
        text += f"  {name}:" + EDITS[options.pipeline] % {"share": share, "together": HOW[how]}
    if options.seeds > 1:
        text += f"replicates: {{count: {options.seeds}, seeds: true}}\n"
    (options.out / "false_loops.yaml").write_text(text)
    inputs = [word for each in [*streets(options), *options.input] for word in ("--input", each)]
    sets = [word for each in options.set for word in ("--set", each)]
    called(options, "compare", options.out / "false_loops.yaml", *inputs, *sets, "--cache-dir", options.out / "cache", "-o", options.out / "runs",
           "--save", options.out / "compared.json", good=(DONE, FAILED, WORSE))
    runs = json.loads((options.out / "compared.json").read_text())["runs"]
    return [(run["variant"], run["input"], run["replicate"],
             next((number["value"] for number in run["numbers"] if number["name"] == "error.fine.ate"), None)) for run in runs]


def loops_of(folder):
    """Of one run: how many loops there were, how many were spoilt, how many of these were kept, and how many of the others were not."""
    stages = {stage["stage"]: stage for stage in json.loads((folder / "metrics.json").read_text())["stages"]}
    spoilt = {(edge["i"], edge["j"]): edge["status"] == "spoilt" for edge in stages["spoilt"]["edges"]}
    kept = {(edge["i"], edge["j"]) for edge in stages["loops"]["edges"] if edge["status"] in KEPT}
    return {"loops": len(spoilt), "spoilt": sum(spoilt.values()), "spoilt_kept": sum(spoilt[loop] for loop in kept & spoilt.keys()),
            "others_left_out": sum(not wrong and loop not in kept for loop, wrong in spoilt.items())}


def rows_of(options, runs):
    """What came of each spoilt run, beside the clean run of the same input and replicate."""
    clean = {(name, replicate): ate for variant, name, replicate, ate in runs if variant == "clean"}
    rows = []
    for variant, name, replicate, ate in runs:
        if variant == "clean":
            continue
        how, share = variants(options)[variant]
        row = {"how": how, "share": share, "input": name, "seed": replicate, "clean": clean[name, replicate], "ate": ate}
        if ate is not None:
            folder = options.out / "runs" / variant / name
            row |= loops_of(folder / f"replicate_{replicate}" if options.seeds > 1 else folder)
            row["ratio"] = ate / row["clean"] if row["clean"] else None
        rows.append(row)
    return rows


def mean_ratio(rows):
    """The geometric mean; infinite where a run gave nothing."""
    ratios = [row.get("ratio") for row in rows]
    return math.inf if None in ratios else math.exp(sum(map(math.log, ratios)) / len(ratios))


def holds(how, share, rows):
    """Of one input: whether the error stays, or what is wrong was left out; None where neither is asked."""
    if share > HIGHEST_SHARE and how == "alone":
        return None
    left_out = all(row.get("spoilt_kept") == 0 for row in rows)
    return mean_ratio(rows) <= HIGHEST_RATIO or (how == "fives" and left_out)


def summary(rows):
    """The table, and whether all of it holds."""
    lines = ["| wrong loops | share | loops | wrong ones kept | right ones left out | error / clean error | highest, on | holds |",
             "| --- | ---: | ---: | ---: | ---: | ---: | --- | --- |"]
    good = True
    for how, share in dict.fromkeys((row["how"], row["share"]) for row in rows):
        of = [row for row in rows if (row["how"], row["share"]) == (how, share)]
        by_input = {name: [row for row in of if row["input"] == name] for name in dict.fromkeys(row["input"] for row in of)}
        loops, spoilt, kept, left_out = (sum(row.get(key, 0) for row in of) for key in ("loops", "spoilt", "spoilt_kept", "others_left_out"))
        highest = max(by_input, key=lambda name: mean_ratio(by_input[name]))
        verdicts = [holds(how, share, each) for each in by_input.values()]
        good = good and False not in verdicts
        said = "-" if None in verdicts else f"on {sum(verdicts)} of {len(verdicts)} inputs"
        lines.append(f"| {how} | {share:g} % | {spoilt} of {loops} | {kept} | {left_out} of {loops - spoilt} | {mean_ratio(of):.3f} | "
                     f"{mean_ratio(by_input[highest]):.3f}, {highest} | {said} |")
    lines += ["", "| input | clean error [m] |", "| --- | ---: |"]
    for name in dict.fromkeys(row["input"] for row in rows):
        values = [row["clean"] for row in rows if row["input"] == name]
        lines.append(f"| {name} | " + ("failed" if None in values else f"{sum(values) / len(values):.3f}") + " |")
    return "\n".join(lines) + "\n", good


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("out", type=Path, metavar="OUT")
    arguments.add_argument("--pipeline", choices=list(EDITS), default="plumb")
    arguments.add_argument("--share", type=float, action="append", metavar="PERCENT")
    arguments.add_argument("--how", choices=list(HOW), action="append")
    arguments.add_argument("--input", type=Path, action="append", default=[])
    arguments.add_argument("--simulated", type=int, choices=range(len(STREETS) + 1), default=len(STREETS), metavar="N")
    arguments.add_argument("--seeds", type=int, default=3)
    arguments.add_argument("--columns", type=int, default=512)
    arguments.add_argument("--set", action="append", default=[])
    arguments.add_argument("--plumb", type=Path, default=ROOT / "build/bin/plumb")
    arguments.add_argument("--modules", type=Path, default=ROOT / "build/tests/end_to_end/modules")
    options = arguments.parse_args()
    options.share, options.how = options.share or [10, 30, 50], options.how or list(HOW)
    options.out.mkdir(parents=True, exist_ok=True)
    rows = rows_of(options, compared(options))
    text, good = summary(rows)
    (options.out / "false_loops.json").write_text(json.dumps(rows, indent=1) + "\n")
    (options.out / "false_loops.md").write_text(text)
    print(text, end="")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
