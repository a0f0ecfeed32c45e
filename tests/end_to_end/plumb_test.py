"""What all cases share: the command, sequences to run it on, and sentences it must say.

A case is a function `test_NAME(folder)` in cases/TOPIC.py; ctest runs `plumb_test.py TOPIC NAME`. `folder` is its own, empty, and gone
when the case passes. The ctest entry sets PLUMB (the command), PLUMB_BUILD, PLUMB_SOURCE and PLUMB_SEQUENCES (see sequences.py).
"""
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = Path(os.environ.get("PLUMB_SOURCE", HERE.parents[1]))
BUILD = Path(os.environ.get("PLUMB_BUILD", SOURCE / "build"))
PLUMB = Path(os.environ.get("PLUMB", BUILD / "bin/plumb"))
SEQUENCES = Path(os.environ.get("PLUMB_SEQUENCES", BUILD / "tests/end_to_end/sequences"))
SHARED = SOURCE.parent / "shared"
PIPELINES = SOURCE / "pipelines"
CASCADE = PIPELINES / "tang2024.yaml"
CAR = PIPELINES / "presets/car_64line.yaml"
PLANAR = PIPELINES / "zhang2023.yaml"
UNIMPROVED = PIPELINES / "presets/zhang2023_unimproved.yaml"

os.environ["PLUMB_CACHE_DIR"] = "none"  # nothing is kept beyond a case, and nothing is taken from the user's cache; a case that wants a cache names one

DONE, WRONG_INPUT, WRONG_COMMAND_LINE, STEP_FAILED, UNSETTLED, WORSE, NOTHING = range(7)  # as `plumb --help` says


class Said:
    """What a command left on the screen, and its exit code."""

    def __init__(self, command, done):
        self.command = " ".join(map(str, command))
        self.code, self.out, self.err = done.returncode, done.stdout, done.stderr

    def __str__(self):
        return f"$ {self.command}\nexit {self.code}\n{self.out}{self.err}"

    def has(self, *words):
        for word in words:
            assert word in self.out + self.err, f"'{word}' is not said by\n{self}"
        return self


def plumb(*arguments, code=DONE, program=None, environment=None, cwd=None):
    """Runs the command and asserts its exit code, which may be one of several."""
    command = [str(a) for a in (program or PLUMB, *arguments)]
    variables = {k: v for k, v in os.environ.items() if not k.startswith("PLUMB") or k == "PLUMB_CACHE_DIR"} | (environment or {})
    said = Said(command, subprocess.run(command, capture_output=True, text=True, env=variables, cwd=cwd, stdin=subprocess.DEVNULL))
    assert said.code in (code if isinstance(code, tuple) else (code,)), f"exit {code} was expected of\n{said}"
    return said


def cascade(sequence, output, *options, pipeline=CASCADE, code=DONE):
    """Runs the paper's cascade with segments that suit a small sequence; nothing but warnings and errors are printed."""
    return plumb("run", pipeline, "--set", f"input={sequence}", *options, "-o", output, "--quiet", code=code)


def refused(said, *words):
    """One sentence with all `words`, no crash, no more than that sentence."""
    said.has(*words)
    text = said.err.strip()
    assert text.startswith("plumb: ") and "\n" not in text, f"not one sentence of plumb's:\n{said}"
    assert len(text) > 30 and not re.search(r"(std::|terminate|basic_|what\(\))", text), f"no sentence:\n{said}"


def nothing_left(output):
    """Neither the output folder nor a half-written one stands beside where it would be."""
    output = Path(output)
    names = [entry.name for entry in output.parent.iterdir()] if output.parent.is_dir() else []
    left = [name for name in names if name.startswith((output.name, f".{output.name}.plumb-"))]
    assert not left, f"left behind: {left}"


def nothing_staged(folder):
    """No command left a folder that it was making, or its marker, in `folder`."""
    left = [entry.name for entry in Path(folder).glob(".*.plumb-*")]
    assert not left, f"left behind: {left}"


def sequence(name):
    """A simulated sequence that the set-up made."""
    folder = SEQUENCES / name
    assert (folder / "truth.tum").exists(), f"{folder} was not made; run the test end_to_end.sequences first"
    return folder


