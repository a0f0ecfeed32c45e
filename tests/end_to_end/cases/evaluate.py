"""`plumb evaluate --json` against judges that share no code with it, to 1e-6."""
import json
import math
import subprocess
import sys

from judge import judge
from plumb_test import SHARED, copy_of, real_sequence, score, sequence, skip


def same(ours, other):
    assert ours.keys() == other.keys(), (ours, other)
    for name in other:
        assert ours[name].keys() == other[name].keys(), (name, ours[name], other[name])
        for measure, value in other[name].items():
            mine = ours[name][measure]
            if value is None or (isinstance(value, float) and math.isnan(value)):
                assert mine is None, (name, measure, mine)
            else:
                assert abs(mine - value) < 1e-6, f"{name} {measure}: {mine}, but the other judge says {value}"


def half_straight(folder, sequence_folder):
    """A trajectory between the drifting and the true one: positions halfway, the true attitudes."""
    rows = [[line.split() for line in (sequence_folder / name).read_text().splitlines()] for name in ("odometry.tum", "truth.tum")]
    file = folder / "half.tum"
    with open(file, "w") as out:
        for drifted, true in zip(*rows):
            middle = [f"{(float(a) + float(b)) / 2:.9f}" for a, b in zip(drifted[1:4], true[1:4])]
            out.write(" ".join([true[0], *middle, *true[4:]]) + "\n")
    return file


def test_agrees_with_a_second_judge_on_a_street(folder):
    street = sequence("street")
    same(score(street, half_straight(folder, street), "--clouds"), judge(street, half_straight(folder, street), clouds=True))


def test_agrees_with_a_second_judge_on_half_a_trajectory(folder):
    street = sequence("street")
    half = folder / "some.tum"
    half.write_text("".join((street / "odometry.tum").read_text().splitlines(keepends=True)[10:40:2]))
    same(score(street, half), judge(street, half))


def test_agrees_with_a_second_judge_where_nothing_is_seen_twice(folder):
    straight = sequence("straight")
    result = score(straight, half_straight(folder, straight), "--clouds")
    same(result, judge(straight, half_straight(folder, straight), clouds=True))
    assert result["after"]["pairs"] == 0 and result["after"]["ghosting"] is None


def test_agrees_with_a_second_judge_on_a_path_under_ten_metres(folder):
    short = copy_of("street", folder, frames=4)
    result = score(short, half_straight(folder, short))
    same(result, judge(short, half_straight(folder, short)))
    assert result["after"]["rpe_m"] is None


def test_of_the_truth_itself_finds_no_error(folder):
    street = sequence("street")
    result = score(street, street / "truth.tum")
    assert result["after"]["ate_rmse"] < 1e-9 and result["after"]["rpe_m"] < 1e-9
    assert 0.3 < result["before"]["ate_rmse"] < 5, result


def agrees_with_the_shared_judge(folder, sequence_folder):
    tool = SHARED / "tools/judge.py"
    if not tool.exists():
        skip("the shared judge is not on this machine (../shared/tools/judge.py)")
    half = half_straight(folder, sequence_folder)
    said = subprocess.run([sys.executable, str(tool), str(sequence_folder), str(half), "--clouds", "--json"], capture_output=True, text=True)
    assert said.returncode == 0, said.stderr
    same(score(sequence_folder, half, "--clouds"), json.loads(said.stdout))


def test_agrees_with_the_shared_judge_on_a_simulated_street(folder):
    agrees_with_the_shared_judge(folder, sequence("street"))


def test_agrees_with_the_shared_judge_on_a_real_street(folder):
    agrees_with_the_shared_judge(folder, real_sequence("kitti_street_out_and_back"))


def test_agrees_with_the_shared_judge_on_a_walk_by_hand(folder):
    agrees_with_the_shared_judge(folder, real_sequence("handheld_hku1"))
