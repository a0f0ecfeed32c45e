"""`plumb compare` on experiments: variants x inputs x replicates in a file, verdicts, failures, baselines, sweeps."""
import csv
import io
import itertools
import json
import math
import re
import signal
import subprocess
import sys
import time
from xml.etree import ElementTree

from plumb_test import DONE, NOTHING, PIPELINES, PLUMB, SOURCE, STEP_FAILED, UNSETTLED, WORSE, WRONG_COMMAND_LINE, WRONG_INPUT, plumb, refused

# The odometry itself is judged: a run of a moment, whose error the replicates change a little and `odometry: ignore` very much.
ODOMETRY = """plumb: 1
name: wheels
parameters:
  input:    {type: path}
  truth:    {type: path, default: none}
  odometry: {type: choice, of: [use, ignore], default: use}
  voxel_size: {type: length, default: 0.05 m}
steps:
  log:        {use: source.carmen,       with: {path: $input, odometry: $odometry}}
  ranges:     {use: segment.by_distance, from: log.trajectory, with: {length: 1 m}}
  merged:     {use: segment.merge,       from: {frames: log.frames, ranges: ranges.ranges}}
  pieces:     {use: filter.voxel_grid,   from: merged, with: {voxel_size: $voxel_size}}
  edges:      {use: edges.sequential,    from: ranges.ranges}
  match_rmse: {use: measure.match_rmse,  from: {edges: edges, segments: pieces, poses: {fine: ranges.poses}}, with: {max_correspondence_distance: 0.3 m}}
  error:      {use: measure.trajectory,  from: {trajectories: {fine: log.trajectory}}, with: {truth: $truth}}
  trajectory: {use: write.trajectory,    from: log.trajectory}
  metrics:    {use: write.metrics,       from: {metrics: {error: error, match_rmse: match_rmse}}}
"""


def rooms(folder, count, length="12m"):
    """Small rooms, each another one."""
    made = [folder / f"rooms_{seed}" for seed in range(1, count + 1)]
    for seed, room in enumerate(made, 1):
        plumb("simulate", "rooms", "--seed", seed, "--length", length, "-o", room)
    return made


def experiment(folder, inputs, more="", name="stages"):
    """An experiment over these inputs; what is in it besides is `more`."""
    (folder / "wheels.yaml").write_text(ODOMETRY)
    file = folder / f"{name}.yaml"
    file.write_text(f"experiment: 1\npipeline: wheels.yaml\nprimary: error.fine.ate\ninputs: {json.dumps([str(i) for i in inputs])}\n{more}")
    return file


def outcome(*arguments, code=DONE):
    return json.loads(plumb("compare", *arguments, "--json", "--quiet", code=code).out)


def number_of(outcome, name="error.fine.ate"):
    return next(number for number in outcome["numbers"] if number["name"] == name)


def against(outcome, variant, name="error.fine.ate"):
    return number_of(outcome, name)["variants"][variant]["against"]


def test_a_against_a_is_equivalent_and_a_worse_variant_is_found(folder):
    inputs = rooms(folder, 7)
    variants = "variants:\n  same: {}\n  blind: {set: {odometry: ignore}}\n"
    said = plumb("compare", experiment(folder, inputs, variants), "--quiet", code=WORSE)
    said.has("same is the same as wheels: equivalent", "blind is ", "adjusted for 2 variants (Holm)")
    assert said.err.strip().splitlines()[-1].startswith("plumb: worse: blind is "), said
    # Of six inputs two variants at once can reach 4 / 64, which proves nothing.
    made = outcome(experiment(folder, inputs[:6], variants))
    assert against(made, "same")["verdict"] == "equivalent" and against(made, "same")["interval"] == [1, 1]
    found = against(made, "blind")
    assert found["p"] == 2 / 64 and found["adjusted_p"] == found["smallest_p"] == 4 / 64 and found["verdict"] == "large, not proven", found


