"""`--cache-dir`: what did not change is taken from an earlier run, and the bytes are the same."""
import os
import random
import re
import shutil
import subprocess
import time

from plumb_test import CASCADE, PLUMB, WRONG_INPUT, copy_of, files_of, nothing_staged, plumb, refused, sequence

FAST = ["--set", "ranges.frames=10"]


def run(folder, out, *options, seen=None, code=0):
    """Runs the cascade with a store; how many results were reused and made."""
    said = plumb("run", CASCADE, "--set", f"input={seen or sequence('street')}", *FAST, "--cache-dir", folder / "store", *options, "-o", folder / out, code=code)
    numbers = re.search(r"cache: (\d+) results? reused, (\d+) made", said.err)
    return said, *(int(n) for n in numbers.groups())


def made_anew(folder, out):
    plumb("run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "-o", folder / out)
    return files_of(folder / out)


def test_a_second_run_makes_next_to_nothing_and_the_same_bytes(folder):
    expected = made_anew(folder, "without")
    _, _, first = run(folder, "first")
    _, reused, again = run(folder, "again")
    assert files_of(folder / "first") == expected == files_of(folder / "again")
    assert again <= 2 < first and reused > again, (first, reused, again)  # the source opens its folder; frames are not made
    _, _, fresh = run(folder, "fresh", "--refresh")
    assert fresh == first and files_of(folder / "fresh") == expected


def test_killed_at_any_moment_it_goes_on_from_there(folder):
    expected = made_anew(folder, "without")
    begin = time.monotonic()
    run(folder, "timed", "--refresh")
    whole = time.monotonic() - begin
    shutil.rmtree(folder / "store")
    command = [PLUMB, "run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "--cache-dir", folder / "store", "-o", folder / "out"]
    moments, kept = random.Random(7), {}
    for _ in range(5):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(moments.uniform(0.05, 0.9) * whole)
        process.kill()
        process.wait()
        for blob in (folder / "store").rglob("blobs/*/*"):
            now = (blob.stat().st_ino, blob.stat().st_mtime_ns)
            assert kept.setdefault(blob, now) == now, f"{blob} was made again"
    assert kept
    run(folder, "out")
    assert files_of(folder / "out") == expected
    assert all((blob.stat().st_ino, blob.stat().st_mtime_ns) == seen for blob, seen in kept.items())
    nothing_staged(folder)


def test_one_and_two_threads_fill_and_use_a_store_alike(folder):
    expected = made_anew(folder, "without")
    run(folder, "one", "--threads", "1")
    _, _, made = run(folder, "two", "--threads", "2")
    assert made <= 2 and files_of(folder / "one") == expected == files_of(folder / "two")


def test_after_a_change_only_what_it_touches_runs(folder):
    _, _, first = run(folder, "first")
    _, _, changed = run(folder, "changed", "--set", "fine.max_correspondence_distance=1.5m,1m,0.8m,0.6m,0.5m,0.4m,0.35m,0.3m")
    assert 2 < changed < 0.7 * first, (first, changed)
    assert files_of(folder / "changed")["trajectory.tum"] != files_of(folder / "first")["trajectory.tum"]


def test_an_input_that_changed_is_noticed(folder):
    seen = copy_of("street", folder)
    run(folder, "first", seen=seen)
    lines = (seen / "odometry.tum").read_text().splitlines()
    (seen / "odometry.tum").write_text("\n".join([lines[0], *(line.replace(" ", " 1", 1) for line in lines[1:])]) + "\n")
    run(folder, "moved", seen=seen)
    assert files_of(folder / "moved")["trajectory.tum"] != files_of(folder / "first")["trajectory.tum"]


def test_damage_is_noticed_made_again_and_said(folder):
    expected = made_anew(folder, "without")
    run(folder, "first")
    blobs = sorted(p for p in (folder / "store/blobs").rglob("*") if p.is_file())
    assert len(blobs) > 20
    for blob in blobs[::5]:
        data = bytearray(blob.read_bytes())
        data[len(data) // 2] ^= 1
        blob.write_bytes(data)
    for part in ("index.sqlite", "index.sum"):  # what it remembers would do without most of the results
        (folder / "store" / part).unlink()
    said, _, _ = run(folder, "mended")
    said.has("damaged result")
    assert files_of(folder / "mended") == expected
    said, _, again = run(folder, "again")
    assert "damaged" not in said.err and again <= 2, said


def test_a_folder_that_is_no_store_and_one_of_a_later_program(folder):
    (folder / "thesis").mkdir()
    (folder / "thesis/a.tex").write_text("mine")
    refused(plumb("run", CASCADE, "--set", f"input={sequence('street')}", "--cache-dir", folder / "thesis", "-o", folder / "out", code=WRONG_INPUT), "is not a cache")
    (folder / "store").mkdir()
    (folder / "store/plumb-store").write_text("plumb store 3\n")
    refused(plumb("run", CASCADE, "--set", f"input={sequence('street')}", "--cache-dir", folder / "store", "-o", folder / "out", code=WRONG_INPUT), "another format")
    refused(plumb("cache", "verify", "--cache-dir", folder / "store", code=WRONG_INPUT), "another format")
    assert not (folder / "out").exists()


def test_a_full_disk_costs_the_keeping_alone(folder):
    if os.geteuid() != 0 or shutil.which("mount") is None:
        print("skipped: a small file system needs root")
        raise SystemExit(77)
    expected = made_anew(folder, "without")
    small = folder / "small"
    small.mkdir()
    if os.system(f"mount -t tmpfs -o size=2m tmpfs {small} 2>/dev/null") != 0:
        print("skipped: no file system can be mounted here")
        raise SystemExit(77)
    try:
        command = ["run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "--cache-dir", small / "store"]
        plumb(*command, "-o", folder / "full").has("nothing was kept", "No space left", "make room")
        plumb(*command, "-o", folder / "again")
        assert files_of(folder / "full") == expected == files_of(folder / "again")
    finally:
        os.system(f"umount {small}")


LAST_DISTANCE = "fine.max_correspondence_distance=1.5m,1m,0.7m,0.5m,0.4m"


def test_explain_names_the_first_difference(folder):
    said, _, _ = run(folder, "first", "--explain", seen=sequence("street"))
    said.has("segments: made, all", "this cache knows no earlier run of it")
    said, _, _ = run(folder, "again", "--explain")
    said.has("segments: reused, all", "ranged: passes through\n", "fine.matches, pass 1: reused, all")
    said, _, made = run(folder, "gate", "--set", LAST_DISTANCE, "--explain")
    lines = said.out.splitlines()
    explained = {line.split(":")[0]: line for line in lines if ": made" in line or ": reused" in line or " made: " in line}
    changed = next(line for line in lines if line.startswith("fine.matches, pass 5"))
    assert "max_correspondence_distance was 0.5 m, is 0.4 m" in changed and ": made" in changed, said
    for step, line in explained.items():
        early = step in ("segments", "esf", "fpfh", "neighbours") or step.startswith(("drift.", "coarse.", "fine.")) and "pass 5" not in step and not step.endswith(
            ("pass 6", "pass 7", "pass 8"))
        assert not early or "reused" in line, line
    assert "input 'matches'" in explained["fine.solved, pass 5"]
    run(folder, "other", "--set", "max_range=40m")
    said, _, _ = run(folder, "back", "--explain")
    said.has("ranged: passes through: max_range was 40 m, is 300 m")


def test_two_runs_at_once_on_one_store(folder):
    expected = made_anew(folder, "without")
    commands = [[PLUMB, "run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "--cache-dir", folder / "store", "-o", folder / out] for out in ("a", "b")]
    runs = [subprocess.Popen([str(w) for w in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) for command in commands]
    for process in runs:
        _, said = process.communicate(timeout=600)
        assert process.returncode == 0 and "damaged" not in said, said
    assert files_of(folder / "a") == expected == files_of(folder / "b")
    plumb("cache", "verify", "--cache-dir", folder / "store")


def test_verify_inputs_looks_into_files_whose_time_stayed(folder):
    seen = copy_of("street", folder)
    run(folder, "first", "--verify-inputs", seen=seen)
    _, _, again = run(folder, "again", "--verify-inputs", seen=seen)
    assert again <= 2
    frame = sorted((seen / "frames").iterdir())[3]
    times, data = frame.stat(), bytearray(frame.read_bytes())
    data[-2] ^= 0x40  # of the last point
    frame.write_bytes(data)
    os.utime(frame, ns=(times.st_atime_ns, times.st_mtime_ns))
    _, _, made = run(folder, "changed", "--verify-inputs", seen=seen)
    assert made > again, "the change was not noticed"


def test_bounded_memory_leaves_the_same_bytes(folder):
    expected = made_anew(folder, "without")
    for threads in ("1", "2"):
        run(folder, "bounded" + threads, "--memory", "256MiB", "--threads", threads, "--refresh")
        assert files_of(folder / ("bounded" + threads)) == expected
