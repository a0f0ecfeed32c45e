"""Both papers to the letter: the presets check and resolve to what the papers say, run whole, and give the papers' tables."""
import json
import re
import subprocess
import sys

import numpy as np
import yaml

from judge import Trajectory
from plumb_test import CAR, CASCADE, PIPELINES, PLANAR, PLUMB, SOURCE, cascade, plumb, sequence

TANG = PIPELINES / "presets/tang2024_literal.yaml"
ZHANG = PIPELINES / "presets/zhang2023_literal.yaml"
UNIMPROVED = PIPELINES / "presets/zhang2023_literal_unimproved.yaml"


def steps_of(tree, path=""):
    """(path, step) of each, through groups and repeats."""
    for name, node in tree["steps"].items():
        if "use" in node:
            yield path + name, node
        else:
            yield from steps_of(node, f"{path}{name}.")


def resolved(pipeline, *options):
    return yaml.load(plumb("resolve", pipeline, "--set", "input=.", *options).out, yaml.BaseLoader)


def stages_of(out):
    return {stage["stage"]: stage for stage in json.loads((out / "metrics.json").read_text())["stages"]}


def numbers(stage):
    return {name: number["value"] for name, number in stage["numbers"].items()}


def test_they_check_by_themselves_and_over_their_pipelines(folder):
    for pipeline, presets in ((CASCADE, [TANG]), (PLANAR, [ZHANG, UNIMPROVED])):
        for preset in presets:
            plumb("check", preset, "--set", "input=.").has("good")
            plumb("check", pipeline, "--preset", preset, "--set", "input=.").has("good")
    for options in (["--preset", CAR], ["--set", "ranges.segments=45"]):
        plumb("check", TANG, *options, "--set", "input=.").has("good")
    plumb("check", ZHANG, "--set", "input=.", "--set", "odometry=use").has("good")


def test_tang2024_has_nothing_of_ours_left(folder):
    tree = resolved(TANG)
    steps = dict(steps_of(tree))
    assert not any(step["use"].startswith("constrain.") for step in steps.values())
    for name in ("drift.solved", "coarse.solved", "fine.solved"):
        assert "constraints" not in steps[name]["from"] and steps[name]["with"]["loss"] == "huber", (name, steps[name])
        assert steps[name]["with"]["max_edge_weight"] == steps[name]["with"]["anneal_from"] == "none", (name, steps[name])
    loops = steps["drift.loops"]["with"]
    assert (loops["similarity"], loops["stride"], loops["max_walks"], loops["candidates"]) == ("equation_1", "2", "1", "3"), loops
    assert loops["either_direction"] == "false" and loops["min_path_separation"] == "0 m", loops
    # What the paper leaves open is as in tang2024.yaml: from which difference on bins agree, how near a loop is, where its walk ends.
    silent = ("epsilon", "max_centroid_distance", "drift", "threshold", "relative_threshold")
    assert [loops[name] for name in silent] == [dict(steps_of(resolved(CASCADE)))["drift.loops"]["with"][name] for name in silent], loops
    assert steps["fpfh"]["with"]["keypoint_voxel_size"] == "none" and steps["merged"]["with"]["voxel_size"] == "0 m"
    assert all(steps[name]["with"]["distance"] != "none" and "features" in steps[name]["from"] for name in ("drift.inner", "coarse.inner"))
    coarse = [float(text.split()[0]) for text in tree["steps"]["coarse"]["repeat"]["passes"]["max_correspondence_distance"]]
    assert len(coarse) == int(tree["steps"]["coarse"]["repeat"]["at_most"]) and all(a > b for a, b in zip(coarse, coarse[1:])), coarse
    assert tree["steps"]["fine"]["repeat"]["passes"]["max_correspondence_distance"] == ["1 m"]
    assert steps["fine.matches"]["with"]["metric"] == "point" and steps["fine.matches"]["with"]["max_points"] == "none"


