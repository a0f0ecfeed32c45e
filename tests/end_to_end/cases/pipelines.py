"""Every pipeline and preset runs whole on a small sequence and takes most of the drift out, judged by the truth."""
import json
import re

import numpy as np
import yaml
from scipy.spatial.transform import Rotation, Slerp

from judge import Trajectory, frames_of, points_of
from plumb_test import (CAR, CASCADE, DONE, PIPELINES, PLANAR, STEP_FAILED, UNIMPROVED, WORSE, WRONG_INPUT, cascade, left_out, plumb, refused, score, sequence,
                        skip)

HANDHELD = PIPELINES / "presets/handheld_solid_state.yaml"
MULRAN = PIPELINES / "presets/mulran_os1_64.yaml"
FILES = ["graph.g2o", "map.ply", "metrics.json", "run.lock.yaml", "trajectory.tum"]


def test_all_are_known_to_these_cases(folder):
    """A new pipeline needs a case here, and so does an experiment."""
    experiments = [PIPELINES / "experiments" / name for name in ("packages.yaml", "unimproved.yaml", "voxel_size.yaml")]  # the next cases
    elsewhere = [PLANAR, UNIMPROVED, PIPELINES / "judge2d.yaml", PIPELINES / "plumb.yaml"]  # planar.py, compare.py, recommended.py
    elsewhere += [PIPELINES / f"presets/{name}.yaml" for name in ("tang2024_literal", "zhang2023_literal", "zhang2023_literal_unimproved")]  # literal.py
    assert sorted(PIPELINES.rglob("*.yaml")) == sorted([*experiments, CASCADE, CAR, HANDHELD, MULRAN, *elsewhere])


def test_experiments_can_be_run(folder):
    """All but the inputs is there: what they name is read before the first input is looked at."""
    for file in sorted((PIPELINES / "experiments").glob("*.yaml")):
        refused(plumb("compare", file, "--input", folder / "nowhere", code=WRONG_INPUT), f"--input {folder}/nowhere: there is no such file or folder")


def lacking(experiment):
    """The steps that an experiment names and this build left out."""
    return set(re.findall(r"use: ([a-z0-9_.]+)", experiment.read_text())) & set(left_out())


def test_every_variant_of_an_experiment_is_a_sound_pipeline(folder):
    """All of them are planned, and their modules loaded, before the first run, which fails: it finds nothing to read."""
    (folder / "empty").mkdir()
    for file in sorted((PIPELINES / "experiments").glob("*.yaml")):
        if lacking(file):
            plumb("compare", file, "--input", folder / "empty", "--quiet", code=WRONG_INPUT).has("is not in this build")
        else:
            said = plumb("compare", file, "--input", folder / "empty", "--json", "--quiet", code=STEP_FAILED)
            runs = json.loads(said.out)["runs"]
            assert len(runs) > 1 and all("failed: step '" in f"failed: {run['failed']}" for run in runs), said


def test_every_variant_of_packages_runs_on_a_street(folder):
    file = PIPELINES / "experiments/packages.yaml"
    if missing := lacking(file):
        skip(f"this build left out {', '.join(sorted(missing))}")
    said = plumb("compare", file, "--input", sequence("street"), "--cache-dir", folder / "cache", "--json", "--quiet", code=(DONE, WORSE))
    outcome = json.loads(said.out)
    assert len(outcome["runs"]) == len(outcome["variants"]) >= 13 and not any("failed" in run for run in outcome["runs"]), said
    decides = next(number for number in outcome["numbers"] if number["name"] == "error.fine.ate")
    values = {variant: of["values"][0] for variant, of in decides["variants"].items()}
    assert len(values) == len(outcome["variants"]) and all(value is not None for value in values.values()), values
    assert len(set(values.values())) > len(values) / 2, f"parts that change nothing were not exchanged: {values}"


def test_the_page_of_experiments_has_every_variant_of_packages(folder):
    page = (PIPELINES / "experiments/README.md").read_text()
    variants = list(yaml.safe_load((PIPELINES / "experiments/packages.yaml").read_text())["variants"])
    explained = re.findall(r"^\| `(\w+)` \|", page.partition("<!--")[0], re.M)
    assert explained == variants, set(explained) ^ set(variants)
    judged = re.findall(r"^\| `(\w+)` \|", page.partition("<!--")[2], re.M)
    assert sorted(judged) == sorted(variants), set(judged) ^ set(variants)


def test_all_check_clean(folder):
    for preset in (None, CAR, HANDHELD, MULRAN):
        options = ["--preset", preset] if preset else []
        plumb("check", CASCADE, *options, "--set", "input=.").has("good")
    for preset in (CAR, HANDHELD, MULRAN):
        plumb("check", preset, "--set", "input=.").has("good")
    plumb("check", PLANAR, "--set", "input=.").has("good")
    plumb("check", UNIMPROVED, "--set", "input=.").has("good")


