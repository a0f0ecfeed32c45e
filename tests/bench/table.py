#!/usr/bin/env python3
"""Prints what plumb_bench measured as the table of plugins/README.md: a row per kernel, its time beside its twins'.

  plumb_bench --benchmark_repetitions=3 --benchmark_enable_random_interleaving=true --benchmark_out=bench.json --benchmark_out_format=json
  python3 tests/bench/table.py bench.json
"""
import collections
import json
import statistics
import sys


def told(seconds):
    for unit, size in (("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)):
        if seconds >= 0.9995 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-12:.3g} ps"


def main(file):
    # kernel and argument -> who -> times of one point or pair [s], one a repetition
    rows = collections.defaultdict(lambda: collections.defaultdict(list))
    what = {}
    with open(file) as text:
        runs = [run for run in json.load(text)["benchmarks"] if run["run_type"] == "iteration"]
    # In the order of announcing: ours before its twins, but libraries that were linked last come first.
    for run in sorted(runs, key=lambda run: run["family_index"]):
        kernel, who, *argument = run["run_name"].split("/")
        key = (kernel, *(part.replace(":", " ") for part in argument))
        rows[key][who].append(run["each"])
        what[key] = run["label"]
    print("| kernel | per | ours | twin | its time | ratio |\n|---|---|---|---|---|---|")
    kernels = list(dict.fromkeys(key[0] for key in rows))[::-1]
    for key, times in sorted(rows.items(), key=lambda row: kernels.index(row[0][0])):
        (ours, *twins) = [(who, statistics.median(values)) for who, values in times.items()]
        name = ", ".join(key) + ("" if ours[0] == "ours" else f": {ours[0]}")
        for who, time in twins or [("", None)]:
            its = f"{told(time)} | {time / ours[1]:.3g}" if time else " | "
            print(f"| {name} | {what[key]} | {told(ours[1])} | {who} | {its} |")


if __name__ == "__main__":
    main(sys.argv[1])
