#!/usr/bin/env python3
"""What the compiler read for the core and its tests: no header of Eigen, none of plumb/slam.

    python3 tests/tree/dependencies_test.py BUILD

includes_test.py judges the lines that we wrote; this judges what came of them, by the dependency files that the compiler left (`ninja -t deps`).
"""
import re
import shutil
import subprocess
import sys

CORE = re.compile(r"framework/CMakeFiles/(plumb|test_data|test_plugin|test_pipeline|test_store|test_engine|plumb_precompiled_for_core_tests)\.dir/")
FORBIDDEN = re.compile(r"/Eigen/|/plumb/slam/|/pcl/|/ceres/")


def faults_in(text):
    """Of the output of `ninja -t deps`: (object, header) for each that must not be, and how many objects of the core there are."""
    faults, objects, current = [], 0, ""
    for line in text.splitlines():
        if line and not line.startswith(" "):
            current = line.split(": #deps")[0]
            objects += bool(CORE.search(current))
        elif line.strip() and CORE.search(current) and FORBIDDEN.search(line):
            faults.append((current, line.strip()))
    return faults, objects


def try_itself():
    told = ("framework/CMakeFiles/plumb.dir/plumb/data/hash.cpp.o: #deps 2, deps mtime 1 (VALID)\n    a/framework/plumb/data/hash.hpp\n    /usr/include/eigen3/Eigen/Core\n\n"
            "framework/CMakeFiles/test_store.dir/plumb/store/store_test.cpp.o: #deps 1, deps mtime 1 (VALID)\n    a/framework/plumb/slam/cloud.hpp\n\n"
            "framework/CMakeFiles/plumb_slam.dir/plumb/slam/cloud.cpp.o: #deps 1, deps mtime 1 (VALID)\n    /usr/include/eigen3/Eigen/Core\n")
    faults, objects = faults_in(told)
    assert objects == 2 and [header.rsplit("/", 1)[1] for _, header in faults] == ["Core", "cloud.hpp"], (faults, objects)


def main():
    try_itself()
    if not shutil.which("ninja"):
        print("skipped: there is no ninja")
        return 77
    done = subprocess.run(["ninja", "-C", sys.argv[1], "-t", "deps"], capture_output=True, text=True)
    faults, objects = faults_in(done.stdout)
    if objects < 60:  # with PLUMB_UNITY twelve files of the core are one
        print(f"only {objects} objects of the core are known to ninja in {sys.argv[1]}: build all of it first\n{done.stderr}")
        return 1
    for compiled, header in faults:
        print(f"{compiled} reads {header}")
    print(f"{objects} objects of the core and its tests")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