def straightens(sequence_folder, out, factor):
    """The run's files are whole, its trajectory has every frame, and its ATE is `factor` times smaller."""
    assert sorted(p.name for p in out.iterdir()) == FILES
    ours, given = Trajectory.read(out / "trajectory.tum"), Trajectory.read(sequence_folder / "odometry.tum")
    assert len(ours) == len(given) and np.allclose(ours.stamps, given.stamps, rtol=0, atol=1e-6)
    result = score(sequence_folder, out / "trajectory.tum")
    before, after = result["before"]["ate_rmse"], result["after"]["ate_rmse"]
    assert after * factor < before, f"ATE was {before:.3f} m and is {after:.3f} m"
    return result


def stages_of(out):
    return {stage["stage"]: stage for stage in json.loads((out / "metrics.json").read_text())["stages"]}


def numbers(stage):
    return {name: number["value"] for name, number in stage["numbers"].items()}


def metrics_tell_what_happened(out, result=None, falls=2):
    stages = stages_of(out)
    assert list(stages) == ["drift", "coarse", "fine", "match_rmse", "error"]
    for name in ("drift", "coarse", "fine"):
        edges = stages[name]["edges"]
        assert edges and numbers(stages[name])["edges"] == len(edges)
        for edge in edges:
            assert edge["i"] != edge["j"] and 0 <= edge["kept"] <= edge["found"] and 0 <= edge["weight"] <= 1, edge
            assert edge["kind"] in ("sequential", "neighbour", "loop"), edge
            assert edge["status"] in ("accepted", "down-weighted", "rejected", "no matches"), edge
    rmse = numbers(stages["match_rmse"])
    assert list(rmse) == ["before", "drift", "coarse", "fine"]
    assert rmse["fine"] * falls < rmse["before"], rmse
    if result:
        error = numbers(stages["error"])
        assert abs(error["fine.ate"] - result["after"]["ate_rmse"]) < 1e-6, error
        assert abs(error["before.ate"] - result["before"]["ate_rmse"]) < 1e-6, error


def map_is_whole(sequence_folder, out):
    """The map has a header that fits its bytes, and points all over the path."""
    header, data = (out / "map.ply").read_bytes().split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    size = sum({"float": 4, "double": 8, "ushort": 2, "uchar": 1}[line.split()[1]] for line in lines if line.startswith("property"))
    assert count * size == len(data), (lines, len(data))
    assert 1000 < count <= sum(len(points_of(f)) for f in frames_of(sequence_folder))


def graph_is_whole(out):
    lines = (out / "graph.g2o").read_text().splitlines()
    vertices = {line.split()[1] for line in lines if line.startswith("VERTEX_SE3:QUAT")}
    edges = [line.split() for line in lines if line.startswith("EDGE_SE3:QUAT")]
    assert len(vertices) > 5 and len(edges) >= len(vertices) - 1
    assert all(len(e) == 31 and e[1] in vertices and e[2] in vertices for e in edges)


def test_tang2024_straightens_a_street(folder):
    street, out = sequence("street"), folder / "out"
    cascade(street, out, "--set", "ranges.frames=6", "--set", f"truth={street / 'truth.tum'}")
    metrics_tell_what_happened(out, straightens(street, out, factor=5))
    map_is_whole(street, out)
    graph_is_whole(out)
    assert any(edge["kind"] == "loop" for edge in stages_of(out)["drift"]["edges"])


def test_tang2024_prints_the_table_of_stages(folder):
    street = sequence("street")
    said = plumb("run", CASCADE, "--set", f"input={street}", "--set", f"truth={street / 'truth.tum'}", "--set", "ranges.frames=6",
                 "--times", "--log", folder / "log.txt", "-o", folder / "out")
    rows = [line.split() for line in said.out.splitlines() if line.split()[:1] in (["before"], ["drift"], ["coarse"], ["fine"])]
    assert [row[0] for row in rows] == ["before", "drift", "coarse", "fine"], said.out
    said.has("match_rmse [m]", "error.ate [m]", "CPU seconds of each step", "passes, ended because", "GiB at most", "trajectory.tum map.ply")
    assert "fine.solved" in (folder / "log.txt").read_text()


def test_preset_car_64line_straightens_a_street_to_its_ghosting_in_truth(folder):
    street, out = sequence("street"), folder / "out"
    cascade(street, out, "--preset", CAR, "--set", f"truth={street / 'truth.tum'}")
    metrics_tell_what_happened(out, straightens(street, out, factor=5))
    after = score(street, out / "trajectory.tum", "--clouds")["after"]
    assert after["pairs"] > 10 and after["ghosting"] < 1.1 * after["ghosting_truth"], after


