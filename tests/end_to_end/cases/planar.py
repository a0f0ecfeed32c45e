"""The 2-D system on simulated buildings and real logs: every scan gets a pose, maps agree with the plan, loops are right."""
import gzip
import json

import numpy as np

from judge import Trajectory
from plumb_test import PLANAR as SYSTEM
from plumb_test import STEP_FAILED, UNIMPROVED, plumb, real_file

FILES = ["map.pgm", "map.png", "map.yaml", "metrics.json", "run.lock.yaml", "trajectory.tum"]


def building(folder, scene, *options):
    plumb("simulate", scene, *options, "-o", folder)
    return folder


def run(folder, out, *options, log="log.clf"):
    """Runs the system on a simulated building; the numbers of its metrics by stage."""
    plumb("run", SYSTEM, "--set", f"input={folder / log}", "--set", f"truth={folder / 'truth.tum'}", "--set", f"plan={folder / 'plan.txt'}",
          *options, "-o", out)
    stages = json.loads((out / "metrics.json").read_text())["stages"]
    return {stage["stage"]: {name: number["value"] for name, number in stage["numbers"].items()} for stage in stages}


def test_rooms_come_out_as_planned_with_every_scan_under_its_stamp(folder):
    seen = building(folder / "rooms", "rooms")
    numbers = run(seen, folder / "out")
    assert sorted(p.name for p in (folder / "out").iterdir()) == FILES
    ours, truth = Trajectory.read(folder / "out/trajectory.tum"), Trajectory.read(seen / "truth.tum")
    assert len(ours) == len(truth) and np.allclose(ours.stamps, truth.stamps, rtol=0, atol=1e-6)
    assert numbers["error"]["before.ate"] > 0.3 and numbers["error"]["fine.ate"] < 0.05, numbers["error"]
    assert numbers["map_error"]["mean"] < 0.05 and numbers["map_error"]["accuracy"] > 0.95, numbers["map_error"]
    assert numbers["loops"]["loops"] > 0, numbers["loops"]


def test_rooms_need_no_odometry(folder):
    seen = building(folder / "rooms", "rooms")
    numbers = run(seen, folder / "out", "--set", "odometry=ignore")
    assert numbers["error"]["before.ate"] > 2 and numbers["error"]["fine.ate"] < 0.1, numbers["error"]


def test_a_packed_log_gives_the_same_bytes_as_a_plain_one_on_any_number_of_threads(folder):
    seen = building(folder / "rooms", "rooms")
    (seen / "log.clf.gz").write_bytes(gzip.compress((seen / "log.clf").read_bytes()))
    run(seen, folder / "plain", "--threads", "1")
    run(seen, folder / "packed", "--threads", "2", log="log.clf.gz")
    for name in ("trajectory.tum", "map.pgm", "metrics.json"):
        assert (folder / "plain" / name).read_bytes() == (folder / "packed" / name).read_bytes(), name


def test_corridors_that_look_alike_are_not_taken_for_each_other(folder):
    for seed in ("1", "2"):
        seen = building(folder / seed, "lookalike", "--seed", seed)
        numbers = run(seen, folder / ("out" + seed))
        # A false loop joins places 10 m apart.
        assert numbers["error"]["fine.ate"] < 0.1, (seed, numbers["error"])
        assert numbers["loops"]["loops"] > 0, (seed, numbers["loops"])


def test_each_stretch_without_scans_starts_the_window_again_and_it_finds_its_way(folder):
    for scene in ("rooms", "corridor", "lookalike"):
        seen = building(folder / scene, scene, "--seed", "2", "--kidnap", "3")
        numbers = run(seen, folder / (scene + "_out"))
        assert numbers["gate"]["resets"] == 3 and numbers["stitched"]["resets"] >= 3, (scene, numbers["gate"], numbers["stitched"])
        assert numbers["error"]["fine.ate"] < 0.1, (scene, numbers["error"])


def test_a_corridor_needs_no_odometry(folder):
    seen = building(folder / "corridor", "corridor")
    numbers = run(seen, folder / "out", "--set", "odometry=ignore")
    assert numbers["error"]["before.ate"] > 5 and numbers["error"]["fine.ate"] < 0.15, numbers["error"]


def test_the_unimproved_system_is_worse_by_what_the_paper_says(folder):
    seen = building(folder / "corridor", "corridor", "--seed", "2")
    ours = run(seen, folder / "ours")
    theirs = run(seen, folder / "theirs", "--preset", UNIMPROVED)
    for stage, name, less in [("error", "fine.displacement_x", 61.90), ("error", "fine.displacement_y", 62.86),
                              ("map_error", "largest", 61.70), ("map_error", "mean", 43.24)]:
        assert ours[stage][name] < (1 - less / 100) * theirs[stage][name], (name, ours[stage], theirs[stage])


def test_a_log_cut_in_the_middle_of_a_line_is_used_up_to_there(folder):
    seen = building(folder / "rooms", "rooms")
    log = (seen / "log.clf").read_bytes()
    (seen / "cut.clf").write_bytes(log[: 2 * len(log) // 3 + 11])
    plumb("run", SYSTEM, "--set", f"input={seen / 'cut.clf'}", "-o", folder / "out").has("left out")
    assert len(Trajectory.read(folder / "out/trajectory.tum")) > 100


def test_what_is_no_log_is_refused(folder):
    (folder / "no.clf").write_text("hello\n")
    plumb("run", SYSTEM, "--set", f"input={folder / 'no.clf'}", "-o", folder / "out", code=STEP_FAILED).has("no.clf")
    assert not (folder / "out").exists()


def relations_of(folder, name, odometry):
    log, relations = real_file(f"laser2d/{name}.clf.bz2"), real_file(f"laser2d/{name}.relations")
    plumb("run", SYSTEM, "--set", f"input={log}", "--set", f"relations={relations}", "--set", f"odometry={odometry}", "-o", folder / "out")
    stages = {stage["stage"]: stage for stage in json.loads((folder / "out/metrics.json").read_text())["stages"]}
    numbers = {name: number["value"] for name, number in stages["relation_error"]["numbers"].items()}
    print(numbers)
    return numbers["fine.translation"], np.degrees(numbers["fine.rotation"])


def test_aces_fits_its_relations(folder):
    translation, rotation = relations_of(folder, "aces", "use")
    assert translation <= 0.050 and rotation <= 0.8, (translation, rotation)


def test_aces_fits_its_relations_without_odometry(folder):
    translation, rotation = relations_of(folder, "aces", "ignore")
    assert translation <= 0.050 and rotation <= 0.8, (translation, rotation)


def test_intel_fits_its_relations(folder):
    translation, rotation = relations_of(folder, "intel", "use")
    assert translation <= 0.040 and rotation <= 1.0, (translation, rotation)


def test_intel_fits_its_relations_without_odometry(folder):
    translation, rotation = relations_of(folder, "intel", "ignore")
    assert translation <= 0.040 and rotation <= 1.0, (translation, rotation)
