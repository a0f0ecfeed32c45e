#!/usr/bin/env python3
"""Every C++ file is as clang-format leaves it, by .clang-format.

    python3 tests/tree/format_test.py [SOURCE]
"""
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

FOLDERS = ("framework", "plugins", "tools", "tests")


def misformatted(source, files):
    """Those of `files` that clang-format would change."""
    def of(batch):
        said = subprocess.run(["clang-format", "--dry-run", f"--style=file:{source / '.clang-format'}", *map(str, batch)],
                              capture_output=True, text=True)
        return {line.split(":")[0] for line in said.stderr.splitlines() if "[-Wclang-format-violations]" in line}
    batches = [files[k:k + 50] for k in range(0, len(files), 50)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return sorted(set().union(*pool.map(of, batches)))


if __name__ == "__main__":
    if not shutil.which("clang-format"):
        print("skipped: clang-format is not on this machine")
        sys.exit(77)
    source = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
    with tempfile.TemporaryDirectory() as folder:  # the judge itself
        wrong, right = Path(folder) / "wrong.cpp", Path(folder) / "right.cpp"
        wrong.write_text("int  main( ){return 0;}\n")
        right.write_text("int main() { return 0; }\n")
        assert misformatted(source, [wrong, right]) == [str(wrong)], misformatted(source, [wrong, right])
    files = [file for part in FOLDERS for file in sorted((source / part).rglob("*.[ch]pp"))]
    assert len(files) > 500, files
    found = misformatted(source, files)
    for file in found:
        print(f"{Path(file).relative_to(source)} is not as clang-format leaves it: run clang-format -i on it")
    sys.exit(1 if found else 0)
