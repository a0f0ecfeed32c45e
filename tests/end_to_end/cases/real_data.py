"""What comes out of real sequences, where they are on this machine. No times: those are measured, not asserted."""
from plumb_test import CAR, PIPELINES, cascade, real_sequence, score


def straightened(folder, name, preset):
    data = real_sequence(name)
    cascade(data, folder / "out", "--preset", preset)
    result = score(data, folder / "out/trajectory.tum", "--clouds")
    print(result)
    return result["before"], result["after"]


def test_a_street_driven_out_and_back_lies_on_itself(folder):
    before, after = straightened(folder, "kitti_street_out_and_back", CAR)
    assert before["ghosting"] > 6 and before["ate_rmse"] > 4, before
    assert after["ghosting"] <= 0.15 and after["ate_rmse"] <= 0.40, after


def test_a_walk_by_hand_comes_out_straight(folder):
    before, after = straightened(folder, "handheld_hku1", PIPELINES / "presets/handheld_solid_state.yaml")
    assert before["ate_rmse"] > 0.6 and after["ate_rmse"] <= 0.15, after


def test_a_street_without_a_revisit_is_not_bent(folder):
    _, after = straightened(folder, "kitti_street", CAR)
    assert after["ate_rmse"] <= 0.45, after