def test_a_variant_that_is_worse_everywhere_is_worse(folder):
    file = experiment(folder, rooms(folder, 6), "variants:\n  blind: {set: {odometry: ignore}}\n")
    made = outcome(file, code=WORSE)
    found = against(made, "blind")
    assert found["verdict"] == "worse" and not found["on_these_data"] and found["method"] == "sign-flip over inputs", found
    assert found["p"] == found["smallest_p"] == 2 / 64 and found["ratio"] > 2
    assert not number_of(made)["exploratory"] and number_of(made, "error.fine.ate_max")["exploratory"]


def computed_once_more(result):
    """{method: comparisons} of which a second computation, by scipy and numpy and from the runs alone, found the same p and intervals."""
    done = subprocess.run([sys.executable, str(SOURCE / "tools/recomputed.py"), str(result)], capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.endswith("\n0 differ\n"), done.stdout + done.stderr
    return {method: int(count) for count, method in re.findall(r"^(\d+) comparisons, (.*): the same once more$", done.stdout, re.M)}


def test_intervals_over_inputs_are_those_of_scipy(folder):
    more = "variants:\n  thin: {set: {log.skip_frames: 4, log.drop_frames: 20 %}}\nreplicates: {count: 2, seed: 5, skip_frames: 3}\n"
    made = outcome(experiment(folder, rooms(folder, 7), more), "--save", folder / "a.json", code=(DONE, WORSE))
    found = computed_once_more(folder / "a.json")
    assert found["sign-flip over inputs"] >= 2, found
    # And what is not the same is seen.
    number_of(made)["variants"]["thin"]["against"]["interval"][0] *= 0.999
    (folder / "b.json").write_text(json.dumps(made))
    done = subprocess.run([sys.executable, str(SOURCE / "tools/recomputed.py"), str(folder / "b.json")], capture_output=True, text=True)
    assert done.returncode == 1 and "error.fine.ate, thin: the interval is" in done.stdout and done.stdout.endswith("\n1 differ\n"), done.stdout


def test_intervals_on_few_inputs_are_those_of_numpy(folder):
    """The bootstrap over segments, by other draws; and the segments' sums, from what the runs wrote."""
    inputs = rooms(folder, 2)
    file = experiment(folder, inputs, "variants:\n  thin: {set: {log.drop_frames: 20 %}}\n  coarse: {set: {voxel_size: 0.2 m}}\n")
    made = outcome(file, "-o", folder / "out", "--save", folder / "a.json", code=(DONE, WORSE))
    found = computed_once_more(folder / "a.json")
    assert found["bootstrap over segments"] >= 2 and "sign-flip over inputs" not in found, found

    def sums_of(run, name):
        return next((one["segments"] for one in run["numbers"] if one["name"] == name and "segments" in one), None)

    # The sums themselves are those of the numbers; `thin` has the stamps at which all are judged.
    for run in made["runs"]:
        sums = sums_of(run, "match_rmse.fine")
        value = next(one["value"] for one in run["numbers"] if one["name"] == "match_rmse.fine")
        assert abs(sum(sums["sum"]) / sum(sums["count"]) - value) < 1e-9 * value
        errors = sums_of(run, "error.fine.ate")
        ate = math.sqrt(sum(errors["sum"]) / sum(errors["count"]))
        judged = json.loads(plumb("evaluate", folder / run["input"], folder / "out" / run["variant"] / run["input"] / "trajectory.tum", "--json").out)
        assert (abs(ate - judged["after"]["ate_rmse"]) < 1e-5) or run["variant"] != "thin", (run["variant"], ate, judged)


def failing(folder, more=""):
    """Six inputs of which the last is so short that one variant leaves no frame of it."""
    inputs = rooms(folder, 5)
    plumb("simulate", "rooms", "--seed", 9, "--length", "12m", "-o", folder / "short")
    scans = sum(line.startswith("ROBOTLASER1") for line in (folder / "short/log.clf").read_text().splitlines())
    assert scans >= 3, scans
    return experiment(folder, [*inputs, folder / "short"], f"variants:\n  late: {{set: {{log.skip_frames: {scans - 1}}}}}\n" + more)


def test_a_run_that_fails_is_counted_and_shown_and_ends_nothing(folder):
    file = failing(folder)
    said = plumb("compare", file, "--save", folder / "a.json", "--save", folder / "a.csv", "--save", folder / "a.md", "--save", folder / "a.txt",
                 code=(STEP_FAILED, WORSE))
    said.has("late on short: failed: step 'log' (source.carmen)", "leave fewer out", "failed: variant 'late' on short: step 'log'", "wheels on short: ")
    made = json.loads((folder / "a.json").read_text())
    assert [run["input"] for run in made["runs"] if "failed" in run] == ["short"] and len(made["runs"]) == 12
    found = against(made, "late")
    assert found["failed_inputs"] == 1 and found["verdict"] in ("fails", "worse") and len(found["inputs"]) == 5, found
    table = list(csv.DictReader(io.StringIO((folder / "a.csv").read_text())))
    assert [row["input"] for row in table if row["failed"] == "1"] == ["short"]
    assert (folder / "a.md").read_text().startswith("# stages\n") and (folder / "a.txt").read_text() == said.out
    assert "no result on 1 of 6 inputs" in said.out or "worse" in said.out


def test_fail_fast_ends_with_the_first_failure(folder):
    file = failing(folder)
    text = file.read_text().replace("inputs: [", f'inputs: ["{folder / "short"}", ').replace(f', "{folder / "short"}"]', "]")
    file.write_text(text)
    said = plumb("compare", file, "--fail-fast", "--quiet", code=STEP_FAILED)
    refused(said, "late on short", "step 'log'")
    assert not said.out, said


def test_nothing_measured_has_an_exit_code_of_its_own(folder):
    inputs = rooms(folder, 1)
    file = experiment(folder, inputs, "variants:\n  same: {}\n")
    refused(plumb("compare", file, "--primary", "error.fine.atr", "--quiet", code=NOTHING), "nothing was measured", "error.fine.atr", "Did you mean 'error.fine.ate'?")
    # A step that is not there is told before the first run.
    for words in (["--primary", "eror.fine.ate"], ["--metric", "eror.fine.*"]):
        refused(plumb("compare", file, *words, code=NOTHING), "nothing was measured", "wheels.yaml: no number can be called 'eror.fine.", "the step 'error'")
    # A log by itself has no truth: what was to decide is not there.
    refused(plumb("compare", folder / "wheels.yaml", "--variant", "same=voxel_size=0.05m", "--input", inputs[0] / "log.clf", "--primary", "error.fine.ate", "--quiet",
                  code=NOTHING), "nothing was measured")


def test_without_a_truth_the_match_rmse_decides(folder):
    inputs = rooms(folder, 1)
    experiment(folder, inputs)
    said = plumb("compare", folder / "wheels.yaml", "--variant", "fine=voxel_size=0.02m", "--input", inputs[0] / "log.clf", code=(DONE, WORSE))
    said.has("match_rmse.fine [m], which decides", "time [CPU s]", "on these data")
    assert "error." not in said.out, said


def test_a_baseline_is_a_gate(folder):
    inputs = rooms(folder, 6)
    file = experiment(folder, inputs, "replicates: {count: 2, drop_frames: 2 %, skip_frames: 2}\n")
    plumb("compare", file, "--quiet", code=WRONG_COMMAND_LINE).has("nothing to compare with")
    then = experiment(folder, inputs, "replicates: {count: 2, drop_frames: 2 %, skip_frames: 2}\nvariants: {same: {}}\n", name="then")
    plumb("compare", then, "--quiet", "--save", folder / "then.json")
    # The same with other draws of the replicates, and with one that is worse under the same name.
    for seed in (1, 2):
        made = outcome(file, "--baseline", folder / "then.json", "--replicate-seed", seed)
        assert against(made, "wheels")["verdict"] == "equivalent", against(made, "wheels")
        assert all(number["unit"] != "CPU s" for number in made["numbers"]), "times are of another day"
    plumb("compare", file, "--baseline", folder / "then.json", "--quiet").has("then.json: also has what is not compared now: variant same")
    said = plumb("compare", file, "--baseline", folder / "then.json", "--set", "odometry=ignore", "--quiet", code=WORSE)
    said.has(f"higher than in {folder / 'then.json'}", "worse")
    # What cannot be held against it is no verdict.
    refused(plumb("compare", file, "--baseline", folder / "then.json", "--primary", "match_rmse.fine", "--quiet", code=NOTHING), "cannot be compared", "error.fine.ate")
    refused(plumb("compare", file, "--baseline", folder / "then.json", "--replicates", 3, "--quiet", code=NOTHING), "replicates")
    # Nor does a variant with another name, or an input that has lost its truth, beside others that have not.
    renamed = experiment(folder, inputs, "replicates: {count: 2, drop_frames: 2 %, skip_frames: 2}\nvariants: {alike: {}}\n", name="renamed")
    (inputs[5] / "truth.tum").unlink()
    refused(plumb("compare", renamed, "--baseline", folder / "then.json", "--quiet", code=NOTHING), "not in it: variant alike, input rooms_6 (by name")
    other = experiment(folder, rooms(folder, 1, length="20m"), "replicates: {count: 2, drop_frames: 2 %, skip_frames: 2}\n", name="other")
    refused(plumb("compare", other, "--baseline", folder / "then.json", "--quiet", code=NOTHING), "not in it: input rooms_1 (by name")
    (folder / "odd.json").write_text("{}")
    refused(plumb("compare", file, "--baseline", folder / "odd.json", "--quiet", code=WRONG_INPUT), "odd.json: is not what plumb compare writes")


def test_a_sweep_is_a_table(folder):
    inputs = rooms(folder, 2)
    experiment(folder, inputs)
    command = ["compare", folder / "wheels.yaml", "--sweep", "voxel_size=0.05m,0.1m,0.2m", "--sweep", "match_rmse.max_correspondence_distance=0.3m,0.2m",
               "--primary", "match_rmse.fine", *(word for room in inputs for word in ("--input", room)), "--quiet"]
    said = plumb(*command, "--format", "csv", code=(DONE, WORSE))
    rows = [row for row in csv.DictReader(io.StringIO(said.out)) if row["metric"] == "match_rmse.fine"]
    assert len(rows) == 2 * (1 + 3 * 2), rows  # the pipeline as it is, and each with each
    swept = {(row["voxel_size"], row["match_rmse.max_correspondence_distance"]) for row in rows if row["variant"] != "wheels"}
    assert swept == set(itertools.product(("0.05m", "0.1m", "0.2m"), ("0.3m", "0.2m")))
    values = {(row["variant"], row["input"]): float(row["value"]) for row in rows}
    same = "voxel_size=0.05m,match_rmse.max_correspondence_distance=0.3m"
    assert all(values[same, room.name] == values["wheels", room.name] for room in inputs)
    made = json.loads(plumb(*command, "--json", code=(DONE, WORSE)).out)
    assert against(made, same, "match_rmse.fine")["verdict"] == "equivalent" and made["swept"][same]["voxel_size"] == "0.05m"
    said = plumb(*command, "--sweep-by", "one_at_a_time", "--format", "markdown", code=(DONE, WORSE))
    assert said.out.count("| voxel\\_size=0.2m |") >= 2 and "voxel\\_size=0.2m,match" not in said.out, said
    refused(plumb(*command, "--sweep-by", "paired", code=WRONG_INPUT), "'voxel_size' has 3 values")
    plumb(*command, "--save", folder / "sweep.svg", code=(DONE, WORSE))
    plot = ElementTree.parse(folder / "sweep.svg")
    names = {text.text for text in plot.iter("{http://www.w3.org/2000/svg}text")}
    assert same in names and len(list(plot.iter("{http://www.w3.org/2000/svg}circle"))) == 6, names


def test_what_is_common_is_made_once_and_a_second_run_makes_nothing(folder):
    inputs = rooms(folder, 2)
    file = experiment(folder, inputs, "variants:\n  coarse: {set: {voxel_size: 0.2 m}}\n")
    first = outcome(file, "--cache-dir", folder / "cache", "--events", folder / "events", code=(DONE, WORSE))
    begun, runs = None, {}
    for line in (folder / "events").read_text().splitlines():
        event = json.loads(line)
        if event["event"] == "run_begins":
            begun = runs.setdefault(event["sentence"], {})
        elif event["event"] == "item" and not event["reused"]:
            begun[event["step"]] = begun.get(event["step"], 0) + event.get("items", 1)
    assert list(runs) == ["wheels on rooms_1", "coarse on rooms_1", "wheels on rooms_2", "coarse on rooms_2"]
    for room in inputs:
        made = runs[f"coarse on {room.name}"]
        assert made.get("pieces") and "error" not in made and "ranges" not in made and "edges" not in made, made
        assert runs[f"wheels on {room.name}"].get("error") == 1
    second = outcome(file, "--cache-dir", folder / "cache", code=(DONE, WORSE))
    assert against(first, "coarse", "match_rmse.fine")["ratio"] == against(second, "coarse", "match_rmse.fine")["ratio"]
    assert all(run["reused"] > 0 for run in second["runs"])
    times = [one for run in second["runs"] for one in run["numbers"] if one["name"] == "time"]
    assert len(times) == 4 and all(one["cached"] for one in times), times
    assert "against" not in number_of(second, "time")["variants"]["coarse"]
    plumb("compare", file, "--cache-dir", folder / "cache", "--quiet", code=(DONE, WORSE)).has("* was spent in part in earlier runs or by another variant")


def test_killed_it_goes_on_and_makes_nothing_twice(folder):
    file = experiment(folder, rooms(folder, 3, length="20m"), "variants:\n  coarse: {set: {voxel_size: 0.2 m}}\n"
                      "  near: {set: {match_rmse.max_correspondence_distance: 0.2 m}}\n")
    command = ["compare", file, "--cache-dir", folder / "cache", "--quiet", "--save", folder / "a.json", "--events"]
    first, second = folder / "events_1.jsonl", folder / "events_2.jsonl"
    running = subprocess.Popen([str(word) for word in (PLUMB, *command, first)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while running.poll() is None and not (first.exists() and first.read_text().count('"run_begins"') == 5):
        time.sleep(0.001)
    running.kill()
    assert running.wait() == -signal.SIGKILL and not (folder / "a.json").exists()
    plumb(*command, second, code=(DONE, WORSE))
    assert json.loads((folder / "a.json").read_text())["runs"]
    done = subprocess.run([sys.executable, str(SOURCE / "tools/made_once.py"), *map(str, (file, first, second)), "--plumb", str(PLUMB)],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    said = done.stdout.splitlines()
    assert said[0].startswith("3 variants on 3 inputs, in ") and said[0].endswith("runs of which 1 were cut off") and said[-1] == "0 made twice", said
    common, made_of_common = (int(number) for number in re.findall(r"\d+", said[2]))
    every, made, again = (int(number) for number in re.findall(r"\d+", said[3]))
    assert 0 < common < every and made == every + again and made_of_common <= common + again and again < made / 9, said


def test_an_experiment_is_checked_before_anything_runs(folder):
    inputs = rooms(folder, 1)
    file = experiment(folder, inputs, "variants:\n  odd: {set: {voxle_size: 0.2 m}}\n")
    said = plumb("compare", file, code=WRONG_INPUT)
    said.has(f"{file}:6:15: the pipeline has no parameter 'voxle_size'.", "  odd: {set: {voxle_size: 0.2 m}}", "Did you mean 'voxel_size'?")
    file.write_text(file.read_text().replace("primary: error.fine.ate\n", "").replace("voxle", "voxel"))
    plumb("compare", file, code=WRONG_INPUT).has("'primary' is missing")
    other = folder / "other.yaml"
    other.write_text("plumb: 1\npipeline: wheels.yaml\nprimary: error.fine.ate\nvariants: {same: {}}\n")
    plumb("compare", other, code=WRONG_INPUT).has("expected 'experiment: 1'", f"{other}:1:1: an experiment has no key 'plumb'.")
    plumb("check", other, code=WRONG_INPUT).has("is an experiment, not a pipeline", "plumb compare")
    plumb("run", file, "-o", folder / "out", code=WRONG_INPUT).has("is an experiment, not a pipeline", "plumb compare")
    file = experiment(folder, inputs, "variants: {same: {}}\ntime: [measure., regster.]\n")
    refused(plumb("compare", file, code=WRONG_INPUT), f"{file}:6:7: 'time' regster.: no step of {folder / 'wheels.yaml'} uses one", "behind 'use'")
    file = experiment(folder, inputs, "variants: {same: {}}\nreplicates: {count: 2, seeds: true}\n")
    refused(plumb("compare", file, code=WRONG_INPUT), "no step of any variant has a parameter 'seed'")
    plumb("compare", file, "--save", folder / "a.doc", code=WRONG_COMMAND_LINE).has("its ending says how it is written")
    plumb("compare", file, "--margin", "5", code=WRONG_COMMAND_LINE).has("as in 5%")


def test_replicates_disturb_all_variants_alike_and_are_kept_apart(folder):
    inputs = rooms(folder, 1)
    file = experiment(folder, inputs, "variants:\n  same: {}\nreplicates: {count: 3, drop_frames: 10 %, phase: true}\n")
    made = outcome(file, "-o", folder / "out")
    assert against(made, "same")["verdict"] == "equivalent" and against(made, "same")["method"] == "identical"
    values = [one["value"] for run in made["runs"] if run["variant"] == "wheels" for one in run["numbers"] if one["name"] == "error.fine.ate"]
    assert len(set(values)) == 3, values
    assert sorted(p.name for p in (folder / "out/wheels/rooms_1").iterdir()) == ["replicate_1", "replicate_2", "replicate_3"]
    locks = [(folder / f"out/wheels/rooms_1/replicate_{k}/run.lock.yaml").read_text() for k in (1, 2, 3)]
    assert "drop_frames: 10 %" not in locks[0] and all("drop_frames: 10 %" in lock for lock in locks[1:]), locks


def test_the_tables_of_a_page_follow_from_a_result(folder):
    """tools/packages.py, by the result of another experiment."""
    file = experiment(folder, rooms(folder, 2), "variants:\n  same: {}\n  blind: {set: {odometry: ignore}}\n")
    made = outcome(file, "--save", folder / "a.json", code=(DONE, WORSE))
    shipped = (PIPELINES / "experiments/README.md").read_text()
    (folder / "page.md").write_text(shipped)
    tool = [sys.executable, str(SOURCE / "tools/packages.py"), "--from", str(folder / "a.json"), "--page", str(folder / "page.md")]
    subprocess.run(tool, check=True, capture_output=True)
    page = (folder / "page.md").read_text()
    mark = "<!-- tools/packages.py writes what follows -->\n"
    assert page.partition(mark)[0] == shipped.partition(mark)[0] and page.endswith(shipped[shipped.rindex("<!--"):])
    tables = page[page.index(mark):page.rindex("<!--")]
    assert tables.startswith(f"{mark}\n2 variants on 2 inputs; no runs failed. `error.fine.ate` decides;") and "?" not in tables, tables
    assert "| `same` | +0.0 % (+0.0 % to +0.0 %) | 0 / 0 | - | equivalent | +0.0 % (+0.0 % to +0.0 %) |\n" in tables, tables
    found = against(made, "blind")
    assert f"| `blind` | {100 * (found['ratio'] - 1):+.0f} % (" in tables and f"| {found['verdict']}, on these data |" in tables, tables
    values = number_of(made)["variants"]["blind"]["values"]
    assert f"| rooms_1 | {number_of(made)['variants']['wheels']['values'][0]:.3f} |" in tables and f"| {values[0]:.3f} (`blind`) |" in tables, tables
    subprocess.run(tool, check=True, capture_output=True)
    assert (folder / "page.md").read_text() == page


def test_a_result_that_cannot_be_saved_is_said(folder):
    file = experiment(folder, rooms(folder, 1), "variants: {same: {}}\n")
    said = plumb("compare", file, "--save", folder / "nowhere/a.json", "--quiet", code=UNSETTLED)
    said.has("nowhere/a.json", "all runs are done", "error.fine.ate")
