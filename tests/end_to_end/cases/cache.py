"""`plumb cache`, the folder that it looks after by itself, and damage of its index."""
import re
import threading

from plumb_test import CASCADE, WRONG_COMMAND_LINE, WRONG_INPUT, files_of, plumb, refused, sequence

FAST = ["--set", "ranges.frames=10"]


def filled(folder):
    """A store of one run of the cascade."""
    store = folder / "store"
    plumb("run", CASCADE, "--set", f"input={sequence('street')}", *FAST, "--cache-dir", store, "-o", folder / "out")
    return store


def blobs_of(store):
    return sorted(p for p in (store / "blobs").rglob("*") if p.is_file())


def table_of(store):
    """What `plumb cache` shows, without times."""
    return re.sub(r" *\d{4}-.*", "", plumb("cache", "--cache-dir", store).out)


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
                        (["--isolate", "--executor", "slurm"], "former name of --executor process"), (["--isolate", "--executor", "local"], "leave one of them out")):
        refused(plumb(*command, *words, code=WRONG_COMMAND_LINE), told)
    assert not list(folder.iterdir())


def test_cache_shows_what_each_step_takes(folder):
    store = filled(folder)
    said = plumb("cache", "--cache-dir", store)
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
