"""Verdicts on what is known, twenty times each: tools/verdicts.py with runs of a moment."""
import subprocess
import sys

from plumb_test import BUILD, PLUMB, SOURCE

# The wheels' own error, which differs a little from replicate to replicate.
WHEELS = """plumb: 1
name: wheels
parameters:
  input: {type: path}
  truth: {type: path, default: none}
steps:
  log:        {use: source.carmen,      with: {path: $input}}
  error:      {use: measure.trajectory, from: {trajectories: {fine: log.trajectory}}, with: {truth: $truth}}
  trajectory: {use: write.trajectory,   from: log.trajectory}
"""


def test_verdicts_on_what_is_known_hold(folder):
    (folder / "wheels.yaml").write_text(WHEELS)
    done = subprocess.run([sys.executable, str(SOURCE / "tools/verdicts.py"), str(folder / "out"), "--pipeline", str(folder / "wheels.yaml"), "--trajectory",
                           "log.trajectory", "--inputs", "6", "--replicates", "2", "--plumb", str(PLUMB), "--modules",
                           str(BUILD / "tests/end_to_end/modules")], capture_output=True, text=True)
    print(done.stdout)
    assert done.returncode == 0, done.stdout + done.stderr
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines()[2:]]
    assert [row[1] for row in rows] == [">= 15", "<= 1", ">= 18", "better", "fails, on 1", "6", "6"], rows
    # The poses are worse by what was asked for, on top of what the replicates do.
    low, high = (float(ratio) for ratio in rows[2][2].split("ratios ")[1].rstrip(")").split(" to "))
    assert 1.05 < low < high < 1.15, rows[2]
