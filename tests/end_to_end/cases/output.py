"""The folder that -o names and the file that --log names: whole or not there, and nobody else's lost."""
import os
import shutil
import signal
import subprocess
import time

from plumb_test import (CASCADE, PLUMB, POSES, STEP_FAILED, UNSETTLED, WRONG_COMMAND_LINE, WRONG_INPUT, cascade, files_of, nothing_left,
                        nothing_staged, plumb, poses_pipeline, refused, sequence)


def run(folder, *options, code=0):
    return plumb("run", poses_pipeline(folder), "--set", f"input={sequence('street')}", *options, code=code)


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
    refused(run(folder, "-o", "", code=WRONG_COMMAND_LINE), "empty", "-o")


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


def staged(beside):
    """What is made beside a place at the moment: markers and folders."""
    return sorted(beside.parent.glob(f".{beside.name}.plumb-*"))


def started(*command, beside):
    """Starts a command and waits until it has begun to stage its output."""
    process = subprocess.Popen([PLUMB, *map(str, command)], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, start_new_session=True)
    for _ in range(3000):
        if len(staged(beside)) == 2:
            return process
        time.sleep(0.01)
    raise AssertionError("nothing was staged in 30 s")


def long_run(folder, out="out"):
    return "run", CASCADE, "--set", f"input={sequence('street')}", "-o", folder / out


def test_what_a_killed_run_left_is_removed_by_the_next(folder):
    process = started(*long_run(folder), beside=folder / "out")
    process.kill()
    process.communicate()
    marker, left = staged(folder / "out")[1], staged(folder / "out")[0]
    assert left.is_dir() and marker.name == left.name + ".lock", (left, marker)
    run(folder, "-o", folder / "out")
    assert not staged(folder / "out")


def test_what_a_run_that_goes_on_has_staged_is_not_touched_by_another(folder):
    process = started(*long_run(folder), beside=folder / "out")
    process.send_signal(signal.SIGSTOP)
    before = staged(folder / "out")
    run(folder, "-o", folder / "out")
    assert staged(folder / "out") == before
    process.send_signal(signal.SIGCONT)
    process.communicate(timeout=120)
    assert process.returncode == 0 and (folder / "out/map.ply").exists() and not staged(folder / "out")


def test_folders_beside_the_output_stay_whatever_their_names(folder):
    gone = subprocess.Popen(["true"])
    gone.wait()
    names = ["fin.old-2024", f"fin.old-{gone.pid}", f"fin.partial-{gone.pid}", "fin.kept-1", ".fin.plumb-0123456789ab", ".fin.plumb-0123456789ab.old"]
    for name in names:
        (folder / name).mkdir()
        (folder / name / "thesis.tex").write_text("mine\n")
    (folder / ".fin.plumb-0123456789ab.lock").write_text("token 0123456789ab\n")
    for _ in range(2):
        run(folder, "-o", folder / "fin")
    (folder / "fin").rename(folder / "elsewhere")
    plumb("run", folder / "poses.yaml", "--set", f"input={folder}", "-o", folder / "fin", code=STEP_FAILED)  # finds no sequence there
    assert not (folder / "fin").exists(), "another's folder was taken for it"
    for name in names:
        assert files_of(folder / name) == {"thesis.tex": b"mine\n"}, name


def test_a_user_s_own_things_in_the_output_stay(folder):
    def refuses(*words):
        before = files_of(folder / "out")
        refused(run(folder, "-o", folder / "out", code=WRONG_INPUT), "give another folder with -o", *words)
        assert files_of(folder / "out") == before
        shutil.rmtree(folder / "out")
        run(folder, "-o", folder / "out")

    run(folder, "-o", folder / "out")
    trajectory, lock = folder / "out/trajectory.tum", folder / "out/run.lock.yaml"
    trajectory.unlink()
    trajectory.mkdir()
    (trajectory / "notes.txt").write_text("mine\n")
    refuses("'trajectory.tum' that no run of Plumb wrote")
    (folder / "out/thesis.tex").write_text("mine\n")
    lock.write_text(lock.read_text().replace("files:\n", "files:\n  - thesis.tex: {bytes: 5, hash: 00000000000000000000000000000000}\n"))
    refuses("run.lock.yaml was changed since")
    trajectory.write_text(trajectory.read_text().replace("0", "1", 1))
    refuses("'trajectory.tum' was changed since a run wrote it")
    (folder / "elsewhere.tum").write_bytes(trajectory.read_bytes())
    trajectory.unlink()
    trajectory.symlink_to("../elsewhere.tum")
    refuses("'trajectory.tum' that no run of Plumb wrote")
    assert (folder / "elsewhere.tum").exists()


