#!/usr/bin/env python3
"""clang-tidy finds nothing in the core (.clang-tidy says which checks).

    python3 tests/tree/tidy_test.py SOURCE BUILD

Each file is read without the precompiled header, so that it is also seen to include what it needs. What was found clean is not looked at again as long as
the file, the headers of ours that it includes, and .clang-tidy stay as they are (BUILD/tidy).
"""
import concurrent.futures
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

CORE = re.compile(r"framework/plumb/(data|plugin|pipeline|store|engine)/(?!.*(_test\.cpp|/testing/))")
INCLUDE = re.compile(r'^#include "(plumb/[^"]+)"', re.M)


def command_for_clang(command):
    """Of g++ with a precompiled header to what clang reads."""
    command = command.split("ccache ")[-1]
    return re.sub(r"-include \S+|-Winvalid-pch|-Wno-restrict|-Wno-error=\S+|-Werror\b", "", command)


def main(source, build):
    if not shutil.which("clang-tidy"):
        print("skipped: clang-tidy is not on this machine")
        return 77
    folder = build / "tidy"
    folder.mkdir(exist_ok=True)
    database = json.loads((build / "compile_commands.json").read_text())
    if any("/Unity/unity_" in entry["file"] for entry in database):
        print("skipped: this build compiles files in batches (PLUMB_UNITY), of which clang-tidy sees no single one")
        return 77
    entries = [{**entry, "command": command_for_clang(entry["command"])} for entry in database if CORE.search(entry["file"])]
    (folder / "compile_commands.json").write_text(json.dumps(entries))
    rules = (source / ".clang-tidy").read_bytes()

    @cache
    def includes_of(file):
        found = set()
        for name in INCLUDE.findall(file.read_text()):
            header = source / "framework" / name
            if header.exists():
                found.add(header)
        return found

    def state_of(file):
        seen, ahead = set(), [file]
        while ahead:
            at = ahead.pop()
            if at not in seen:
                seen.add(at)
                ahead += includes_of(at)
        digest = hashlib.sha256(rules)
        for one in sorted(seen):
            digest.update(one.read_bytes())
        return digest.hexdigest()

    def faults_of(file):
        mark = folder / (str(file.relative_to(source)).replace("/", "_") + ".clean")
        state = state_of(file)
        if mark.exists() and mark.read_text() == state:
            return ""
        done = subprocess.run(["clang-tidy", "-p", str(folder), "--quiet", str(file)], capture_output=True, text=True)
        if done.returncode == 0:
            mark.write_text(state)
            return ""
        return done.stdout + done.stderr

    files = sorted({Path(entry["file"]) for entry in entries})
    if len(files) < 80:
        print(f"only {len(files)} files of the core are in {build}/compile_commands.json")
        return 1
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for file, told in zip(files, pool.map(faults_of, files)):
            if told:
                failed += 1
                print(f"{file.relative_to(source)}\n{told}")
    print(f"{len(files)} files, {failed} with faults")
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()))
