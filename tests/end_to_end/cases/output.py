"""The folder that -o names and the file that --log names: whole or not there, and nobody else's lost."""
import os
import signal
import subprocess
import time

from plumb_test import CASCADE, PLUMB, STEP_FAILED, WRONG_INPUT, cascade, files_of, nothing_left, plumb, refused, sequence

POSES = """plumb: 1
name: poses
parameters:
  input: {type: path}
steps:
  sequence: {use: source.sequence,  with: {path: $input}}
  copy:     {use: write.trajectory, from: sequence.trajectory}
"""


def run(folder, *options, code=0):
    (folder / "poses.yaml").write_text(POSES)
    return plumb("run", folder / "poses.yaml", "--set", f"input={sequence('street')}", *options, code=code)


def test_a_link_leads_to_the_folder_and_stays_a_link(folder):
    (folder / "disk").mkdir()
    (folder / "out").symlink_to("disk")
    for _ in range(2):
        run(folder, "-o", folder / "out")
        assert (folder / "out").is_symlink() and set(files_of(folder / "disk")) == {"trajectory.tum", "run.lock.yaml"}
    plumb("simulate", "rooms", "--length", "12m", "-o", folder / "out", code=WRONG_INPUT)
    assert set(files_of(folder / "disk")) == {"trajectory.tum", "run.lock.yaml"}


def test_a_link_to_nothing_and_no_name_at_all(folder):
    (folder / "out").symlink_to("nowhere")
    refused(run(folder, "-o", folder / "out", code=WRONG_INPUT), "leads nowhere")
    refused(run(folder, "-o", "", code=WRONG_INPUT), "empty", "-o")


def test_a_log_replaces_a_log_and_nothing_else(folder):
    (folder / "thesis.txt").write_text("mine\n")
    refused(run(folder, "-o", folder / "out", "--log", folder / "thesis.txt", code=WRONG_INPUT), "thesis.txt", "no log of plumb")
    assert (folder / "thesis.txt").read_text() == "mine\n" and not (folder / "out").exists()
    refused(run(folder, "-o", folder / "out", "--log", folder / "out/run.log", code=WRONG_INPUT), "beside")
    refused(run(folder, "-o", folder / "out", "--log", folder / "none/run.log", code=WRONG_INPUT), "folder that exists")
    assert not (folder / "none").exists()
    for _ in range(2):
        run(folder, "-o", folder / "out", "--log", folder / "run.log")
        text = (folder / "run.log").read_text()
        assert text.count("copy") == 1 and text.startswith("# "), text


def test_what_a_killed_run_left_is_removed_by_the_next(folder):
    gone = subprocess.Popen(["true"])
    gone.wait()
    (folder / f"out.partial-{gone.pid}").mkdir()
    (folder / f"out.partial-{os.getpid()}").mkdir()  # of a run that still goes
    (folder / "out.partial-notes").mkdir()
    run(folder, "-o", folder / "out")
    assert sorted(p.name for p in folder.iterdir() if p.is_dir()) == ["out", f"out.partial-{os.getpid()}", "out.partial-notes"]


def interrupted(number, *command, beside):
    """Starts a command, interrupts it as soon as it has begun to stage its output, and gives what it said."""
    process = subprocess.Popen([PLUMB, *command], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, start_new_session=True)
    for _ in range(3000):
        if list(beside.parent.glob(beside.name + ".partial-*")):
            break
        time.sleep(0.01)
    else:
        raise AssertionError("nothing was staged in 30 s")
    process.send_signal(number)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 128 + number and "interrupted" in said, (process.returncode, said)


def test_an_interrupted_run_leaves_nothing_and_keeps_what_was_there(folder):
    run(folder, "-o", folder / "out")
    before = files_of(folder / "out")
    for number in (signal.SIGINT, signal.SIGTERM):
        interrupted(number, "run", CASCADE, "--set", f"input={sequence('street')}", "-o", folder / "out", beside=folder / "out")
        assert files_of(folder / "out") == before
        assert not list(folder.glob("out.*")), list(folder.glob("out.*"))


def test_an_interrupted_simulation_leaves_nothing(folder):
    interrupted(signal.SIGINT, "simulate", "city_loop", "--frames", "400", "-o", folder / "city", beside=folder / "city")
    assert not list(folder.iterdir()), list(folder.iterdir())


def test_what_a_killed_run_had_moved_away_comes_back(folder):
    run(folder, "-o", folder / "out")
    before = files_of(folder / "out")
    gone = subprocess.Popen(["true"])
    gone.wait()
    (folder / "out").rename(folder / f"out.old-{gone.pid}")
    plumb("run", folder / "poses.yaml", "--set", f"input={folder}", "-o", folder / "out", code=STEP_FAILED)  # finds no sequence there
    assert files_of(folder / "out") == before and not list(folder.glob("out.*"))


def test_output_that_cannot_be_said_is_a_failure(folder):
    with open("/dev/full", "w") as full:
        assert subprocess.run([PLUMB, "list"], stdout=full, stderr=subprocess.DEVNULL).returncode != 0


def test_no_point_left_is_said(folder):
    said = cascade(sequence("street"), folder / "out", "--set", "ranges.frames=2", "--set", "min_range=190m", "--set", "max_range=200m", code=STEP_FAILED)
    said.has("no point is left for the map")
    nothing_left(folder / "out")


def test_the_store_and_the_results_lie_apart(folder):
    run(folder, "-o", folder / "out", "--store", folder / "store")
    refused(run(folder, "-o", folder / "out", "--store", folder / "out/store", code=WRONG_INPUT), "--store", "beside")
    refused(run(folder, "-o", folder / "store/out", "--store", folder / "store", code=WRONG_INPUT), "lies in the store", "another folder")
    assert not (folder / "out/store").exists() and not (folder / "store/out").exists()
    run(folder, "-o", folder / "out", "--store", folder / "store")


def test_an_empty_value_is_not_taken_for_none(folder):
    for option in ("--memory", "--store", "--log", "--events", "--time-limit", "--item-memory"):
        refused(run(folder, "-o", folder / "out", option, "", code=WRONG_INPUT), option, "is empty")
    assert not (folder / "out").exists()


def test_events_go_into_a_pipe_and_to_a_device(folder):
    os.mkfifo(folder / "pipe")
    reader = subprocess.Popen(["cat", folder / "pipe"], stdout=subprocess.PIPE, text=True)
    run(folder, "-o", folder / "out", "--events", folder / "pipe", "--trace", "/dev/null")
    told, _ = reader.communicate(timeout=60)
    assert told.startswith('{"event":"run_begins"') and '"event":"run_ends"' in told.splitlines()[-1]
    run(folder, "-o", folder / "out", "--log", "/dev/full").has("/dev/full: is not whole", "the results are whole")
    assert set(files_of(folder / "out")) == {"trajectory.tum", "run.lock.yaml"}