def test_zhang2023_has_nothing_of_ours_left(folder):
    for preset, registers, window in ((ZHANG, "register.ia_icp", "10"), (UNIMPROVED, "register.icp", "1")):
        tree = resolved(preset)
        steps = dict(steps_of(tree))
        assert tree["parameters"]["odometry"]["default"] == "ignore" and tree["parameters"]["window"]["default"] == window
        used = {step["use"] for step in steps.values()}
        assert not used & {"track.sliding_window", "loops.submap", "estimate.normals", "register.correlative", "map.occupancy_grid"}, used
        registering = [step for step in steps.values() if step["use"].startswith("register.")]
        assert len(registering) == 2 and all(step["use"] == registers and step["with"]["metric"] == "point" for step in registering)
        assert steps["each"]["with"]["max_duration"] == "1 s" and steps["raw"]["with"]["middle_frame_only"] == "true"
        assert steps["grid"]["use"] == "map.submap_grid" and steps["grid"]["from"]["submaps"] == "drawn", steps["grid"]
        assert steps["solved"]["with"]["loss"] == "none", steps["solved"]


def test_tang2024_runs_on_a_street(folder):
    street, out, frames = sequence("street"), folder / "out", 6
    cascade(street, out, "--set", f"ranges.frames={frames}", "--set", f"truth={street / 'truth.tum'}", pipeline=TANG)
    stages = stages_of(out)
    rmse, error = numbers(stages["match_rmse"]), numbers(stages["error"])
    print({"match RMSE": rmse, "error": error})
    assert rmse["fine"] < rmse["before"], rmse
    # One walk by steps of two: i and j rise together.
    loops = [(edge["i"], edge["j"]) for edge in stages["drift"]["edges"] if edge["kind"] == "loop"]
    assert len({j - i for i, j in loops}) <= 1 and len({i % 2 for i, j in loops}) <= 1, loops
    # Each segment moves as a whole: within it the odometry's motions stand.
    ours, odometry = Trajectory.read(out / "trajectory.tum"), Trajectory.read(street / "odometry.tum")
    assert len(ours) == len(odometry)
    for k in range(len(ours) - 1):
        (r, t), (given_r, given_t) = ours.motion(k, k + 1), odometry.motion(k, k + 1)
        if (k + 1) % frames:
            assert np.allclose(t, given_t, atol=1e-4) and np.allclose(r, given_r, atol=1e-5), k


def seconds_of(stamps):
    """First scans of the seconds that a drive is cut into."""
    firsts = [0]
    for k, stamp in enumerate(stamps):
        if stamp - stamps[firsts[-1]] >= 1 - 1e-5:
            firsts.append(k)
    return firsts


def test_zhang2023_runs_through_rooms_with_and_without_its_improvements(folder):
    rooms = folder / "rooms"
    plumb("simulate", "rooms", "-o", rooms)
    truth = Trajectory.read(rooms / "truth.tum")
    seconds = len(seconds_of(truth.stamps))
    iterations = {}
    for name, preset in (("literal", ZHANG), ("unimproved", UNIMPROVED)):
        out = folder / name
        plumb("run", preset, "--set", f"input={rooms / 'log.clf'}", "--set", f"truth={rooms / 'truth.tum'}", "--set", f"plan={rooms / 'plan.txt'}",
              "-o", out, "--quiet")
        ours, stages = Trajectory.read(out / "trajectory.tum"), stages_of(out)
        assert len(ours) == len(truth) and np.allclose(ours.stamps, truth.stamps, rtol=0, atol=1e-6)
        gate, chain = numbers(stages["gate"]), numbers(stages["chain"])
        assert gate["accepted"] + gate["dropped"] == seconds, (gate, seconds)  # one scan a second
        assert chain["registrations"] == gate["accepted"] - 1 and chain["not_accepted"] == 0, chain
        iterations[name] = chain["iterations"]
        print(name, chain, numbers(stages["error"]), numbers(stages["map_error"]))
        assert numbers(stages["error"])["before.ate"] > 2 and numbers(stages["map_error"])["occupied"] > 100
    assert iterations["literal"] < iterations["unimproved"], iterations


