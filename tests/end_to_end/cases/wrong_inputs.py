"""What is wrong is refused with one sentence, and nothing half-written is left; what is merely poor is said and gone on with."""
import json
import os
import re
import struct
from pathlib import Path

import numpy as np

from plumb_test import (CASCADE, POSES, STEP_FAILED, WRONG_COMMAND_LINE, WRONG_INPUT, cascade, copy_of, files_of, nothing_left, plumb, poses_pipeline,
                        refused, sequence)

FAST = ["--set", "ranges.frames=2"]


def spoilt(folder, spoil, *words):
    """Runs the cascade on six frames that `spoil` changed; it must be refused with `words`."""
    sequence_folder = copy_of("street", folder, frames=6)
    spoil(sequence_folder)
    refused(cascade(sequence_folder, folder / "out", *FAST, code=STEP_FAILED), *words)
    nothing_left(folder / "out")


def change_lines(file, change):
    lines = file.read_text().splitlines()
    file.write_text("\n".join(change(lines)) + "\n")


def frame(sequence_folder, k):
    return sorted((sequence_folder / "frames").iterdir())[k]


def header_and_points(file):
    header, points = file.read_bytes().split(b"DATA binary\n", 1)
    return header, points


def test_a_folder_that_is_missing(folder):
    said = cascade(folder / "nowhere", folder / "out", code=WRONG_INPUT)
    said.has(f"--set input={folder}/nowhere: step 'sequence'", f"there is no file or folder '{folder}/nowhere'", "Expected: folder with")
    assert re.search(r"tang2024\.yaml:\d+:\d+", said.err), said
    nothing_left(folder / "out")


def test_a_truth_that_is_missing_is_noticed_before_anything_runs(folder):
    street = sequence("street")
    for command in (["check", CASCADE], ["run", CASCADE, "-o", folder / "out"]):
        said = plumb(*command, "--set", f"input={street}", "--set", f"truth={street}/trut.tum", code=WRONG_INPUT)
        said.has("step 'error' (measure.trajectory): parameter 'truth': there is no file", f"Did you mean '{street}/truth.tum'?")
    nothing_left(folder / "out")


def test_a_file_instead_of_a_folder(folder):
    refused(cascade(CASCADE, folder / "out", code=STEP_FAILED), str(CASCADE), "is not a directory", "give")
    nothing_left(folder / "out")


def test_an_empty_folder(folder):
    (folder / "empty").mkdir()
    refused(cascade(folder / "empty", folder / "out", code=STEP_FAILED), str(folder / "empty"), "has no frames", "expected")
    nothing_left(folder / "out")


def test_fewer_poses_than_frames(folder):
    spoilt(folder, lambda s: change_lines(s / "odometry.tum", lambda lines: lines[:4]), "has 6 frames", "has 4 poses", "give exactly one pose")


def test_more_poses_than_frames(folder):
    spoilt(folder, lambda s: frame(s, 5).unlink(), "has 5 frames", "has 6 poses")


def test_no_odometry(folder):
    spoilt(folder, lambda s: (s / "odometry.tum").unlink(), "odometry.tum", "cannot be opened")


