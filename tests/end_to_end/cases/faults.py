"""Modules that crash, hang, throw, eat memory or give numbers that are none: each is named, the other items are done, nothing is lost."""
import re

from plumb_test import BUILD, STEP_FAILED, files_of, plumb, refused, sequence

MODULES = BUILD / "tests/end_to_end/modules"
PIPELINE = """plumb: 1
name: faults
about: a graph with a step that misbehaves at the edge 1-2
parameters:
  input: {type: path, about: the sequence}
steps:
  sequence: {use: source.sequence, with: {path: $input}}
  ranges: {use: segment.by_count, from: sequence.trajectory, with: {frames: 5}}
  merged: {use: segment.merge, from: {frames: sequence.frames, ranges: ranges.ranges}}
  thinned: {use: filter.voxel_grid, from: merged, with: {voxel_size: 0.5 m}}
  segments: {use: estimate.normals, from: thinned, with: {radius: 2 m}}
  edges: {use: edges.overlap, from: {segments: segments, poses: ranges.poses}}
  matches: {use: match.nearest, from: {edges: edges, segments: segments, poses: ranges.poses}, with: {max_correspondence_distance: 1 m}}
  bad: {use: test.misbehave, from: {edges: edges, edge: edges, matches: matches}%s}
  solved: {use: solve.pose_graph, from: {matches: bad, poses: ranges.poses}}
  last: {use: test.missolve, from: solved.poses}
  straight: {use: apply.correction, from: {trajectory: sequence.trajectory, ranges: ranges.ranges, poses: last}}
  trajectory: {use: write.trajectory, from: straight}
"""


def pipeline(folder, on_error=""):
    file = folder / "faults.yaml"
    file.write_text(PIPELINE % (f", on_error: {on_error}" if on_error else ""))
    return file


def run(folder, out, deed, *options, on_error="", where="bad", store="store", code=STEP_FAILED):
    return plumb("--plugin-path", MODULES, "run", pipeline(folder, on_error), "--set", f"input={sequence('street')}", "--set", f"{where}.deed={deed}",
                 "--cache-dir", folder / store, *options, "-o", folder / out, code=code)


def kept(folder, step):
    """How many results of a step are in the store."""
    line = next((line for line in plumb("cache", "--cache-dir", folder / "store").out.splitlines() if step in line), "")
    return int(re.findall(r"\d+", line)[0]) if line else 0


def edges(said):
    return int(re.search(r" bad +(\d+) items?", said.err)[1])


def costs_its_item(folder, deed, *words, options=()):
    """The run stops with one sentence that names step and edge, all other edges are kept, and nothing is in the way of the next run."""
    good = run(folder, "good", "nothing", store="other", code=0)
    said = run(folder, "out", deed, "--executor", "process", *options)
    sentence = said.err.strip().splitlines()[-1]
    assert sentence.startswith("plumb: step 'bad' (test.misbehave), edge 1-2: "), said
    said.has(*words)
    assert not (folder / "out").exists()
    assert kept(folder, "test.misbehave") == edges(good) - 1
    again = run(folder, "again", "nothing", code=0)
    assert int(re.search(r"(\d+) results? reused", again.err)[1]) >= edges(good), again
    assert files_of(folder / "again") == files_of(folder / "good") | {"run.lock.yaml": files_of(folder / "again")["run.lock.yaml"]}


def test_a_segmentation_fault(folder):
    costs_its_item(folder, "segfault", "signal 11", "Segmentation fault")


def test_an_abort(folder):
    costs_its_item(folder, "abort", "signal 6", "Aborted")


def test_a_loop_without_end(folder):
    costs_its_item(folder, "loop", "time limit of 3 s", options=["--time-limit", "3s"])


def test_an_exception(folder):
    costs_its_item(folder, "error", "this edge is not to its liking")


def test_an_exception_of_an_odd_type(folder):
    costs_its_item(folder, "odd", "no std::exception")


def test_a_terabyte(folder):
    costs_its_item(folder, "terabyte", "memory is used up")