def test_a_simulation_that_was_changed_stays(folder):
    arguments = ["blocks", "--frames", 3, "--lines", 4, "--columns", 32, "-o", folder / "blocks"]
    plumb("simulate", *arguments)
    for change in (lambda out: (out / "frames/mine.pcd").write_text("mine\n"), lambda out: (out / "odometry.tum").write_text("mine\n"),
                   lambda out: (out / "scene.yaml").write_text("# mine\n" + (out / "scene.yaml").read_text()), lambda out: (out / "log.clf").mkdir()):
        plumb("simulate", *arguments)
        change(folder / "blocks")
        before = files_of(folder / "blocks")
        refused(plumb("simulate", *arguments, code=WRONG_INPUT), "blocks: ", "name another folder with -o")
        assert files_of(folder / "blocks") == before
        shutil.rmtree(folder / "blocks")


def test_a_planted_link_is_not_written_through(folder):
    """In a folder that others may write to; also for a run that knows what its staging is called."""
    (folder / "victim").write_text("precious\n")
    (folder / "shared").mkdir()
    (folder / "shared").chmod(0o1777)
    process = started(*long_run(folder / "shared"), beside=folder / "shared/out")
    process.send_signal(signal.SIGSTOP)
    staging = staged(folder / "shared/out")[0]
    for name in ("trajectory.tum", "run.lock.yaml", "map.ply"):
        (staging / name).symlink_to(folder / "victim")
    process.send_signal(signal.SIGCONT)
    said = process.communicate(timeout=120)[1]
    assert process.returncode == STEP_FAILED and "cannot be written (File exists)" in said, said
    assert (folder / "victim").read_text() == "precious\n" and not (folder / "shared/out").exists()


def interrupted(number, *command, beside):
    """Interrupts a command as soon as it has begun to stage its output, and gives what it said."""
    process = started(*command, beside=beside)
    process.send_signal(number)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 128 + number and "interrupted" in said, (process.returncode, said)


def test_an_interrupted_run_leaves_nothing_and_keeps_what_was_there(folder):
    run(folder, "-o", folder / "out")
    before = files_of(folder / "out")
    for name in ("INT", "TERM", "HUP", "QUIT", "PIPE", "XFSZ", "XCPU", "ALRM", "USR1"):
        interrupted(signal.Signals["SIG" + name], *long_run(folder), beside=folder / "out")
        assert files_of(folder / "out") == before
        nothing_staged(folder)
    interrupted(signal.SIGQUIT, *long_run(folder, "new/inner/out"), beside=folder / "new/inner/out")
    assert not (folder / "new").exists()


def test_an_interrupted_simulation_leaves_nothing(folder):
    interrupted(signal.SIGINT, "simulate", "city_loop", "--frames", "400", "-o", folder / "city", beside=folder / "city")
    assert not list(folder.iterdir()), list(folder.iterdir())


def test_output_that_cannot_be_said_has_an_exit_code_of_its_own(folder):
    command = f"{PLUMB} run {poses_pipeline(folder)} --set input={sequence('street')} -o {folder}/out"
    simulation = f"{PLUMB} simulate blocks --frames 3 --lines 4 --columns 32 -o {folder}/blocks"
    nobody_reads = f"{{ {command}; echo $? >{folder}/code; }} | true"
    for line, made in ((f"{command} >/dev/full", "out/trajectory.tum"), (f"{command} >&-", "out/trajectory.tum"), (nobody_reads, "out/trajectory.tum"),
                       (f"{simulation} >/dev/full", "blocks/truth.tum"), (f"{PLUMB} list >/dev/full", None), (f"{PLUMB} --help >/dev/full", None)):
        said = subprocess.run(["bash", "-c", line], capture_output=True, text=True)
        code = int((folder / "code").read_text()) if line == nobody_reads else said.returncode
        assert code == UNSETTLED and "standard output does not take what was to be said" in said.stderr, (line, said)
        if made:
            (folder / made).unlink()  # is there
        nothing_staged(folder)


