#!/usr/bin/env python3
"""Each class of PCL, FLANN and CGAL that a step wraps has tests, a page and a benchmark, and the list of steps names it: a table of them.

    python3 tests/tree/wrapped_test.py [SOURCE]

Which header a step wraps is in tests/end_to_end/cases/libraries.py, which looks at what was compiled; this looks at the tree and needs no build.
"""
import os
import re
import sys
from pathlib import Path

SOURCE = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
os.environ["PLUMB_SOURCE"] = str(SOURCE)
sys.dont_write_bytecode = True
sys.path[:0] = [str(SOURCE / "tests/end_to_end"), str(SOURCE / "tests/end_to_end/cases")]

from libraries import WRAPPED  # noqa: E402
from plumb_test import steps_by_library  # noqa: E402

BENCH = SOURCE / "tests/bench"
LABEL = re.compile(r'"([^"/\n]+)/([^"/\n]+)"')  # of a benchmark: KERNEL/WHO


def folder_of(step):
    return SOURCE / "plugins" / step.replace(".", "/")


def labels_of(step, steps):
    """[(kernel, who)] of the benchmarks that call the step's kernel, and of those beside them."""
    short, path = step.split(".")[1], f"plugins/{step.replace('.', '/')}/"
    calling = [file for file in sorted(BENCH.glob("*.cpp")) if path in file.read_text()]
    if any(file.name == "pcl_steps.cpp" for file in calling):
        files = [file for file in sorted(BENCH.glob("*_bench.cpp")) if f"twins::{short}" in file.read_text()]
        own = {step, short}
    else:
        files = calling
        own = {who for file in files for _, who in LABEL.findall(file.read_text())} - steps
    labels = dict.fromkeys(label for file in files for label in LABEL.findall(file.read_text()) if "." not in label[0])
    kernels = {kernel for kernel, who in labels if who in own}
    return [label for label in labels if label[1] in own], [label for label in labels if label[0] in kernels and label[1] not in own]


def tests_of(step):
    return sum(len(re.findall(r"^(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\(", file.read_text(), re.M)) for file in folder_of(step).glob("*_test.cpp"))


def row(step, steps):
    """What there is of a step, as cells; an empty one is missing."""
    library = steps_by_library()[step][0].split()[0]
    page = (folder_of(step) / "README.md").read_text() if (folder_of(step) / "README.md").is_file() else ""
    tests, (own, twins) = tests_of(step), labels_of(step, steps)
    stated = [re.search(r'LICENCE "((?!SPDX)[^"$]*)"', file.read_text()) for file in (folder_of(step) / "CMakeLists.txt", SOURCE / "plugins/shared/pcl/CMakeLists.txt")]
    listed = f"({step.replace('.', '/')}/README.md)" in (SOURCE / "plugins/README.md").read_text()
    return [step, f"{library}: {WRAPPED[step]}", f"{tests} tests" if tests else "",
            f"{len(page.splitlines())} lines" if library in page and f"use: {step}" in page and listed else "",
            ", ".join(f"{kernel}/{who}" for kernel, who in own), ", ".join(f"{kernel}/{who}" for kernel, who in twins) or "-",
            re.sub(r"\\\n", "", next(found[1] for found in stated if found))]


def main():
    steps = {".".join(file.parts[-3:-1]) for file in (SOURCE / "plugins").glob("*/*/CMakeLists.txt")}
    print("| step | wraps | tests | page | benchmarks | beside | licence |\n| --- | --- | --- | --- | --- | --- | --- |")
    missing = []
    for step in sorted(WRAPPED):
        cells = row(step, steps)
        missing += [f"{step} has no {what}" for what, cell in zip(("test", "page that is listed", "benchmark"), cells[2:5]) if not cell]
        print("| " + " | ".join(cells) + " |")
    odd = sorted(set(WRAPPED) ^ set(steps_by_library()))
    missing += [f"{step} is in one of the lists of wrapped classes alone" for step in odd]
    print("\n".join([*missing, f"{len(WRAPPED)} classes, {len(missing)} faults"]))
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