def test_memory_without_end(folder):
    costs_its_item(folder, "eat", "memory is used up", options=["--item-memory", "1GiB"])


def test_points_that_are_no_numbers(folder):
    costs_its_item(folder, "nan", "output 'matches' holds a point with a non-finite coordinate")


def test_a_module_that_leaves(folder):
    costs_its_item(folder, "leave", "exited with code 7")


def test_a_module_that_ends_the_program_as_if_all_were_well(folder):
    costs_its_item(folder, "exit", "exited with code 0")
    edge = "step 'bad' (test.misbehave), edge 1-2: "
    for deed, where, title in (("exit", "bad", edge), ("quick_exit", "bad", edge), ("exit", "last", "step 'last' (test.missolve): ")):
        before = files_of(folder / "good")
        said = run(folder, "good", deed, "--quiet", where=where)
        refused(said, title, "its module ended the program", "nothing is written")
        assert files_of(folder / "good") == before and not list(folder.glob(".*")), list(folder.glob(".*"))


def test_a_worker_that_is_killed_gets_a_second_try(folder):
    costs_its_item(folder, "killed", "signal 9")  # and is killed again


def test_in_one_process_what_is_thrown_costs_its_item_too(folder):
    good = run(folder, "good", "nothing", store="other", code=0)
    for deed, words in (("error", "not to its liking"), ("odd", "no std::exception"), ("terabyte", "memory is used up"), ("nan", "non-finite")):
        said = run(folder, "out", deed)
        said.has(words, "step 'bad' (test.misbehave), edge 1-2: ")
        plumb("cache", "prune", "--size", "0B", "--cache-dir", folder / "store")
        run(folder, "out", deed)
        assert kept(folder, "test.misbehave") == edges(good) - 1
    refused(run(folder, "out", "error", "--quiet"), "step 'bad'", "edge 1-2")


def test_dropped_edges_are_said_and_the_run_goes_on(folder):
    expected = None
    for deed in ("segfault", "error", "nan"):
        said = run(folder, deed, deed, "--executor", "process", on_error="drop", code=0)
        said.has("edge 1-2 is dropped (on_error: drop)")
        trajectory = files_of(folder / deed)["trajectory.tum"]
        expected = expected or trajectory
        assert trajectory == expected
    run(folder, "here", "error", on_error="drop", code=0)
    assert files_of(folder / "here")["trajectory.tum"] == expected
    run(folder, "good", "nothing", on_error="drop", code=0)
    assert files_of(folder / "good")["trajectory.tum"] != expected


def test_poses_that_are_no_numbers_stop_the_run(folder):
    for options in ((), ("--executor", "process")):
        said = run(folder, "out", "nan", *options, where="last")
        said.has("step 'last' (test.missolve): its output 'poses' holds a pose with a non-finite number")
        assert not (folder / "out").exists()
    run(folder, "out", "segfault", "--executor", "process", where="last").has("step 'last' (test.missolve): its process was ended by signal 11")


def test_on_error_is_checked(folder):
    file = pipeline(folder, "dorp")
    said = plumb("--plugin-path", MODULES, "check", file, "--set", f"input={sequence('street')}", code=1)
    said.has("faults.yaml:14:", "on_error is stop or drop, not 'dorp'")
    file.write_text(file.read_text().replace(", on_error: dorp", "").replace("with: {max_correspondence_distance: 1 m}", "with: {max_correspondence_distance: 1 m}, on_error: drop")
                    .replace("from: sequence.trajectory, with: {frames: 5}", "from: sequence.trajectory, with: {frames: 5}, on_error: drop"))
    plumb("--plugin-path", MODULES, "check", file, "--set", f"input={sequence('street')}", code=1).has("on_error: drop is for steps whose values may be empty (Matches)")


def test_a_time_limit_is_named_however_short_it_is(folder):
    for number, limit in enumerate(("0.003s", "0.02s", "0.11s", "0.3s")):
        run(folder, "out", "loop", "--executor", "process", "--time-limit", limit, store=f"store{number}").has(f"time limit of {limit[:-1]} s (--time-limit)")
