"""run.lock.yaml says all that the results depend on; --locked repeats a run, or says what is no longer as it was."""
import os
import re
import shutil
import subprocess
import time

from plumb_test import (CAR, CASCADE, PLUMB, STEP_FAILED, WRONG_COMMAND_LINE, WRONG_INPUT, copy_of, files_of, nothing_left, plumb, refused, sequence,
                        shipped_pipelines)

POSES = """plumb: 1
parameters:
  input: {type: path}
steps:
  sequence: {use: source.sequence,  with: {path: $input}}
  copy:     {use: write.trajectory, from: sequence.trajectory}
"""


def poses(folder, out, *options, seen=None):
    (folder / "poses.yaml").write_text(POSES)
    plumb("run", folder / "poses.yaml", "--set", f"input={seen or sequence('straight')}", *options, "-o", folder / out)
    return folder / out / "run.lock.yaml"


def repeat(lock, out, *options, code=0):
    return plumb("run", "--locked", lock, *options, "-o", out, code=code)


def refuse(lock, *words):
    out = lock.parent.parent / "refused"
    said = repeat(lock, out, code=WRONG_INPUT)
    refused(said, lock.name, *words)
    nothing_left(out)
    return said


def edited(lock, old, new):
    text = lock.read_text()
    assert old in text, f"'{old}' is not in\n{text}"
    lock.write_text(text.replace(old, new, 1))
    return lock


def set_time_back(file, times):
    os.utime(file, ns=(times.st_atime_ns, times.st_mtime_ns))


def test_a_locked_run_leaves_the_same_bytes(folder):
    street = sequence("street")
    plumb("run", CASCADE, "--preset", CAR, "--set", f"input={street}", "--set", f"truth={street / 'truth.tum'}", "--set", "coarse.max_correspondence_distance=3m,1.5m", "-o", folder / "out")
    repeat(folder / "out/run.lock.yaml", folder / "again", "--threads", 1)
    assert files_of(folder / "out") == files_of(folder / "again")
    repeat(folder / "out/run.lock.yaml", folder / "out")  # into the same folder
    assert files_of(folder / "out") == files_of(folder / "again")


def test_relative_paths_hold_from_any_folder(folder):
    (folder / "here").mkdir()
    (folder / "here/street").symlink_to(sequence("straight"))
    (folder / "here/poses.yaml").write_text(POSES)
    plumb("run", "poses.yaml", "--set", "input=street", "-o", "out", cwd=folder / "here")
    plumb("run", "--locked", "here/out/run.lock.yaml", "-o", "again", cwd=folder)
    assert files_of(folder / "here/out") == files_of(folder / "again")
    said = plumb("run", "--locked", "here/out/run.lock.yaml", "-o", "again", cwd=folder)
    assert said.out.splitlines()[-2].startswith("poses: "), said  # the name that the file gave


def test_the_lock_names_versions_modules_and_inputs(folder):
    street = sequence("straight")
    text = poses(folder, "out").read_text()
    files = [p for p in street.rglob("*") if p.is_file()]
    assert re.search(r'^  sequence: \{use: source.sequence, version: \d+, module: [0-9a-f]{32}\}$', text, re.M), text
    assert f'  - path: "{street}"\n    files: {len(files)}\n    bytes: {sum(p.stat().st_size for p in files)}\n    digest: ' in text, text
    assert "content:" not in text and "- trajectory.tum" in text
    assert "    content: " in poses(folder, "out", "--verify-inputs").read_text()


def test_results_inside_of_an_input_are_no_input(folder):
    street = copy_of("straight", folder)
    for _ in range(2):
        plumb("run", CASCADE, "--preset", CAR, "--set", f"input={street}", "-o", street / "out")
    lock = (street / "out/run.lock.yaml").read_text()
    repeat(street / "out/run.lock.yaml", street / "again")
    assert (street / "again/run.lock.yaml").read_text() == lock


def test_one_changed_byte_of_an_input_is_noticed(folder):
    street = copy_of("straight", folder)
    by_time, by_content = poses(folder, "time", seen=street), poses(folder, "content", "--verify-inputs", seen=street)
    frame = sorted((street / "frames").iterdir())[3]
    times, data = frame.stat(), bytearray(frame.read_bytes())
    data[-1] ^= 1
    frame.write_bytes(data)
    refuse(by_time, "names, sizes and times of the input", str(street), "--verify-inputs")
    refuse(by_content, "content of the input", str(street))
    set_time_back(frame, times)
    refuse(by_content, "content of the input", str(street))
    repeat(by_time, folder / "unseen")  # says so in the README: size and time are as they were


def test_where_the_content_is_known_times_do_not_matter(folder):
    street = copy_of("straight", folder)
    by_time, by_content = poses(folder, "time", seen=street), poses(folder, "content", "--verify-inputs", seen=street)
    expected = (folder / "content/trajectory.tum").read_bytes()
    street.rename(folder / "moved")
    shutil.copytree(folder / "moved", street, copy_function=shutil.copyfile)
    refuse(by_time, "names, sizes and times")
    repeat(by_content, folder / "again")
    assert (folder / "again/trajectory.tum").read_bytes() == expected


