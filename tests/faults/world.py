"""A folder with a store, results and things of the user's, and the commands that work on it."""
import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "end_to_end"))
from plumb_test import PLUMB, Said, files_of, plumb  # noqa: E402

LIMIT = 30  # [s] of one command; more is a hang

# What a user may keep beside results; some of it has names that staging of a dead run could have.
USERS_OWN = {"thesis.txt": b"mine\n", "out.old-2024/notes.txt": b"a backup\n", "out.partial-31/notes.txt": b"not done\n", "output/a.tum": b"0 1 2\n"}


def lay_out_users_own(world):
    for name, text in USERS_OWN.items():
        (world / name).parent.mkdir(parents=True, exist_ok=True)
        (world / name).write_bytes(text)


def make_input(folder):
    """A sequence of six frames; its files stay as they are, for keys count their times."""
    plumb("simulate", "out_and_back", "--frames", 6, "--length", "12m", "--lines", 4, "--columns", 64, "--drift", 1, "-o", folder / "sequence")
    (folder / "small.yaml").write_bytes((HERE / "small.yaml").read_bytes())
    preset = "plumb: 1\nname: coarse\nabout: a map of fewer points\nextends: small.yaml\nset:\n  voxel_size: 1 m\n"
    (folder / "coarse.yaml").write_text(preset)


def started(command, **more):
    """A command in a process group of its own, so that a signal to the group ends all of it."""
    variables = {k: v for k, v in os.environ.items() if not k.startswith(("PLUMB", "FAULTS"))} | more.pop("environment", {})
    words = [str(word) for word in (*more.pop("program", [PLUMB]), *command)]
    return subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=variables,
                            start_new_session=True, **more)


def said_by(process):
    """What a started command said; exit code None when it hangs."""
    try:
        out, err = process.communicate(timeout=LIMIT)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        out, err = process.communicate()
        process.returncode = None
    return Said(process.args, subprocess.CompletedProcess(process.args, process.returncode, out, err))


def run(command, program=(PLUMB,), **environment):
    return said_by(started(command, program=program, environment=environment))


def renewed(place, template):
    shutil.rmtree(place, ignore_errors=True)
    shutil.copytree(template, place, symlinks=True)


def results_in(output):
    """The files of every folder below that has any: by folder, by name."""
    found = {}
    for folder, _, names in os.walk(output):
        if names:
            found[os.path.relpath(folder, output)] = {name: (Path(folder) / name).read_bytes() for name in names}
    return found


def blobs_in(store):
    return {p.name: p.stat().st_ino for p in (store / "blobs").glob("*/*")}


def unfinished_in(store):
    """What stands in a store that neither is a result nor belongs to it."""
    known = {"plumb-store", "blobs", "new", "runs", "index.sqlite", "index.sqlite-wal", "index.sqlite-shm", "index.lock", "index.sum"}
    strange = [p.name for p in store.iterdir() if p.name not in known] if store.is_dir() else []
    return strange + [f"{folder}/{p.name}" for folder in ("new", "runs") for p in (store / folder).glob("*")]


def beside(world, expected):
    """What stands in the world that is neither results (`expected`: their folders below out), nor store, nor the user's."""
    known = {"store"} | {name.split("/")[0] for name in USERS_OWN}
    folders = {Path("out") / folder for folder in expected}
    folders |= {above for folder in folders for above in folder.parents}
    strange = [p.name for p in world.iterdir() if p.name not in known and p.name != "out"]
    return strange + [str(p.relative_to(world)) for p in (world / "out").rglob("*") if p.is_dir() and p.relative_to(world) not in folders]


def users_loss(world):
    """The first thing of the user's that is not as it was; none when all is."""
    for name, text in USERS_OWN.items():
        if not (world / name).is_file() or (world / name).read_bytes() != text:
            return name
    return None