def test_a_preset_is_also_a_pipeline_by_itself(folder):
    street = sequence("street")
    cascade(street, folder / "a", "--preset", CAR)
    cascade(street, folder / "b", pipeline=CAR)
    for file in ("trajectory.tum", "map.ply", "metrics.json"):
        assert (folder / "a" / file).read_bytes() == (folder / "b" / file).read_bytes(), file


def test_preset_handheld_solid_state_straightens_a_walk(folder):
    walk, out = sequence("walk"), folder / "out"
    cascade(walk, out, "--preset", HANDHELD, "--set", f"truth={walk / 'truth.tum'}")
    # The walk drifts by less than the pairs' largest distance, so its match RMSE starts near the noise: the ATE is what tells.
    metrics_tell_what_happened(out, straightens(walk, out, factor=3), falls=1.2)


def test_without_a_truth_the_error_is_left_out_and_the_same_comes_out(folder):
    street = sequence("street")
    cascade(street, folder / "a", "--set", "ranges.frames=6", "--set", f"truth={street / 'truth.tum'}")
    said = plumb("run", CASCADE, "--set", f"input={street}", "--set", "ranges.frames=6", "-o", folder / "b")
    said.has("weak: error: no truth was given")
    assert (folder / "a/trajectory.tum").read_bytes() == (folder / "b/trajectory.tum").read_bytes()
    assert stages_of(folder / "b")["error"]["numbers"] == {}


FIRST_SCAN = 1567410201812840928  # [ns], as MulRan names its files


def mulran_like(folder):
    """The street as MulRan stores a drive: scans by stamp, and a CSV of poses taken at other moments. Truth and odometry for the judge."""
    street, drive = sequence("street"), folder / "drive"
    (drive / "Ouster").mkdir(parents=True)
    drifted, truth = (Trajectory.read(street / name) for name in ("odometry.tum", "truth.tum"))
    stamps = FIRST_SCAN + np.round(1e9 * (drifted.stamps - drifted.stamps[0])).astype(np.int64)
    for file, stamp in zip(frames_of(street), stamps):
        points = points_of(file)
        np.column_stack([points, np.full(len(points), 7.0)]).astype("<f4").tofile(drive / "Ouster" / f"{stamp}.bin")
    # Poses at three times the rate of the scans, 11 ms beside them, and from before the first scan to after the last.
    time = 1e-9 * (stamps - FIRST_SCAN)
    step = time[1] / 3
    poses_at = np.arange(time[0] - step, time[-1] + 2 * step, step) + 0.011
    inside = np.clip(poses_at, time[0], time[-1])
    rotations = Slerp(time, Rotation.from_matrix(drifted.rotations))(inside).as_matrix()
    positions = np.column_stack([np.interp(inside, time, drifted.positions[:, a]) for a in range(3)])
    with open(drive / "global_pose.csv", "w") as out:
        for t, r, p in zip(poses_at, rotations, positions):
            rows = np.column_stack([r, p])
            out.write(f"{FIRST_SCAN + int(round(1e9 * t))}," + ",".join(f"{v:.12g}" for v in rows.ravel()) + "\n")
    for name, trajectory in (("truth.tum", truth), ("odometry.tum", drifted)):
        with open(drive / name, "w") as out:
            for stamp, r, p in zip(stamps, trajectory.rotations, trajectory.positions):
                q = Rotation.from_matrix(r).as_quat()
                seconds = f"{stamp // 10**9}.{stamp % 10**9:09d}"
                out.write(" ".join([seconds, *(f"{v:.9f}" for v in (*p, *q))]) + "\n")
    return drive


def test_preset_mulran_os1_64_straightens_a_drive_with_poses_in_a_csv(folder):
    drive, out = mulran_like(folder), folder / "out"
    cascade(drive, out, "--preset", MULRAN, "--set", f"sequence.trajectory={drive / 'global_pose.csv'}", "--set", "ranges.frames=6",
            "--set", f"truth={drive / 'truth.tum'}")
    straightens(drive, out, factor=5)
    metrics_tell_what_happened(out)  # 'before' is the interpolated CSV, not the odometry that the judge reads


def test_preset_mulran_os1_64_takes_the_odometry_beside_the_scans(folder):
    drive, out = mulran_like(folder), folder / "out"
    cascade(drive, out, "--preset", MULRAN, "--set", "ranges.frames=6")
    straightens(drive, out, factor=5)
    (drive / "odometry.tum").unlink()
    refused(cascade(drive, folder / "none", "--preset", MULRAN, code=STEP_FAILED), "odometry.tum")