def real_sequence(name):
    folder = SHARED / "data" / name
    if not folder.is_dir():
        skip("real sequences are not on this machine (../shared/data)")
    return folder


def real_file(name):
    file = SHARED / "data" / name
    if not file.is_file():
        skip("real sequences are not on this machine (../shared/data)")
    return file


def skip(reason):
    print("skipped:", reason)
    sys.exit(77)


def score(sequence_folder, trajectory, *options):
    """`plumb evaluate --json`: {"before": {...}, "after": {...}}."""
    return json.loads(plumb("evaluate", sequence_folder, trajectory, "--json", *options).out)


def files_of(folder):
    """The bytes of every file below `folder`, by relative path."""
    folder = Path(folder)
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


# Copies poses and nothing else: runs at once.
POSES = """plumb: 1
name: poses
parameters:
  input: {type: path}
steps:
  sequence: {use: source.sequence,  with: {path: $input}}
  copy:     {use: write.trajectory, from: sequence.trajectory}
"""


def poses_pipeline(folder):
    (folder / "poses.yaml").write_text(POSES)
    return folder / "poses.yaml"


def shipped_pipelines():
    """Every pipeline and preset; not the experiments, which name some of them."""
    return sorted(file for file in PIPELINES.rglob("*.yaml") if file.parent.name != "experiments")


def step_names():
    return [line.split()[0] for line in plumb("list").out.splitlines()]


def left_out():
    """{step: why} of those that this build left out, since a library was not found."""
    file = BUILD / "lib/plumb/left_out.txt"
    return dict(line.split(": ", 1) for line in file.read_text().splitlines())


def steps_by_library():
    """{step: (library, package)} of the steps that are not built without an optional library, by what their CMakeLists.txt say."""
    found = {}
    for file in sorted((SOURCE / "plugins").glob("*/*/CMakeLists.txt")):
        text, step = file.read_text(), ".".join(file.parts[-3:-1])
        for word, library, package in (("plumb_add_pcl_step(", "PCL", "libpcl-dev"), ("TARGET plumb_shared_cgal", "CGAL 5.5", "libcgal-dev"),
                                       ("flann/", "FLANN", "libflann-dev")):
            if word in text and not step.startswith("shared."):
                found[step] = (library, package)
    assert {"keypoints.iss", "segment.planes", "match.features_flann"} < set(found), found
    return found


def installation(folder):
    """The command and its modules, copied into a folder where single modules can be changed. Returns (program, modules, environment)."""
    modules = folder / "lib/plumb"
    modules.mkdir(parents=True)
    modules.chmod(0o755)
    (folder / "bin").mkdir()
    shutil.copy(PLUMB, folder / "bin/plumb")
    for name in ("libplumb", "libplumb_slam"):
        shutil.copy(next((BUILD / "lib").glob(f"{name}.so.*.*")), folder / f"lib/{name}.so.0")
    for file in (BUILD / "lib/plumb").iterdir():
        shutil.copy(file, modules / file.name)
    return folder / "bin/plumb", modules, {"LD_LIBRARY_PATH": str(folder / "lib")}


def copy_of(name, folder, frames=None):
    """A copy of a simulated sequence that a case may spoil; with `frames`, of its first ones."""
    to = Path(folder) / "sequence"
    shutil.copytree(sequence(name), to)
    if frames is not None:
        for extra in sorted((to / "frames").iterdir())[frames:]:
            extra.unlink()
        for trajectory in ("odometry.tum", "truth.tum"):
            lines = (to / trajectory).read_text().splitlines()
            (to / trajectory).write_text("\n".join(lines[:frames]) + "\n")
    return to


def main():
    topic, name = sys.argv[1:3]
    specification = importlib.util.spec_from_file_location(topic, HERE / "cases" / f"{topic}.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    folder = Path(tempfile.mkdtemp(prefix=f"plumb_{topic}_"))
    getattr(module, "test_" + name)(folder)  # a failure leaves the folder to look at
    shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.modules["plumb_test"] = sys.modules["__main__"]
    try:
        main()
    except AssertionError as failure:
        import traceback
        traceback.print_exc(limit=-3)
        print(failure)
        sys.exit(1)
