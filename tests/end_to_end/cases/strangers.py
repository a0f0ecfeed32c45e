"""A store that somebody else made, may write or has put things into: its results are made again or it is refused, and nothing waits for a pipe."""
import ctypes
import os
import re
import shutil
import stat
import struct

from plumb_test import CASCADE, WRONG_INPUT, files_of, nothing_left, plumb, refused, sequence, skip

NOBODY = 65534


def run(folder, out, *options, store="store", code=0):
    return plumb("run", CASCADE, "--set", f"input={sequence('street')}", "--set", "ranges.frames=10", "--cache-dir", folder / store, *options,
                 "-o", folder / out, code=code)


def blobs(folder):
    return sorted(p for p in (folder / "store/blobs").rglob("*") if p.is_file())


class Sum(ctypes.Structure):
    _fields_ = [("low", ctypes.c_uint64), ("high", ctypes.c_uint64)]


def xxhash():
    try:
        library = ctypes.CDLL("libxxhash.so.0")
    except OSError:
        skip("libxxhash, which makes checksums that fit, is not on this machine")
    library.XXH3_128bits.restype, library.XXH3_128bits.argtypes = Sum, [ctypes.c_char_p, ctypes.c_size_t]
    return library.XXH3_128bits


def poison(folder, type_name, change):
    """`change(bytes, place of the value)` writes into the first value of every result that begins with this type; the checksum is made to fit. How many."""
    sum_of, changed = xxhash(), 0
    for blob in blobs(folder):
        data = bytearray(blob.read_bytes())
        head = 29 + 8 + struct.unpack_from("<Q", data, 29)[0]  # magic, key, name of the step
        name = struct.pack("<Q", len(type_name)) + type_name.encode()
        if data[head + 16:head + 16 + len(name)] != name:  # behind the numbers of outputs and of values
            continue
        change(data, head + 16 + len(name) + 4)
        fit = sum_of(bytes(data[:-16]), len(data) - 16)
        blob.write_bytes(bytes(data[:-16]) + struct.pack("<QQ", fit.high, fit.low))
        changed += 1
    assert changed, type_name
    for part in ("index.sqlite", "index.sum"):  # what it remembers would do without most of the results
        (folder / "store" / part).unlink(missing_ok=True)
    return changed


def edge_beyond(data, at):
    struct.pack_into("<I", data, at + 12 + 4, 1_000_000)  # segments, number of edges; the first edge's i, j


def pose_of_no_numbers(data, at):
    struct.pack_into("<d", data, at + 8 + 32, float("nan"))  # number of poses; the first one's rotation, translation


def range_beyond(data, at):
    struct.pack_into("<I", data, at + 4, 4_000_000_000)  # the segment's first frame, its end


def no_values(data, at):
    """As many outputs, the first of them without a value: what follows is read as something else, or does not fit."""
    struct.pack_into("<Q", data, at - 4 - 8 - len("Matches") - 8, 0)


def test_values_that_no_step_gives_are_made_again_though_their_checksum_fits(folder):
    expected = run(folder, "first") and files_of(folder / "first")
    poisons = [("Edges", edge_beyond, "holds an edge between segments that there are not"),
               ("Poses", pose_of_no_numbers, "holds a pose with a non-finite number"),
               ("Segment", range_beyond, "holds a range of frames that does not have a pose for each of them"),
               ("Matches", no_values, "")]
    for number, (type_name, change, why) in enumerate(poisons):
        for options in ((), ("--executor", "process")):
            changed = poison(folder, type_name, change)
            said = run(folder, f"out{number}", *options)
            seen = int(re.search(r"cache: (\d+) damaged result", said.err)[1])
            assert 0 < seen <= changed, said  # what nobody asked for is still there
            said.has("removed and made again", why)
            assert files_of(folder / f"out{number}") == expected, f"{type_name} {options}"
            plumb("cache", "verify", "--cache-dir", folder / "store", code=WRONG_INPUT if seen < changed else 0)
            assert "damaged" not in run(folder, "again").err


def test_verify_finds_values_that_no_step_gives(folder):
    run(folder, "first")
    changed = poison(folder, "Edges", edge_beyond)
    said = plumb("cache", "verify", "--cache-dir", folder / "store", code=WRONG_INPUT)
    assert said.out.count("damaged and removed: ") == changed, said
    plumb("cache", "verify", "--cache-dir", folder / "store").has("all whole")


