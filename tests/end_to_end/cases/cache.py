"""`plumb cache`, the folder that it looks after by itself, its bound, and damage of its index."""
import fcntl
import re
import subprocess
import threading

from plumb_test import CASCADE, PLUMB, WRONG_COMMAND_LINE, WRONG_INPUT, files_of, plumb, refused, sequence

FAST = ["--set", "ranges.frames=10"]


def filled(folder):
    """A store of one run of the cascade."""
    store = folder / "store"
    plumb("run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "--cache-dir", store, "-o", folder / "out")
    return store


def blobs_of(store):
    return sorted(p for p in (store / "blobs").rglob("*") if p.is_file())


def table_of(store):
    """What `plumb cache` shows, without times and the bound, which may be the disk's."""
    return re.sub(r" *\d{4}-.*|; bound: .*", "", plumb("cache", "--cache-dir", store).out)


def flip(file, at):
    data = bytearray(file.read_bytes())
    data[at % len(data)] ^= 4
    file.write_bytes(data)


def test_by_default_results_are_in_the_cache_folder_of_the_user(folder):
    command = ["run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "-o", folder / "out"]
    cached = {"PLUMB_CACHE_DIR": "", "XDG_CACHE_HOME": str(folder / "cache"), "HOME": str(folder / "home")}
    plumb("cache", environment=cached).has("nothing is kept yet")
    assert not (folder / "cache").exists()
    plumb(*command, environment=cached)
    assert blobs_of(folder / "cache/plumb") and not (folder / "home").exists()
    made = re.search(r"cache: \d+ results? reused, (\d+) made", plumb(*command, environment=cached).err)
    assert int(made.group(1)) <= 2, made.group()
    plumb("cache", environment=cached).has(str(folder / "cache/plumb"), "describe.fpfh", "last used")
    at_home = cached | {"XDG_CACHE_HOME": "relative"}
    plumb(*command, environment=at_home)
    assert blobs_of(folder / "home/.cache/plumb")


def test_without_a_cache_folder_and_with_none_nothing_is_kept(folder):
    command = ["run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "-o", folder / "out"]
    homeless = {"PLUMB_CACHE_DIR": "", "XDG_CACHE_HOME": "", "HOME": ""}
    plumb(*command, environment=homeless).has("nothing is kept", "--cache-dir DIR")
    refused(plumb("cache", environment=homeless, code=WRONG_COMMAND_LINE), "--cache-dir DIR")
    (folder / "thesis/plumb").mkdir(parents=True)
    (folder / "thesis/plumb/a.tex").write_text("mine")
    plumb(*command, environment=homeless | {"XDG_CACHE_HOME": str(folder / "thesis")}).has("nothing is kept", "is not a cache")
    said = plumb(*command, "--cache-dir", "none", environment={"PLUMB_CACHE_DIR": str(folder / "store")})
    assert "cache:" not in said.err and not (folder / "store").exists()


def test_former_names_of_options_mean_the_same(folder):
    store = filled(folder)
    again = ["run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "-o", folder / "again"]
    made = {}
    for words, variables in ((("--store", store), {}), ((), {"PLUMB_STORE": str(store), "PLUMB_CACHE_DIR": ""}),
                             (("--store", store, "--trust-store", "--fresh"), {}), (("--cache-dir", store, "--refresh"), {})):
        said = plumb(*again, *words, environment=variables)
        made[words] = int(re.search(r"cache: \d+ results? reused, (\d+) made", said.err)[1])
        assert files_of(folder / "again") == files_of(folder / "out") and "warning" not in said.err, said
    few, fewer, fresh, refreshed = made.values()
    assert few == fewer < fresh == refreshed, made
    plumb("cache", "--store", store).has("describe.fpfh")
    said = plumb("run", "--help").out
    assert "--cache-dir" in said and not re.search(r"--(store|fresh|trust-store|isolate)\b", said), said


def test_no_cache_reads_nothing_and_writes_nothing(folder):
    store = filled(folder)
    before = files_of(store)
    command = ["run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "-o", folder / "again"]
    said = plumb(*command, "--no-cache", environment={"PLUMB_CACHE_DIR": str(store)})
    assert "cache:" not in said.err and files_of(store) == before and files_of(folder / "again") == files_of(folder / "out"), said


def test_options_that_contradict_each_other_are_refused(folder):
    command = ["run", CASCADE, "--set", "input=.", "-o", folder / "out"]
    for words, told in ((["--no-cache", "--refresh"], "leave one of them out"), (["--no-cache", "--cache-dir", folder / "c"], "not used with --no-cache"),
                        (["--refresh", "--cache-dir", "none"], "keeps nothing"), (["--store", folder / "c", "--cache-dir", folder / "c"], "former name of --cache-dir"),
                        (["--no-cache", "--cache-size", "5GB"], "--cache-size 5GB: bounds a cache, and there is none"),
                        (["--cache-size", "5"], "--cache-size 5: is not an amount"), (["--cache-size", "many", "--cache-dir", folder / "c"], "or none"),
                        (["--isolate", "--executor", "slurm"], "former name of --executor process"), (["--isolate", "--executor", "local"], "leave one of them out")):
        refused(plumb(*command, *words, code=WRONG_COMMAND_LINE), told)
    for words in (command, ["cache", "--cache-dir", folder / "c"]):
        refused(plumb(*words, environment={"PLUMB_CACHE_SIZE": "much"}, code=WRONG_COMMAND_LINE), "PLUMB_CACHE_SIZE much: is not an amount")
    assert not list(folder.iterdir())


def test_cache_shows_what_each_step_takes_and_the_bound(folder):
    store = filled(folder)
    said = plumb("cache", "--cache-dir", store)
    assert re.search(r"; bound: .* \((the default|four fifths of what its disk has for it)\)\n", said.out), said
    plumb("cache", "--cache-dir", store, environment={"PLUMB_CACHE_SIZE": "3GB"}).has("; bound: 3GB (PLUMB_CACHE_SIZE)")
    plumb("cache", "--cache-dir", store, environment={"PLUMB_CACHE_SIZE": "none"}).has("; bound: none (PLUMB_CACHE_SIZE)")
    assert f": {len(blobs_of(store))} results" in said.out, said
    lines = {line.split()[0]: int(line.split()[1]) for line in said.out.splitlines()[3:]}
    assert lines["describe.fpfh"] > 1 and sum(lines.values()) == 2 * lines["all"], said


def test_verify_names_and_removes_what_is_damaged(folder):
    store = filled(folder)
    plumb("cache", "verify", "--cache-dir", store).has("all whole")
    blobs = blobs_of(store)
    for k, blob in enumerate(blobs[::7]):
        flip(blob, 1000 * k)
    said = plumb("cache", "--cache-dir", store, "verify", code=WRONG_INPUT).has(*(blob.name for blob in blobs[::7]))
    assert said.out.count("damaged and removed: ") == len(blobs[::7])
    assert blobs_of(store) == [blob for k, blob in enumerate(blobs) if k % 7]
    plumb("cache", "verify", "--cache-dir", store).has("all whole")


def test_a_damaged_index_is_said_and_made_anew(folder):
    store = filled(folder)
    expected, table = files_of(folder / "out"), table_of(store)
    size = (store / "index.sqlite").stat().st_size
    for k in range(4):
        flip(store / "index.sqlite", k * size // 4 + 11)
        said = plumb("run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "--cache-dir", store, "-o", folder / "out", "--quiet")
        said.has("cache: its index was damaged", "made anew")
        assert files_of(folder / "out") == expected
    flip(store / "index.sqlite", size // 2)
    plumb("cache", "verify", "--cache-dir", store, code=WRONG_INPUT).has("its index was damaged")
    plumb("cache", "verify", "--cache-dir", store).has("all whole")
    assert table_of(store) == table
    (store / "index.sum").unlink()  # as after a kill
    (store / "index.sqlite").write_bytes(b"nonsense" * 1000)
    plumb("cache", "--cache-dir", store).has("its index was damaged", "describe.fpfh")


def test_prune_frees_what_it_says(folder):
    store = filled(folder)
    before = sum(blob.stat().st_size for blob in blobs_of(store))
    plumb("cache", "prune", "--older", "1d", "--cache-dir", store).has("freed 0 B")
    said = plumb("cache", "prune", "--size", f"{before // 2}B", "--cache-dir", store)
    left = sum(blob.stat().st_size for blob in blobs_of(store))
    assert 0 < left <= before // 2 and f"{len(blobs_of(store))} results" in said.out, said
    plumb("cache", "prune", "--older", "0s", "--cache-dir", store)
    assert not blobs_of(store)
    refused(plumb("cache", "prune", "--cache-dir", store, code=WRONG_COMMAND_LINE), "--older 30d")
    refused(plumb("cache", "prune", "--size", "10", "--cache-dir", store, code=WRONG_COMMAND_LINE), "--size 10", "10GiB")
    refused(plumb("cache", "prune", "--older", "soon", "--cache-dir", store, code=WRONG_COMMAND_LINE), "--older soon", "30d")


def size_of(store):
    return sum(blob.stat().st_size for blob in blobs_of(store))


def made_by(said):
    return int(re.search(r"cache: \d+ results? reused, (\d+) made", said.err)[1])


def cut_into(frames, store, *options):
    """A run whose segments have so many frames: with results of its own."""
    return ["run", CASCADE, "--set", f"input={sequence('street')}", "--set", f"ranges.frames={frames}", "--cache-dir", store, *options]


def test_runs_hold_the_cache_below_its_bound(folder):
    store = filled(folder)
    first = size_of(store)
    plumb(*cut_into(15, folder / "alone"), "-o", folder / "alone_out")
    bound = size_of(folder / "alone") + first // 3
    said = plumb(*cut_into(15, store, "--cache-size", f"{bound}B"), "-o", folder / "other")
    assert re.search(rf"cache: removed \d+ results? \(.*\), least recently used first, to hold no more than {bound}B \(--cache-size\)\n", said.err), said
    assert "holds more than" not in said.err and size_of(store) <= bound and files_of(folder / "other") == files_of(folder / "alone_out"), said
    left = blobs_of(store)
    said = plumb(*cut_into(15, store), "-o", folder / "again", environment={"PLUMB_CACHE_SIZE": f"{bound}B"})
    assert made_by(said) <= 2 and "removed" not in said.err and blobs_of(store) == left, said
    said = plumb(*cut_into(10, store, "--cache-size", "none"), "-o", folder / "first_again")
    assert "removed" not in said.err and files_of(folder / "first_again") == files_of(folder / "out"), said
    plumb("cache", "verify", "--cache-dir", store).has("all whole")


def test_a_run_that_is_larger_than_the_bound_keeps_all_and_says_so(folder):
    command = [*cut_into(10, folder / "store"), "-o", folder / "out"]
    small = {"PLUMB_CACHE_SIZE": "10kB"}
    said = plumb(*command, environment=small)
    assert said.err.count("cache: holds more than 10kB (PLUMB_CACHE_SIZE), for this run alone made or used") == 1, said
    enough = re.search(r"give --cache-size (\w+) to keep it all", said.err)[1]
    kept = blobs_of(folder / "store")
    said = plumb(*command, "--quiet", environment=small)
    assert said.err.count("cache: holds more than") == 1 and blobs_of(folder / "store") == kept, said
    said = plumb(*command, "--cache-size", enough)
    assert made_by(said) <= 2 and "holds more than" not in said.err and blobs_of(folder / "store") == kept, said


def test_two_runs_with_a_small_bound_take_nothing_from_each_other(folder):
    expected = {}
    for frames in (10, 15):
        plumb(*cut_into(frames, "none"), "-o", folder / f"alone_{frames}")
        expected[frames] = files_of(folder / f"alone_{frames}")
    store = filled(folder)
    commands = [[PLUMB, *cut_into(10, store, "--cache-size", "1B", "--executor", "process"), "-o", folder / "10"],
                [PLUMB, *cut_into(15, store, "--cache-size", "1B"), "-o", folder / "15"]]
    runs = [subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) for command in commands]
    for run in runs:
        said = run.communicate()[1]
        assert run.returncode == 0 and "damaged" not in said, said
    assert {frames: files_of(folder / str(frames)) for frames in expected} == expected
    assert not list((store / "runs").iterdir())
    made = [made_by(plumb(*cut_into(frames, store, "--cache-size", "none"), "-o", folder / "again")) for frames in (10, 15)]
    assert min(made) <= 2, made  # of the run that ended last nothing was removed
    plumb("cache", "verify", "--cache-dir", store).has("all whole")


def test_prune_leaves_what_a_run_in_progress_holds(folder):
    store = filled(folder)
    kept = blobs_of(store)
    with open(store / "runs/another.0", "wb") as run:  # as of one whose disk is full, which cannot say what it needs
        fcntl.flock(run, fcntl.LOCK_EX)
        run.write(b"x")
        run.flush()
        said = plumb("cache", "prune", "--size", "0B", "--cache-dir", store)
        said.has("freed 0 B: 0 results; ", f", {len(kept)} of them because a run in progress holds them")
        assert blobs_of(store) == kept
    said = plumb("cache", "prune", "--size", "0B", "--cache-dir", store)
    assert not blobs_of(store) and "in progress" not in said.out, said


def test_pruning_while_a_run_goes_on_changes_no_result(folder):
    store = filled(folder)
    expected = files_of(folder / "out")
    over = threading.Event()

    def prune():
        while not over.is_set():
            plumb("cache", "prune", "--size", "100kB", "--cache-dir", store)

    pruning = threading.Thread(target=prune)
    pruning.start()
    try:
        for k in range(3):
            said = plumb("run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "--cache-dir", store, "-o", folder / f"out{k}")
            assert files_of(folder / f"out{k}") == expected and "damaged" not in said.err, said
    finally:
        over.set()
        pruning.join()
    plumb("cache", "verify", "--cache-dir", store).has("all whole")
