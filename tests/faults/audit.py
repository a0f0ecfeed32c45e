"""Holds what strace sees of undisturbed runs against what the layer counts, so that no call escapes the tests of faults.

    audit.py LAYER

Each run is made twice, from the same beginning: under strace, and with the layer. Calls of each kind on the world's paths must be as many;
removals count when they are done (remove() tries twice). Kinds of calls that the layer does not know are named. Exit 77 without strace.
"""
import re
import shutil
import sys
import tempfile
from collections import Counter
from pathlib import Path

import scenarios
from faults_test import Trial
from world import PLUMB, make_input, renewed, run

NAMES = {"open": "open openat creat opendir", "close": "close", "read": "read pread64 readv", "write": "write pwrite64 writev pwritev",
         "rename": "rename renameat renameat2", "mkdir": "mkdir mkdirat", "link": "link linkat", "symlink": "symlink symlinkat",
         "chmod": "chmod fchmodat", "unlink": "unlink unlinkat rmdir remove"}
KINDS = {name: kind for kind, names in NAMES.items() for name in names.split()}
COUNTED = {"fsync", "fdatasync", "syncfs", "ftruncate", "flock", "mmap", "fchmod", "fchown"} | set(KINDS)
# Only looked at, and partly by the C library for itself: opendir asks what it opened, realpath follows links. dup2 puts the channel of a worker to be
# over a number that it inherits.
LOOKED = set("newfstatat fstat stat lstat statx statfs fstatfs statvfs access faccessat faccessat2 readlink readlinkat realpath getdents64 readdir "
             "fcntl lseek fadvise64 execve dup2".split())


def of_strace(file, world):
    counts, paths = Counter(), re.compile(re.escape(str(world)) + r"[/\">]")
    for line in file.read_text(errors="replace").splitlines():
        call = re.match(r"\d+ +(\w+)\(", line)
        if call and paths.search(line):
            done = "= 0" in line or "unfinished" in line
            if KINDS.get(call[1], call[1]) != "unlink" or done:
                counts[call[1]] += 1
    return counts


def of_layer(calls):
    return Counter(call.name for call in calls if KINDS.get(call.name, call.name) != "unlink" or call.result >= 0)


def by_kind(counts):
    kinds = Counter()
    for name, count in counts.items():
        if name in COUNTED:
            kinds[KINDS.get(name, name)] += count
    return kinds


def differences(scenario, work, layer):
    """By kind of call: a sentence on what the two runs of a scenario do not agree in."""
    trial = Trial(scenario, work, layer)
    world, trace = work / "world", work / "trace"
    renewed(world, trial.template)
    said = run(scenario.command(work, world), program=["strace", "-f", "-y", "-o", trace, PLUMB])
    assert said.code == 0, said
    seen, counted = of_strace(trace, world), of_layer(trial.calls)
    found = {name: f"{scenario.name}: {name}, which the layer does not know" for name in seen if name not in COUNTED | LOOKED}
    for kind in sorted(by_kind(seen) | by_kind(counted)):
        if by_kind(seen)[kind] != by_kind(counted)[kind]:
            found[kind] = f"{scenario.name}: {by_kind(seen)[kind]} calls of {kind} by strace, {by_kind(counted)[kind]} by the layer"
    print(f"{scenario.name}: {sum(by_kind(counted).values())} calls, looked at {len(trial.calls) - sum(by_kind(counted).values())} times")
    return found


def main():
    if not shutil.which("strace"):
        print("skipped: strace is not there")
        return 77
    layer = Path(sys.argv[1]).resolve()
    work = Path(tempfile.mkdtemp(prefix="plumb_audit_")).resolve()
    make_input(work)
    escaped = []
    for scenario in scenarios.ALL:
        found = differences(scenario, work, layer)
        for _ in range(3):  # threads may make a call more or less in one run than in another; what escapes does so each time
            if found:
                again = differences(scenario, work, layer)
                found = {kind: sentence for kind, sentence in again.items() if kind in found}
        escaped += found.values()
    print("\n".join(escaped) or "no call escapes")
    shutil.rmtree(work, ignore_errors=True)
    return 1 if escaped else 0


if __name__ == "__main__":
    sys.exit(main())
