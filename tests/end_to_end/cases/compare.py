"""`plumb compare` runs a pipeline and variants of it on the same inputs and says what differs."""
import json
import math

from plumb_test import (DONE, NOTHING, PIPELINES, STEP_FAILED, WORSE, WRONG_COMMAND_LINE, WRONG_INPUT, files_of, plumb, refused)

COMPARED = (DONE, WORSE)  # which of the two these small rooms make of it does not matter here

SMALL = """plumb: 1
name: chained
parameters:
  input: {type: path}
  truth: {type: path, default: none}
steps:
  log:      {use: source.carmen,        with: {path: $input}}
  each:     {use: segment.by_distance,  from: log.trajectory, with: {length: 0.5 m, max_rotation: 15 deg}}
  raw:      {use: segment.merge,        from: {frames: log.frames, ranges: each.ranges}}
  scans:    {use: filter.voxel_grid,    from: raw, with: {voxel_size: 0.05 m}}
  lined:    {use: estimate.normals,     from: scans, with: {planar: true, radius: 0.25 m, max_neighbours: none}}
  next:     {use: edges.sequential,     from: each.ranges}
  matched:
    use: register.ia_icp
    from: {edges: next, targets: lined, sources: scans, poses: each.poses}
    with: {metric: line, start_sigma: 0.1 m, max_correspondence_distance: 0.3 m}
  chained:  {use: apply.chain,          from: {poses: each.poses, registrations: matched}}
  straight: {use: apply.correction,     from: {trajectory: log.trajectory, ranges: each.ranges, poses: chained.poses}}
  error:
    use: measure.trajectory
    from: {trajectories: {before: log.trajectory, fine: straight}}
    with: {truth: $truth}
  trajectory: {use: write.trajectory,   from: straight}
"""

# Nothing is near enough to be laid onto: the odometry stays.
LOOSE = """plumb: 1
name: loose
extends: chained.yaml
set: {matched.max_correspondence_distance: 0.001 m}
"""


def files(folder, seeds=(1, 2)):
    """The pipeline, the preset and small rooms; what the command needs of them."""
    (folder / "chained.yaml").write_text(SMALL)
    (folder / "loose.yaml").write_text(LOOSE)
    rooms = [folder / f"rooms_{seed}" for seed in seeds]
    for seed, room in zip(seeds, rooms):
        plumb("simulate", "rooms", "--seed", seed, "-o", room)
    return ["compare", folder / "chained.yaml", "--variant", f"loose={folder}/loose.yaml"], rooms


def test_means_are_those_of_the_runs_that_it_keeps(folder):
    command, rooms = files(folder)
    inputs = [word for room in rooms for word in ("--input", room)]
    said = json.loads(plumb(*command, *inputs, "-o", folder / "out", "--json", "--quiet", code=COMPARED).out)
    assert said["variants"] == ["chained", "loose"] and said["inputs"] == ["rooms_1", "rooms_2"]
    numbers = {number["name"]: number for number in said["numbers"]}
    assert {"error.fine.ate", "matching time", "matching iterations", "time"} <= set(numbers) and "error.before.ate" not in numbers
    ate = numbers["error.fine.ate"]["variants"]
    for name, of in ate.items():
        for room, value in zip(rooms, of["values"]):
            kept = folder / "out" / name / room.name
            judged = json.loads(plumb("evaluate", room, kept / "trajectory.tum", "--json").out)["after"]["ate_rmse"]
            assert abs(value - judged) < 1e-5, (name, room, value, judged)
        assert abs(of["mean"] - math.sqrt(of["values"][0] * of["values"][1])) < 1e-12
    against = ate["loose"]["against"]
    assert abs(against["ratio"] - ate["loose"]["mean"] / ate["chained"]["mean"]) < 1e-9
    low, high = against["interval"]
    assert low <= against["ratio"] <= high and against["on_these_data"]


def test_table_has_a_row_a_number_and_a_line_a_run(folder):
    command, rooms = files(folder, seeds=[1])
    said = plumb(*command, "--input", rooms[0] / "log.clf", "--set", f"truth={rooms[0]}/truth.tum", "--metric", "error.*.ate",
                 "--time", "filter.", "--primary", "error.fine.ate", code=COMPARED)
    said.has("chained on log.clf:", "loose on log.clf:", "error.before.ate [m]", "error.fine.ate [m], which decides", "filter.* time [CPU s]",
             "on these data", "a statement beyond these data needs 6 inputs")
    assert "error.fine.ate_max" not in said.out and said.out.startswith("error.fine.ate"), said
    block = said.out[said.out.index("error.before.ate"):].split("\n\n")[0]
    assert "loose is the same as chained: equivalent" in block, block  # nothing that came before the variants differ
    row = next(line for line in block.splitlines() if line.strip().startswith("log.clf")).split()
    assert row[1] == row[2], row


