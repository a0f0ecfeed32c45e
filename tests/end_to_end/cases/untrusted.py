"""A stranger's pipeline: `--untrusted` reads only what the command line names, whatever the files ask for. strace, where it is there, shows what was opened."""
import os
import re
import shutil
import subprocess
from pathlib import Path

from plumb_test import PIPELINES, PLUMB, STEP_FAILED, WRONG_COMMAND_LINE, WRONG_INPUT, copy_of, files_of, nothing_left, plumb, sequence

SECRET = "the-word-that-nobody-may-see"

READS = """plumb: 1
name: read
parameters:
  input: {{type: path, about: a sequence, default: {input}}}
steps:
  sequence: {{use: source.sequence, with: {{path: $input{more}}}}}
  kept:     {{use: filter.distance, from: sequence.frames}}
  map:      {{use: write.map, from: {{frames: kept, trajectory: sequence.trajectory}}, with: {{{map}}}}}
  path:     {{use: write.trajectory, from: sequence.trajectory, with: {{{path}}}}}
"""


def reads(**parts):
    return READS.format(**({"input": "none", "more": "", "map": "", "path": ""} | parts))


class Place:
    """What a hostile pipeline finds: a good sequence, the folder it lies in, and a neighbour's secrets."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.input = copy_of("street", folder, frames=6)
        self.stranger = self.folder / "downloaded"
        self.stranger.mkdir()
        self.secrets = self.folder / "secrets"
        shutil.copytree(self.input, self.secrets)
        (self.secrets / "password").write_text(SECRET + "\n")
        (self.secrets / "other.yaml").write_text(f"# {SECRET}\n" + reads(input=self.secrets))
        self.out = self.folder / "results" / "out"
        self.out.parent.mkdir()
        self.before = files_of(self.secrets)

    def file(self, text, name="pipeline.yaml"):
        (self.stranger / name).write_text(text)
        return self.stranger / name

    def run(self, pipeline, *options, code=WRONG_INPUT, given=True, secrets="/secrets|/etc/(passwd|shadow)|/proc/self/environ|/dev/zero"):
        """Runs it under strace where that is there; nothing of the `secrets` (a pattern) may be opened, said or changed."""
        arguments = ["run", pipeline, "--untrusted", *(["--set", f"input={self.input}"] if given else []), *options, "-o", self.out, "--quiet"]
        trace = self.folder / "trace"
        tracer = ["strace", "-f", "-qq", "-e", "trace=open,openat,creat,rename,renameat,renameat2,unlink,unlinkat,mkdir,mkdirat,symlink,link", "-o", trace]
        if shutil.which("strace"):
            command = [*tracer, PLUMB, *arguments]
            said = plumb(*command[1:], program=command[0], code=code)
            text = trace.read_text()
            touched = [line for line in text.splitlines() if re.search(f'"[^"]*({secrets})', line)]
            assert not touched, f"opened: {touched}\n{said}"
            changed = [line for line in text.splitlines() if re.search(r"O_WRONLY|O_RDWR|O_CREAT|rename|unlink|mkdir|link", line) and re.search(r'"/', line)]
            outside = [line for line in changed if str(self.folder / "results") not in line and not re.search(r'"/(dev|proc|sys|var/tmp|tmp/?")', line)]
            assert not outside, f"written outside: {outside}\n{said}"
        else:
            said = plumb(*arguments, code=code)
        assert SECRET not in said.out + said.err, said
        assert files_of(self.secrets) == self.before
        if code:
            nothing_left(self.out)
            assert len(said.err.strip()) > 30 and not re.search(r"std::|terminate|what\(\)", said.err), said
            assert os.listdir(self.out.parent) == [], os.listdir(self.out.parent)
        return said


def test_a_good_pipeline_runs_as_without(folder):
    place = Place(folder)
    pipeline = place.file(reads())
    place.run(pipeline, code=0)
    plumb("run", pipeline, "--set", f"input={place.input}", "-o", place.folder / "trusted", "--quiet")
    same = lambda files: {name: data for name, data in files.items() if name != "run.lock.yaml"}
    assert same(files_of(place.out)) == same(files_of(place.folder / "trusted"))
    plumb("check", pipeline, "--untrusted", "--set", f"input={place.input}")


def test_the_shipped_cascade_and_presets_run(folder):
    place = Place(folder)
    place.run(PIPELINES / "tang2024.yaml", "--preset", PIPELINES / "presets/car_64line.yaml", "--set", "ranges.length=4m", code=0,
              secrets="/secrets")  # a library that the solver loads asks for the user's name


def test_paths_of_its_own(folder):
    place = Place(folder)
    inside = f", trajectory: {place.input}/odometry.tum"
    for own in (place.secrets, "/etc", "../secrets", f"{place.input}/../secrets", place.stranger):
        place.run(place.file(reads(input=own)), given=False).has("lies outside of what the command line gives", "--set input=DIR")
    for more in (f", trajectory: {place.secrets}/odometry.tum", ", trajectory: /etc/passwd", ", trajectory: /proc/self/environ", ", trajectory: /dev/zero"):
        place.run(place.file(reads(more=more))).has("lies outside of what the command line gives")
    place.run(place.file(reads(more=inside)), code=0)
    shutil.rmtree(place.out)


def test_links(folder):
    place = Place(folder)
    (place.stranger / "data").symlink_to(place.secrets)
    place.run(place.file(reads(input="data")), given=False).has("lies outside")
    (place.stranger / "round").symlink_to("round")
    place.run(place.file("plumb: 1\nextends: round\n")).has("round")
    (place.stranger / "base.yaml").symlink_to(place.secrets / "other.yaml")
    place.run(place.file("plumb: 1\nextends: base.yaml\n")).has("lies outside")
    odometry = place.input / "odometry.tum"
    odometry.unlink()
    odometry.symlink_to(place.secrets / "password")
    place.run(place.file(reads()), code=STEP_FAILED).has("odometry.tum: lies outside")
    odometry.unlink()
    shutil.copy(place.secrets / "odometry.tum", odometry)
    shutil.rmtree(place.input / "frames")
    (place.input / "frames").symlink_to(place.secrets / "frames")
    place.run(place.file(reads()), code=STEP_FAILED).has("frames: lies outside")


def test_a_list_of_frames_that_leads_elsewhere(folder):
    place = Place(folder)
    shutil.rmtree(place.input / "frames")
    for name in ("../secrets/frames/000000.pcd", f"{place.secrets}/frames/000000.pcd", "/etc/passwd"):
        (place.input / "frames.txt").write_text(f"{name}\n" * 6)
        place.run(place.file(reads()), code=STEP_FAILED).has("lies outside")


def test_what_it_extends(folder):
    place = Place(folder)
    for base in ("/etc/passwd", "../secrets/other.yaml", "../secrets/password", "/proc/self/environ", "/dev/zero", f"{PIPELINES}/tang2024.yaml"):
        place.run(place.file(f"plumb: 1\nextends: {base}\n")).has("lies outside of the folders of the pipeline and presets")
    place.file(reads(), "base.yaml")
    place.run(place.file("plumb: 1\nextends: base.yaml\n"), code=0)
    shutil.rmtree(place.out)
    preset = place.file("plumb: 1\nextends: ../secrets/other.yaml\n", "preset.yaml")
    place.run(place.file(reads()), "--preset", preset).has("lies outside")


def test_names_that_lead_out_of_the_output(folder):
    place = Place(folder)
    for name in ("../escaped.ply", "/tmp/escaped.ply", "a/../../escaped.ply", "run.lock.yaml", ""):
        place.run(place.file(reads(map=f"name: '{name}'")))
    assert not (place.folder / "results/escaped.ply").exists()


def test_bombs(folder):
    place = Place(folder)
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"] + [f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 9)}]" for k in range(1, 10)]
    place.run(place.file("plumb: 1\n" + "\n".join(lines) + "\n" + reads()[9:]))
    place.run(place.file("plumb: 1\nsteps: " + "[" * 20000 + "\n"))
    place.run(place.file(reads(map="voxel_size: 1e-300")))


def test_modules(folder):
    place = Place(folder)
    pipeline = place.file(reads())
    said = plumb("--plugin-path", place.stranger, "run", pipeline, "--untrusted", "--set", f"input={place.input}", "-o", place.out, code=WRONG_COMMAND_LINE)
    said.has("no modules but those that Plumb came with")
    (place.stranger / "libevil.so").write_bytes(b"\x7fELF not one")
    (place.stranger / "libevil.json").write_text("{}")
    os.environ["PLUMB_PLUGIN_PATH"] = str(place.stranger)
    try:
        said = plumb("run", place.file(reads().replace("filter.distance", "evil.step")), "--untrusted", "--set", f"input={place.input}", "-o", place.out, code=WRONG_INPUT,
                     environment={"PLUMB_PLUGIN_PATH": str(place.stranger)})
    finally:
        del os.environ["PLUMB_PLUGIN_PATH"]
    said.has("evil.step")
    nothing_left(place.out)


def test_bounds(folder):
    place = Place(folder)
    pipeline = place.file(reads())
    given = ["--set", f"input={place.input}", "-o", place.out]
    plumb("run", pipeline, "--untrusted", "--max-memory", "1MiB", *given, code=WRONG_COMMAND_LINE).has("too little")
    plumb("run", pipeline, "--untrusted", "--max-time", "0s", *given, code=WRONG_COMMAND_LINE).has("above zero")
    plumb("run", pipeline, "--max-time", "10s", *given, code=WRONG_COMMAND_LINE).has("--untrusted")
    plumb("run", pipeline, "--untrusted", "--executor", "process", *given, code=WRONG_COMMAND_LINE)
    slow = ["run", PIPELINES / "tang2024.yaml", "--untrusted", "--max-time", "1s", "--set", f"input={sequence('street')}", "--threads", "1", "--quiet"]
    plumb(*slow, "-o", place.out, code=STEP_FAILED).has("ended after --max-time 1s")
    nothing_left(place.out)


def test_memory_that_it_asks_for_fails_its_step(folder):
    place = Place(folder)
    points = 40_000_000
    header = f"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {points}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {points}\nDATA binary\n"
    first = sorted((place.input / "frames").iterdir())[0]
    with open(first, "wb") as file:  # 480 MB on paper, nothing on the disk
        file.write(header.encode())
        file.truncate(len(header) + 12 * points)
    said = place.run(place.file(reads()), "--max-memory", "300MiB", code=STEP_FAILED)
    assert "memory" in said.err, said