def test_zhang2023_and_unimproved_stand_side_by_side_in_compare(folder):
    plumb("simulate", "rooms", "--length", "12m", "-o", folder / "rooms")
    said = plumb("compare", ZHANG, "--variant", f"unimproved={UNIMPROVED}", "--input", folder / "rooms", "--quiet")
    said.has("zhang2023_literal", "unimproved", "error.fine.displacement_x", "map_error.largest", "map_error.mean", "matching time", "matching iterations")


def tables(folder, *options):
    """What tools/paper_tables.py prints, {title: rows}."""
    done = subprocess.run([sys.executable, str(SOURCE / "tools/paper_tables.py"), str(folder / "tables"), "--plumb", str(PLUMB), *map(str, options)],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (folder / "tables/tables.md").read_text() == done.stdout
    found = {}
    for title, body in re.findall(r"\*\*(.*?)\*\*\n\n((?:\|.*\n)+)", done.stdout):
        found[title] = [[cell.strip() for cell in line.strip("|\n").split("|")] for line in body.splitlines()[2:]]
    return found


def test_the_tables_of_the_readme_come_out_of_one_command(folder):
    street = sequence("straight")
    done = subprocess.run([sys.executable, str(SOURCE / "tools/literal_tables.py"), str(folder / "tables"), "--plumb", str(PLUMB), "--share", "0.04", "--columns",
                           "128", "--corridors", "1", "--input", str(street)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    print(done.stdout)
    readme = (SOURCE / "README.md").read_text()
    heads = [line for line in done.stdout.splitlines() if line.startswith(("| sequence |", "| reduction |"))]
    assert len(heads) == 2 and all(f"\n{head}\n" in readme for head in heads), heads
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines() if line.startswith("| ") and line not in heads]
    rows = [row for row in rows if row[0] != "---"]
    of_space, of_plane = rows[:3], rows[3:]
    assert of_space[0][0] == "simulated street, out and back, 180 m" and of_space[2][0] == street.name, of_space
    for _, *errors, letter, ours in of_space:
        assert all(re.fullmatch(r"\d+\.\d\d m", error) for error in errors) and re.fullmatch(r"\d+\.\d\d -> \d+\.\d\d m", letter) and "->" in ours, of_space
    assert [row[0] for row in of_plane] == re.findall(r"^\| ((?:iterations|time|mean|largest)[^|]*) \| \d", readme, re.M), of_plane
    assert all(re.fullmatch(r"-?\d+\.\d %", cell) for row in of_plane for cell in row[1:] if cell != row[1]), of_plane


def test_the_tables_of_tang2024_come_out_of_one_command(folder):
    found = tables(folder, "--paper", "tang2024", "--data", 4, "--share", 0.06, "--columns", 256)
    first, second, third = found.values()
    assert first[0][0] == "Data 4" and abs(float(first[0][1]) - 121) < 8 and first[0][2] == "191", first
    assert [row[1] for row in second] == ["to the letter", "tang2024", "plumb"], second
    for row in second[:2]:
        assert 2 <= int(row[3]) <= 4 and 5 <= int(row[4]) <= 8, row  # the passes of the paper's table 2
    stages = [(row[1], row[2]) for row in third]
    for name in ("to the letter", "tang2024"):
        assert [stage for pipeline, stage in stages if pipeline == name] == ["before", "drift", "coarse", "fine"], stages
    assert all(float(row[3]) > 0 and float(row[4]) > 0 for row in third), third
    assert not (folder / "tables/data_4").exists()


def test_the_tables_of_zhang2023_come_out_of_one_command(folder):
    found = tables(folder, "--paper", "zhang2023", "--share", 0.4)
    first, second, third = found.values()
    iterations = first[0]
    assert iterations[0] == "iterations" and float(iterations[2]) < float(iterations[1]), first
    assert abs(float(iterations[3].rstrip(" %")) - 100 * (1 - float(iterations[2]) / float(iterations[1]))) < 0.5, first
    assert [row[0] for row in second] == ["x [m]", "y [m]"] and [row[0].split()[0] for row in third] == ["largest", "mean", "matching", "accuracy"]
    assert all(float(cell) > 0 for row in second + third for cell in row[1:4]), (second, third)