def test_an_input_that_lacks_a_file_or_is_gone(folder):
    street = copy_of("straight", folder)
    lock = poses(folder, "out", seen=street)
    frame = sorted((street / "frames").iterdir())[-1]
    files = len([p for p in street.rglob("*") if p.is_file()])
    frame.unlink()
    refuse(lock, f"was {files} files, is {files - 1}")
    frame.write_bytes(b"longer than that" * 100)
    refuse(lock, "bytes, is ")
    shutil.rmtree(street)
    refuse(lock, f"was {files} files, is gone")


def test_what_stands_in_the_lock_otherwise_is_refused_with_both_values(folder):
    text = poses(folder, "out").read_text()
    lock = folder / "out/run.lock.yaml"
    module = re.search(r"source.sequence, version: \d+, module: ([0-9a-f]{32})", text)[1]
    for old, new, *words in (
            ("plumb: 0", "plumb: 9", "plumb was version 9", "is version 0"),
            ("abi: \"plumb-sdk ", "abi: \"plumb-sdk 9", "the ABI was 'plumb-sdk 9", "is 'plumb-sdk "),
            ("use: source.sequence, version: 1", "use: source.sequence, version: 71", "step 'sequence' (source.sequence) was version 71, is version 1"),
            (module, module[::-1], "the module of step 'sequence'", f"was {module[::-1]}, is {module}"),
            ("use: write.trajectory", "use: write.nothing", "step 'copy' (write.nothing)", "is not installed"),
            ("    files: ", "    files: 9", "the input", " files, is "),
            ("digest: ", "digest: Z", "32 hexadecimal digits"),
            ("    copy:\n      use: write", "    copy:\n      use: wrote", "its pipeline was changed"),
            ("pipeline: |\n", "pipeline: |\n  # mine\n", "its pipeline was changed"),
            ("inputs:\n", "inputs:\nmore: 1\n", "is expected", "damaged")):
        lock.write_text(text)
        refuse(edited(lock, old, new), *words)
    lock.write_text(text)
    said = repeat(edited(edited(lock, "plumb: 0", "plumb: 9"), "version: 1", "version: 71"), folder / "refused", code=WRONG_INPUT)
    assert len(said.err.splitlines()) == 2 and all(line.startswith("plumb: ") for line in said.err.splitlines()), said


def test_a_file_that_is_no_lock_or_half_of_one(folder):
    text = poses(folder, "out").read_text()
    lock = folder / "out/run.lock.yaml"
    lock.write_text(text[:len(text) // 2])
    refuse(lock)
    lock.write_text("# A run of Plumb: what made the files beside this one.\nplumb: 0.1.0\nfiles:\n  - trajectory.tum\nsteps:\n")  # of an earlier Plumb
    refuse(lock, "'abi: ' is expected", "damaged or of another Plumb")
    lock.write_bytes(b"\x00\xff" * 5000)
    refuse(lock, "no record of a run")
    refused(repeat(CASCADE, folder / "no", code=WRONG_INPUT), "no record of a run")
    refused(repeat(folder, folder / "no", code=WRONG_INPUT), "run.lock.yaml")
    refused(repeat(folder / "none", folder / "no", code=WRONG_INPUT), "cannot be opened (No such file or directory)")
    nothing_left(folder / "no")


def test_it_takes_no_pipeline_beside_it(folder):
    lock = poses(folder, "out")
    for more in ([CASCADE], ["--preset", CAR], ["--set", "input=."]):
        said = repeat(lock, folder / "no", *more, code=WRONG_COMMAND_LINE)
        assert "--locked" in said.err, said
    nothing_left(folder / "no")
    said = plumb("run", lock, "-o", folder / "no", code=WRONG_INPUT).has("record of a run", "--locked")


def test_every_pipeline_that_is_shipped_reads_back_from_its_resolved_text(folder):
    bare = lambda text: [line for line in re.sub(r"(^| +)#.*", "", text, flags=re.M).splitlines() if line]
    for file in shipped_pipelines():
        estimate = ["--set", "estimate=."] if "estimate:" in file.read_text() else []
        first = plumb("resolve", file, "--set", "input=.", *estimate).out
        (folder / "resolved.yaml").write_text(first)
        second = plumb("resolve", folder / "resolved.yaml").out
        assert bare(first) == bare(second), file


def change_while_it_runs(folder, change):
    """Runs the cascade on a copy of a sequence, which `change` changes once the run has begun."""
    seen = copy_of("street", folder)
    events = folder / "events"
    run = subprocess.Popen([PLUMB, "run", CASCADE, "--set", f"input={seen}", "--set", "ranges.frames=10", "--quiet", "--events", events, "-o", folder / "out"],
                           stderr=subprocess.PIPE, text=True)
    while run.poll() is None and not (events.exists() and "run_begins" in events.read_text()):
        time.sleep(0.005)
    change(seen)
    said = run.communicate()[1]
    assert run.returncode == STEP_FAILED and f"the input '{seen}' was changed while it was read" in said and "--refresh" in said, (run.returncode, said)
    nothing_left(folder / "out")


def test_a_frame_that_is_written_again_while_it_is_read_ends_the_run(folder):
    change_while_it_runs(folder, lambda seen: os.utime(next((seen / "frames").iterdir()), (0, 0)))


def test_a_frame_that_comes_while_others_are_read_ends_the_run(folder):
    change_while_it_runs(folder, lambda seen: (seen / "notes.txt").write_text("of somebody"))