def test_refuses_in_one_sentence_before_anything_runs(folder):
    command, rooms = files(folder, seeds=[1])
    given = ["--input", rooms[0]]
    refused(plumb(*command, "--input", folder / "nowhere", code=WRONG_INPUT), "nowhere", "no such file or folder", "give")
    refused(plumb(*command, "--variant", f"loose={folder}/loose.yaml", *given, code=WRONG_INPUT), "a 'loose' already")
    refused(plumb(*command, *given, "--time", "regster.", code=WRONG_INPUT), "--time regster.", "no step")
    plumb(*command[:2], "--variant", f"x={folder}/none.yaml", *given, code=WRONG_INPUT).has("none.yaml")
    plumb(*command, *given, "--set", "nothing=1", code=WRONG_INPUT).has("nothing")
    (folder / "out/loose/rooms_1").mkdir(parents=True)
    (folder / "out/loose/rooms_1/thesis.tex").write_text("mine")
    refused(plumb(*command, *given, "-o", folder / "out", code=WRONG_INPUT), "thesis.tex", "give another folder")
    assert files_of(folder / "out") == {"loose/rooms_1/thesis.tex": b"mine"}


def test_a_wrong_command_line_exits_with_2(folder):
    command, rooms = files(folder, seeds=[1])
    for arguments in (command, [*command[:2], "--input", rooms[0]], [*command[:2], "--variant", "loose", "--input", rooms[0]],
                      [*command[:2], "--variant", f"../up={folder}/loose.yaml", "--input", rooms[0]]):
        said = plumb(*arguments, code=WRONG_COMMAND_LINE)
        assert said.err.strip() and not said.out, said


def test_a_name_that_leads_out_of_the_output_is_refused(folder):
    command, rooms = files(folder, seeds=[1])
    for name in ("../escaped", str(folder / "absolute"), "a/b", ".hidden", "..", "\\x1b[2J", "x" * 201):
        (folder / "chained.yaml").write_text(SMALL.replace("name: chained", f'name: "{name}"'))
        said = plumb(*command, "--input", rooms[0], "-o", folder / "out/inner", code=WRONG_INPUT)
        refused(said, "chained.yaml: its name", "is not a name for a file or folder", "choose another")
        assert "\x1b" not in said.err, said
    (folder / "chained.yaml").write_text(SMALL)
    for name in ("../up", "/abs", ".hidden", "a/b"):
        said = plumb(*command[:2], "--variant", f"{name}={folder}/loose.yaml", "--input", rooms[0], "-o", folder / "out/inner", code=WRONG_COMMAND_LINE)
        said.has("is not a name for")
    rooms[0].rename(folder / ".rooms")
    refused(plumb(*command, "--input", folder / ".rooms", "-o", folder / "out/inner", code=WRONG_INPUT), "--input", "is not a name for")
    assert sorted(p.name for p in folder.iterdir()) == [".rooms", "chained.yaml", "loose.yaml"]


def test_a_step_s_file_stays_in_the_output(folder):
    _, rooms = files(folder, seeds=[1])
    for name in ("../escaped.tum", "/tmp/absolute.tum", "a/b.tum", ".hidden", "run.lock.yaml"):
        said = plumb("run", folder / "chained.yaml", "--set", f"input={rooms[0] / 'log.clf'}", "--set", f"trajectory.name={name}", "-o", folder / "out",
                     code=WRONG_INPUT)
        said.has("choose another")
    assert not (folder / "out").exists() and not (folder / "escaped.tum").exists()


def test_an_input_with_a_dollar_in_its_name(folder):
    command, rooms = files(folder, seeds=[1])
    rooms[0].rename(folder / "rooms$truth")
    said = json.loads(plumb(*command, "--input", folder / "rooms$truth", "--json", "--quiet", code=COMPARED).out)
    assert said["inputs"] == ["rooms$truth"]


def test_the_cache_lies_in_no_folder_of_results(folder):
    command, rooms = files(folder, seeds=[1])
    place = folder / "out/chained/rooms_1"
    refused(plumb(*command, "--input", rooms[0], "-o", folder / "out", "--cache-dir", place / "store", code=WRONG_INPUT), f"--cache-dir {place}/store: ")
    assert not (folder / "out").exists()