def test_a_pcd_cut_short(folder):
    def cut(s):
        data = frame(s, 3).read_bytes()
        frame(s, 3).write_bytes(data[:len(data) // 2])
    spoilt(folder, cut, "frame", ".pcd", "bytes")


def test_a_pcd_cut_within_its_header(folder):
    spoilt(folder, lambda s: frame(s, 3).write_bytes(frame(s, 3).read_bytes()[:60]), ".pcd")


def test_an_empty_pcd_file(folder):
    spoilt(folder, lambda s: frame(s, 3).write_bytes(b""), ".pcd")


def test_a_header_that_promises_a_million_million_points(folder):
    def promise(s):
        header, points = header_and_points(frame(s, 2))
        header = re.sub(rb"WIDTH \d+", b"WIDTH 1000000000000", header)
        frame(s, 2).write_bytes(re.sub(rb"POINTS \d+", b"POINTS 1000000000000", header) + b"DATA binary\n" + points)
    spoilt(folder, promise, ".pcd", "1000000000000")


def test_a_quaternion_of_norm_0(folder):
    def zero(lines):
        lines[3] = " ".join(lines[3].split()[:4] + ["0", "0", "0", "0"])
        return lines
    spoilt(folder, lambda s: change_lines(s / "odometry.tum", zero), "odometry.tum:4:", "quaternion")


def test_a_pose_that_is_no_number(folder):
    spoilt(folder, lambda s: change_lines(s / "odometry.tum", lambda l: l[:2] + [re.sub(r" \S+", " nan", l[2], count=1)] + l[3:]),
           "odometry.tum:3:", "nan")


def test_a_pose_of_seven_numbers(folder):
    spoilt(folder, lambda s: change_lines(s / "odometry.tum", lambda l: l[:5] + [l[5].rsplit(" ", 1)[0]]), "odometry.tum:6:", "8")


def test_stamps_out_of_order(folder):
    spoilt(folder, lambda s: change_lines(s / "odometry.tum", lambda l: [l[0], l[2], l[1], *l[3:]]), "odometry.tum:3:", "stamp", "later")


def test_a_single_frame(folder):
    refused(cascade(copy_of("street", folder, frames=1), folder / "out", code=STEP_FAILED), "has 1 frame", "at least 2")
    nothing_left(folder / "out")


def test_an_output_folder_that_cannot_be_written(folder):
    street = sequence("street")
    for place in ("/proc/plumb_out", "/dev/null/out"):  # root may write anywhere else
        refused(cascade(street, place, code=WRONG_INPUT), place, "cannot be written", "-o")
        assert not os.path.exists(place)


def test_an_output_that_is_a_file(folder):
    (folder / "out").write_text("mine")
    refused(cascade(sequence("street"), folder / "out", code=WRONG_INPUT), "is a file", "-o")
    assert files_of(folder) == {"out": b"mine"}


def test_an_output_folder_that_holds_something_else(folder):
    out = folder / "out"
    out.mkdir()
    (out / "holiday.jpg").write_text("mine")
    refused(cascade(sequence("street"), out, code=WRONG_INPUT), str(out), "holiday.jpg", "with -o, or move it away")
    assert files_of(folder) == {"out/holiday.jpg": b"mine"}
    assert [p.name for p in folder.iterdir()] == ["out"]


def test_an_earlier_run_is_replaced_but_kept_when_the_next_one_fails(folder):
    out, pipeline = folder / "out", poses_pipeline(folder)
    cascade(sequence("street"), out, pipeline=pipeline)
    first = files_of(out)
    assert set(first) == {"trajectory.tum", "run.lock.yaml"}
    (folder / "empty").mkdir()
    cascade(folder / "nowhere", out, pipeline=pipeline, code=WRONG_INPUT)
    cascade(folder / "empty", out, pipeline=pipeline, code=STEP_FAILED)
    (folder / "empty").rmdir()
    assert files_of(out) == first
    cascade(sequence("straight"), out, pipeline=pipeline)
    assert files_of(out)["trajectory.tum"] != first["trajectory.tum"]
    (out / "notes.txt").write_text("mine")
    before = files_of(out)
    refused(cascade(sequence("street"), out, pipeline=pipeline, code=WRONG_INPUT), "notes.txt")
    assert files_of(out) == before
    assert sorted(p.name for p in folder.iterdir()) == ["out", "poses.yaml"]


def test_two_steps_that_write_the_same_file(folder):
    (folder / "twice.yaml").write_text(POSES + "  again:    {use: write.trajectory, from: sequence.trajectory}\n")
    for command in (["check", folder / "twice.yaml"], ["run", folder / "twice.yaml", "-o", folder / "out"]):
        said = plumb(*command, "--set", f"input={sequence('street')}", code=WRONG_INPUT)
        said.has("twice.yaml:", "'copy'", "'again'", "trajectory.tum")
        nothing_left(folder / "out")


def test_a_file_name_that_is_none(folder):
    for name in ("../escape.tum", "run.lock.yaml", "a/b.tum"):
        (folder / "named.yaml").write_text(POSES + f"  again:    {{use: write.trajectory, from: sequence.trajectory, with: {{name: {name}}}}}\n")
        said = plumb("run", folder / "named.yaml", "--set", f"input={sequence('street')}", "-o", folder / "out", code=WRONG_INPUT)
        said.has("named.yaml:", f'"{name}"', "choose another")
        nothing_left(folder / "out")


def test_parameters_that_do_not_go_together_are_refused_before_anything_runs(folder):
    wrong_pipeline(folder, "default: 300 m, about: farther", "default: 0.1 m, about: farther", "filter.distance", "min")


def wrong_pipeline(folder, good, bad, *words):
    text = CASCADE.read_text()
    assert good in text, f"'{good}' is no longer in {CASCADE.name}; change the test"
    file = folder / "wrong.yaml"
    file.write_text(text.replace(good, bad, 1))
    for command in (["check", file], ["run", file, "-o", folder / "out"]):
        said = plumb(*command, "--set", f"input={sequence('street')}", code=WRONG_INPUT)
        said.has("wrong.yaml:", *words)
        assert re.search(r"wrong\.yaml:\d+:\d+: ", said.err), said
        nothing_left(folder / "out")


def test_an_unknown_step(folder):
    wrong_pipeline(folder, "use: prune.kmeans", "use: prune.kmeens", "prune.kmeens", "Did you mean 'prune.kmeans'?")


def test_an_unknown_port(folder):
    wrong_pipeline(folder, "{frames: ranged, ranges:", "{frames: ranged, rangs:", "rangs", "Did you mean 'ranges'?")


def test_an_unknown_parameter(folder):
    wrong_pipeline(folder, "with: {frames: 60}", "with: {framse: 60}", "framse", "Did you mean 'frames'")


def test_an_unknown_unit(folder):
    wrong_pipeline(folder, "max_correspondence_distance: [4 m,", "max_correspondence_distance: [4 mtr,", "mtr", "Known: m, cm")


def test_an_unknown_name_behind_set(folder):
    for setting, word in (("coarse.max_corespondence_distance=2m", "Did you mean 'max_correspondence_distance'?"), ("voxel_sice=1m", "Did you mean 'voxel_size'?"), ("coarse.kept.clustres=3", "clustres"), ("voxel_size=1", "unit")):
        said = plumb("check", CASCADE, "--set", "input=.", "--set", setting, code=WRONG_INPUT)
        said.has("--set", word)
    refused(plumb("check", CASCADE, "--set", "input=.", "--set", "voxel_size", code=WRONG_COMMAND_LINE), "--set", "expected NAME=VALUE")


def test_a_path_with_a_dollar_is_written_with_two(folder):
    street = folder / "a$b" / "$input"
    street.parent.mkdir()
    copy_of("street", folder, frames=6).rename(street)
    pipeline = poses_pipeline(folder)
    written = str(street).replace("$", "$$")
    plumb("run", pipeline, "--set", f"input={written}", "-o", folder / "out", "--quiet")
    plumb("run", "--locked", folder / "out/run.lock.yaml", "-o", folder / "again", "--quiet")
    assert files_of(folder / "again") == files_of(folder / "out")
    (folder / "default.yaml").write_text(POSES.replace("{type: path}", f"{{type: path, default: {written}}}"))
    plumb("check", folder / "default.yaml").has("good")
    for value in (street, "$input"):
        plumb("check", pipeline, "--set", f"input={value}", code=WRONG_INPUT).has("A '$' that is text is written '$$'")
    plumb("check", pipeline, "--set", "sequence.path=$inptu", code=WRONG_INPUT).has("nothing is called '$inptu'", "A '$' that is text is written '$$'")


def floats_of(file):
    header, points = header_and_points(file)
    width = len(re.search(rb"FIELDS (.*)", header)[1].split())
    return header, np.frombuffer(points, "<f4").reshape(-1, width).copy()


def test_nan_and_infinite_points_are_dropped_and_counted(folder):
    clean, spoilt_sequence = copy_of("street", folder / "clean", frames=6), copy_of("street", folder / "spoilt", frames=6)
    for k, value in ((1, np.nan), (4, np.inf), (4, -np.inf)):
        file = frame(spoilt_sequence, k)
        header, points = floats_of(file)
        extra = points[:10].copy()
        extra[:, k % 3] = value
        points = np.concatenate([points, extra])
        header = re.sub(rb"(WIDTH|POINTS) \d+", lambda m: m[1] + b" %d" % len(points), header)
        file.write_bytes(header + b"DATA binary\n" + points.tobytes())
    options = ["--set", "ranges.frames=2", "--set"]
    for name, s in (("a", clean), ("b", spoilt_sequence)):
        said = plumb("run", CASCADE, *options, f"input={s}", "-o", folder / name)
    said.has("30 points with a non-finite coordinate dropped")
    for file in ("trajectory.tum", "map.ply", "graph.g2o", "metrics.json"):
        assert (folder / "a" / file).read_bytes() == (folder / "b" / file).read_bytes(), file


def moved_apart(s, first, by):
    """Frames from `first` on stand `by` metres farther along x, in the odometry as in truth."""
    def move(lines):
        rows = [line.split() for line in lines]
        return [" ".join([r[0], str(float(r[1]) + (by if k >= first else 0)), *r[2:]]) for k, r in enumerate(rows)]
    change_lines(s / "odometry.tum", move)
    change_lines(s / "truth.tum", move)


def other_place(s, first):
    """Frames from `first` on show a place with nothing in common with the others: a ball's shell seen from inside."""
    rng = np.random.default_rng(1)
    for k in range(first, len(list((s / "frames").iterdir()))):
        header, points = floats_of(frame(s, k))
        ball = rng.normal(size=(len(points), 3))
        points[:, :3] = 20 * ball / np.linalg.norm(ball, axis=1)[:, None]
        frame(s, k).write_bytes(header + b"DATA binary\n" + points.astype("<f4").tobytes())


def test_two_segments_that_do_not_overlap_are_said_and_gone_on_with(folder):
    s = copy_of("street", folder, frames=12)
    moved_apart(s, 6, 2000.0)
    other_place(s, 6)
    said = plumb("run", CASCADE, "--set", f"input={s}", "--set", "ranges.frames=3", "-o", folder / "out")
    said.has("weak:", "parts")
    assert len((folder / "out/trajectory.tum").read_text().splitlines()) == 12
    statuses = {(e["i"], e["j"]): e["status"] for stage in json.loads((folder / "out/metrics.json").read_text())["stages"]
             if stage["stage"] == "drift" for e in stage["edges"]}
    assert statuses[1, 2] == "no matches" and statuses[0, 1] == "accepted", statuses


def test_odometry_in_millimetres_ends_in_one_verdict_with_the_likely_causes(folder):
    s = copy_of("street", folder, frames=24)
    def stretch(lines):
        rows = [line.split() for line in lines]
        return [" ".join([r[0], *(str(1000 * float(v)) for v in r[1:4]), *r[4:]]) for r in rows]
    change_lines(s / "odometry.tum", stretch)
    said = plumb("run", CASCADE, "--set", f"input={s}", "--set", "ranges.frames=3", "-o", folder / "out", "--log", folder / "log")
    weak = [line for line in said.out.splitlines() if line.startswith("weak:")]
    assert "not held by the clouds" in weak[0] and "not in metres" in weak[0], said
    assert len(weak) <= 6, said
    overlap = "follow each other but do not overlap"
    assert said.err.count(overlap) == 3, said
    assert (folder / "log").read_text().count(overlap) > 3


def test_no_loop_found_is_said_and_gone_on_with(folder):
    straight = sequence("straight")
    said = plumb("run", CASCADE, "--set", f"input={straight}", "--set", "ranges.frames=5", "-o", folder / "out")
    said.has("weak:", "no loop found")
    assert len((folder / "out/trajectory.tum").read_text().splitlines()) == 30


def test_an_empty_frame_is_gone_on_with(folder):
    s = copy_of("street", folder, frames=6)
    header, points = floats_of(frame(s, 3))
    frame(s, 3).write_bytes(re.sub(rb"(WIDTH|POINTS) \d+", rb"\1 0", header) + b"DATA binary\n")
    cascade(s, folder / "out", *FAST)
    assert len((folder / "out/trajectory.tum").read_text().splitlines()) == 6