def test_pipes_and_links_in_a_store_are_never_opened(folder):
    expected = run(folder, "first") and files_of(folder / "first")
    theirs = folder / "theirs"
    for put in (os.mkfifo, lambda place: os.symlink(theirs, place)):
        for name in ("index.sqlite", "index.sum", "index.sqlite-wal"):
            theirs.write_text("not to be touched")
            (folder / "store" / name).unlink(missing_ok=True)
            put(folder / "store" / name)
            run(folder, "out").has("its index was damaged")
            assert files_of(folder / "out") == expected and theirs.read_text() == "not to be touched", name
        for blob in blobs(folder)[::7]:
            blob.unlink()
            put(blob)
        said = run(folder, "out", "--executor", "process").has("damaged result", "is not a regular file")
        assert files_of(folder / "out") == expected and theirs.read_text() == "not to be touched", said
        blob = blobs(folder)[0]
        blob.unlink()
        put(blob)
        plumb("cache", "verify", "--cache-dir", folder / "store", code=WRONG_INPUT).has("damaged and removed")
        lock = folder / "store/index.lock"
        lock.unlink()
        put(lock)
        run(folder, "out").has("its index is not used", "index.lock' is not a regular file")
        refused(plumb("cache", "prune", "--size", "0B", "--cache-dir", folder / "store", code=WRONG_INPUT),
                "its index cannot be used", "remove it", "nothing was removed")
        lock.unlink()
        mark = folder / "store/plumb-store"
        mark.unlink()
        put(mark)
        refused(run(folder, "no", "--quiet", code=WRONG_INPUT), "plumb-store' is not a regular file")
        mark.unlink()
        mark.write_text("plumb store 2\n")
        mark.chmod(0o600)


def test_a_store_is_made_for_its_user_alone(folder):
    run(folder, "first")
    assert stat.S_IMODE((folder / "store").stat().st_mode) == 0o700
    run(folder, "second", store="deep/er/store/")
    assert stat.S_IMODE((folder / "deep/er/store").stat().st_mode) == 0o700


def test_a_store_that_others_may_write_or_own_is_refused_unless_that_is_said(folder):
    expected = run(folder, "first") and files_of(folder / "first")
    store = folder / "store"

    def is_refused(*words):
        refused(run(folder, "no", "--quiet", code=WRONG_INPUT), str(store), *words, "--trust-cache")
        refused(run(folder, "no", "--quiet", "--executor", "process", code=WRONG_INPUT), *words, "--trust-cache")
        nothing_left(folder / "no")
        for command in ([], ["verify"], ["prune", "--size", "0B"]):
            refused(plumb("cache", *command, "--cache-dir", store, code=WRONG_INPUT), *words)
        for options in ((), ("--executor", "process")):
            said = run(folder, "out", "--trust-cache", *options)
            assert files_of(folder / "out") == expected and "damaged" not in said.err, said
        plumb("cache", "verify", "--cache-dir", store, "--trust-cache").has("all whole")

    store.chmod(0o777)
    is_refused("may be written by everybody (mode 0777)", "chmod -R go-w")
    store.chmod(0o770)
    is_refused("may be written by its group (mode 0770)", "chmod -R go-w")
    store.chmod(0o700)
    run(folder, "out")
    if os.geteuid() == 0:
        os.chown(store, NOBODY, NOBODY)
        is_refused("belongs to user", "chown")


def test_the_users_own_store_is_gone_without_when_others_may_write_it(folder):
    cache = folder / "cache/plumb"
    cache.mkdir(parents=True)
    cache.chmod(0o777)
    said = plumb("run", CASCADE, "--set", f"input={sequence('straight')}", "--set", "ranges.frames=5", "-o", folder / "out",
                 environment={"PLUMB_CACHE_DIR": "", "XDG_CACHE_HOME": str(folder / "cache")})
    said.has("nothing is kept", "may be written by everybody", "--trust-cache")
    assert not list(cache.iterdir()) and (folder / "out/trajectory.tum").exists()
    shutil.rmtree(cache)
    plumb("run", CASCADE, "--set", f"input={sequence('straight')}", "--set", "ranges.frames=5", "-o", folder / "out",
          environment={"PLUMB_CACHE_DIR": "", "XDG_CACHE_HOME": str(folder / "cache")})
    assert stat.S_IMODE(cache.stat().st_mode) == 0o700 and (cache / "blobs").is_dir()
