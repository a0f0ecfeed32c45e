"""Loops that are wrong, in shares that are known, inside of the shipped pipelines: tools/false_loops.py on a small street."""
import json
import subprocess
import sys

from plumb_test import BUILD, PLUMB, SOURCE, plumb, sequence

TOOL = [sys.executable, str(SOURCE / "tools/false_loops.py")]
MODULES = BUILD / "tests/end_to_end/modules"


def rows(folder, street, *options):
    """What came of each run, and how the tool ended."""
    done = subprocess.run([*TOOL, str(folder / "out"), "--simulated", "0", "--input", str(street), "--seeds", "1", "--plumb", str(PLUMB), "--modules",
                           str(MODULES), *options], capture_output=True, text=True)
    print(done.stdout)
    assert done.returncode in (0, 1) and (folder / "out/false_loops.md").read_text() == done.stdout, done.stdout + done.stderr
    found = json.loads((folder / "out/false_loops.json").read_text())
    for row in found:
        wanted = row["share"] / 100 * row["loops"]
        assert row["spoilt"] % 5 == 0 if row["how"] == "fives" else abs(row["spoilt"] - wanted) <= 0.5 + 1e-9, row
        assert 0 < row["spoilt"] < row["loops"] and row["spoilt_kept"] <= row["spoilt"] and row["others_left_out"] >= 0, row
    return {(row["how"], row["share"]): row for row in found}, done.returncode


def test_the_recommended_pipeline_does_without_a_third_of_its_loops(folder):
    street = folder / "street"  # long enough that five that agree are no majority
    plumb("simulate", "out_and_back", "--length", "400m", "--frames", 200, "--lines", 16, "--columns", 512, "--drift", 6, "-o", street)
    found, code = rows(folder, street, "--share", "10", "--share", "30")
    assert len(found) == 4 and code == 0, found
    for (how, _), row in found.items():
        assert row["spoilt_kept"] == 0 and row["ratio"] <= 1.1, row
        assert how == "alone" or row["spoilt"] >= 5, row


def test_the_cascade_does_without_a_third_of_its_loops(folder):
    found, code = rows(folder, sequence("street"), "--pipeline", "tang2024", "--set", "ranges.frames=6", "--how", "alone", "--share", "30")
    assert len(found) == 1 and code == 0, found