def test_a_disk_that_takes_no_more_leaves_nothing(folder):
    run(folder, "-o", folder / "out")
    before = files_of(folder / "out")
    for small, big in (("run", long_run(folder)), ("simulate", ("simulate", "city_loop", "--frames", 20, "-o", folder / "city"))):
        line = "ulimit -f 8; exec " + " ".join(map(str, (PLUMB, *big)))
        said = subprocess.run(["bash", "-c", line], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        assert said.returncode == STEP_FAILED and "cannot be written (File too large)" in said.stderr, (small, said)
    assert files_of(folder / "out") == before and not (folder / "city").exists()
    nothing_staged(folder)


def test_no_point_left_is_said(folder):
    said = cascade(sequence("street"), folder / "out", "--set", "ranges.frames=2", "--set", "min_range=190m", "--set", "max_range=200m", code=STEP_FAILED)
    said.has("no point is left for the map")
    nothing_left(folder / "out")


def test_the_store_and_the_results_lie_apart(folder):
    run(folder, "-o", folder / "out", "--cache-dir", folder / "store")
    refused(run(folder, "-o", folder / "out", "--cache-dir", folder / "out/store", code=WRONG_INPUT), "--cache-dir", "beside")
    refused(run(folder, "-o", folder / "store/out", "--cache-dir", folder / "store", code=WRONG_INPUT), "lies in --cache-dir", "another folder")
    assert not (folder / "out/store").exists() and not (folder / "store/out").exists()
    run(folder, "-o", folder / "out", "--cache-dir", folder / "store")


def test_what_is_to_be_changed_is_named_first(folder):
    """Not an option that was not given, nor one that is as good as it was yesterday."""
    pipeline = poses_pipeline(folder)
    (folder / "full").mkdir()
    (folder / "full/thesis.tex").write_text("mine")
    out, full = folder / "out", folder / "full"
    for words, variables, named in (
            (["-o", "/"], {"PLUMB_CACHE_DIR": str(folder / "store")}, "-o /: "),
            (["-o", "/"], {"PLUMB_CACHE_DIR": "", "XDG_CACHE_HOME": str(folder)}, f"-o /: the results get a folder of their own, and this one holds the cache {folder}"),
            (["-o", "/", "--cache-dir", folder / "store"], {}, "-o /: "),
            (["-o", "/", "--log", folder / "log"], {}, "-o /: "),
            (["-o", full, "--cache-dir", full / "store"], {}, f"-o {full}: "),
            (["-o", out], {"PLUMB_CACHE_DIR": str(out / "store")}, f"-o {out}: "),
            (["-o", out, "--cache-dir", out / "store"], {}, f"--cache-dir {out}/store: "),
            (["-o", out, "--store", out / "store"], {}, f"--store {out}/store: "),
            (["-o", full / "out", "--cache-dir", full], {}, f"--cache-dir {full}: "),
            (["-o", full / "out"], {"PLUMB_CACHE_DIR": str(full)}, f"PLUMB_CACHE_DIR={full}: "),
            (["-o", out, "--cache-dir", "/"], {}, "--cache-dir /: "),
            (["-o", out, "--cache-dir", full], {}, f"--cache-dir {full}: holds something else"),
            (["-o", out], {"PLUMB_CACHE_DIR": str(full)}, f"PLUMB_CACHE_DIR={full}: holds something else"),
            (["-o", out, "--log", out / "log"], {}, f"--log {out}/log: ")):
        said = plumb("run", pipeline, "--set", f"input={sequence('street')}", *words, environment=variables, code=WRONG_INPUT)
        refused(said)
        assert said.err.startswith(f"plumb: {named}"), said
    refused(run(folder, "-o", "/", code=WRONG_INPUT), "is the root of all folders", "with -o")
    refused(plumb("cache", environment={"PLUMB_CACHE_DIR": "none"}, code=WRONG_COMMAND_LINE), "PLUMB_CACHE_DIR=none: there is nothing to look after")
    assert files_of(folder) == {"poses.yaml": POSES.encode(), "full/thesis.tex": b"mine"}


def test_an_empty_value_is_not_taken_for_none(folder):
    for option in ("--memory", "--cache-dir", "--log", "--events", "--time-limit", "--item-memory"):
        refused(run(folder, "-o", folder / "out", option, "", code=WRONG_COMMAND_LINE), option, "is empty")
    assert not (folder / "out").exists()


def test_events_go_into_a_pipe_and_to_a_device(folder):
    os.mkfifo(folder / "pipe")
    reader = subprocess.Popen(["cat", folder / "pipe"], stdout=subprocess.PIPE, text=True)
    run(folder, "-o", folder / "out", "--events", folder / "pipe", "--trace", "/dev/null")
    told, _ = reader.communicate(timeout=60)
    assert told.startswith('{"event":"run_begins"') and '"event":"run_ends"' in told.splitlines()[-1]
    run(folder, "-o", folder / "out", "--log", "/dev/full").has("/dev/full: is not whole", "the results are whole")
    assert set(files_of(folder / "out")) == {"trajectory.tum", "run.lock.yaml"}
