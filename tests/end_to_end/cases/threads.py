"""The same bytes come out with one thread and with two."""
from plumb_test import CAR, PIPELINES, cascade, files_of, sequence


def same_bytes(folder, sequence_folder, *options):
    for threads in (1, 2):
        cascade(sequence_folder, folder / str(threads), *options, "--threads", threads)
    one, two = files_of(folder / "1"), files_of(folder / "2")
    assert one.keys() == two.keys() and len(one) == 5
    assert not [name for name in one if one[name] != two[name]]


def test_do_not_change_the_cascade(folder):
    street = sequence("street")
    same_bytes(folder, street, "--set", "ranges.frames=6", "--set", f"truth={street / 'truth.tum'}")


def test_do_not_change_a_preset(folder):
    same_bytes(folder, sequence("street"), "--preset", CAR)


def test_do_not_change_a_walk_by_hand(folder):
    same_bytes(folder, sequence("walk"), "--preset", PIPELINES / "presets/handheld_solid_state.yaml")


def test_do_not_change_what_ransac_draws(folder):
    file = folder / "ransac.yaml"
    file.write_text(f"plumb: 1\nname: ransac\nextends: {CAR}\nreplace:\n"
                    "  drift.kept:  {use: prune.ransac, from: inner}\n  coarse.kept: {use: prune.ransac, from: inner}\n")
    same_bytes(folder, sequence("street"), "--preset", file)


def test_a_second_run_gives_the_same_bytes(folder):
    for name in ("a", "b"):
        cascade(sequence("street"), folder / name, "--preset", CAR)
    assert files_of(folder / "a") == files_of(folder / "b")