def test_an_input_that_is_given_twice_is_refused(folder):
    command, rooms = files(folder, seeds=[1])
    plumb(*command, "--input", rooms[0], "--input", rooms[0], code=WRONG_INPUT).has("given twice")
    plumb(*command, "--input", rooms[0], "--set", f"input={rooms[0]}", code=WRONG_COMMAND_LINE).has("--input sets it")


def test_says_which_variant_failed_on_which_input(folder):
    command, rooms = files(folder, seeds=[1])
    (folder / "loose.yaml").write_text(LOOSE.replace("set: {matched.max_correspondence_distance: 0.001 m}", "set: {matched.max_correspondence_distance: 0.3 m}\n"
                                                     "replace:\n  lined: {use: filter.voxel_grid, from: scans, with: {voxel_size: 0.06 m}}"))
    said = plumb(*command, "--input", rooms[0], "--quiet", code=STEP_FAILED)
    said.has("variant 'loose' on", "rooms_1", "step 'matched'", "needs normals", "loose gives nothing to hold against chained: no result on 1 of 1 input")
    assert said.err.strip().splitlines()[-1].startswith("plumb: 1 of 2 runs failed"), said
    said = plumb(*command, "--input", rooms[0], "--metric", "error.fine.atr", "--quiet", code=NOTHING)
    assert said.err.strip().splitlines()[-1].startswith("plumb: nothing was measured") and "error.fine.ate'" in said.err, said


def test_the_paper_s_pipeline_takes_its_unimproved_variant(folder):
    plumb("check", PIPELINES / "zhang2023.yaml", "--preset", PIPELINES / "presets/zhang2023_unimproved.yaml", "--set", "input=.").has("good")


def test_another_program_s_trajectory_stands_beside_ours(folder):
    plumb("simulate", "rooms", "--length", "12m", "-o", folder / "rooms")
    # The truth itself, as if another program had found it, and the odometry.
    for name, source in (("perfect", "truth.tum"), ("wheels", "odometry.tum")):
        (folder / f"rooms/{name}.tum").write_bytes((folder / "rooms" / source).read_bytes())
    judge = PIPELINES / "judge2d.yaml"
    said = plumb("compare", PIPELINES / "zhang2023.yaml", "--variant", f"perfect={judge}", "--variant", f"wheels={judge}",
                 "--input", folder / "rooms", "--json", "--quiet")
    numbers = {number["name"]: number["variants"] for number in json.loads(said.out)["numbers"]}
    ate = {name: of["mean"] for name, of in numbers["error.fine.ate"].items()}
    assert ate["perfect"] < 1e-6 < ate["zhang2023"] < ate["wheels"], ate
    assert numbers["map_error.mean"]["perfect"]["mean"] < numbers["map_error.mean"]["wheels"]["mean"], numbers["map_error.mean"]
    assert "matching time" not in numbers, numbers  # ours alone has it
    (folder / "rooms/wheels.tum").unlink()
    said = plumb("compare", PIPELINES / "zhang2023.yaml", "--variant", f"wheels={judge}", "--input", folder / "rooms", "--quiet", code=WRONG_INPUT)
    said.has("estimate")


def test_the_bound_of_a_cache_is_held_over_all_runs(folder):
    command, rooms = files(folder)
    blobs = (folder / "store/blobs").rglob
    plumb(*command, "--input", rooms[0], "--cache-dir", folder / "store", code=COMPARED)
    earlier = {blob.name for blob in blobs("*") if blob.is_file()}
    bounded = [*command, "--input", rooms[1], "--cache-size", "1kB"]
    refused(plumb(*bounded, code=WRONG_COMMAND_LINE), "--cache-size 1kB: bounds a cache, and there is none")
    said = plumb(*bounded, "--cache-dir", folder / "store", code=COMPARED)
    assert said.err.count("cache: removed ") == 1 and said.err.count("cache: holds more than 1kB (--cache-size)") == 1, said
    kept = {blob.name for blob in blobs("*") if blob.is_file()}
    assert kept and earlier - kept, said
    said = plumb(*bounded, "--cache-dir", folder / "store", code=COMPARED)  # the first of its runs does not remove what the second will use
    assert "cache: removed" not in said.err and kept == {blob.name for blob in blobs("*") if blob.is_file()}, said
