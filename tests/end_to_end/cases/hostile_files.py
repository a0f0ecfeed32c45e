"""Files that are made to take time and memory, are no files at all, steer the terminal, or are named to have them printed."""
import bz2
import gzip
import json
import os
import re
import resource
import subprocess

from plumb_test import CASCADE, PLUMB, STEP_FAILED, WRONG_INPUT, Said, cascade, copy_of, nothing_left, plumb, refused, sequence

FAST = ["--set", "ranges.frames=2"]
SLURM = ["--executor", "slurm", "--executor-profile"]
TIME, MEMORY = 60, 2 << 30  # far more than is needed under any load, far less than what each of these once took


def bounded(*arguments, code):
    """Runs the command with a bound of its address space; what waits for ever or takes all memory fails the case."""
    command = [str(a) for a in (PLUMB, *arguments)]
    variables = {k: v for k, v in os.environ.items() if not k.startswith("PLUMB") or k == "PLUMB_CACHE_DIR"}
    done = subprocess.run(command, capture_output=True, env=variables, stdin=subprocess.DEVNULL, timeout=TIME,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)))
    done.stdout, done.stderr = done.stdout.decode(), done.stderr.decode()  # what is said is UTF-8 whatever it is about
    said = Said(command, done)
    assert said.code == code, f"exit {code} was expected of\n{str(said)[:3000]}"
    for c in said.out + said.err:
        plain = c in "\n\t" or (ord(c) >= 0x20 and not 0x7F <= ord(c) <= 0x9F and not 0x202A <= ord(c) <= 0x202E)
        assert plain, f"{c!r} reaches the terminal:\n{str(said)[:3000]}"
    return said


def checked(folder, text, *words):
    """The pipeline `text` is refused with `words` and not much more."""
    (folder / "a.yaml").write_text(text)
    said = bounded("check", folder / "a.yaml", code=WRONG_INPUT).has(*words)
    assert len(said.err) < 60000, f"{len(said.err)} bytes are said"
    return said


def lines(n, line):
    return "".join(line.format(k) for k in range(n))


# What takes time and memory.

def test_aliases_of_one_long_text(folder):
    text = "plumb: 1\nabout: &a " + "x" * 800000 + "\nsteps: [" + "*a, " * 12000 + "]\n"
    checked(folder, text, "more than 1 MiB of text once aliases are expanded")


def test_aliases_of_long_keys_and_anchors_in_anchors(folder):
    checked(folder, "plumb: 1\nabout: &a {" + lines(300, "x" * 900 + "{}: 1, ") + "}\nsteps: [" + "*a, " * 50 + "]\n", "more than 1 MiB of text")
    checked(folder, "plumb: 1\nsteps: " + lines(60, "&a{} [") + "x, " * 15000 + "]" * 60 + "\n", "more than 20000 values")


def test_thousands_of_mistakes_are_told_in_part(folder):
    more = re.compile(r"\nand \d+ more")
    for text in ["steps:\n" + lines(4600, "  step{0}: {{use: foo.bar{0}, from: no{0}}}\n"), "steps: [" + "!t x, " * 18000 + "]\n",
                 "steps: 1\n" * 18000, "steps: {}\n" + lines(18000, "k{}: 1\n")]:
        said = checked(folder, "plumb: 1\n" + text)
        assert more.search(said.err), said
        assert said.err.count(f"{folder}/a.yaml:") < 100, said


def test_brackets_without_end(folder):
    for bracket in "[{":
        checked(folder, "plumb: " + bracket * 900000, "nested more than 64 deep")


def test_a_packed_log_that_is_a_bomb(folder):
    for name, pack in [("bzip2", bz2.compress), ("gzip", gzip.compress)]:
        (folder / "log.clf").write_bytes(pack(b"FLASER 1 1 0 0 0 0 0 0 0 h 0\n" * 4000000))
        pipeline = folder / "log.yaml"
        pipeline.write_text("plumb: 1\nsteps:\n  log: {use: source.carmen, with: {path: log.clf}}\n"
                            "  poses: {use: write.trajectory, from: {trajectory: log.trajectory}}\n")
        refused(bounded("run", pipeline, "-o", folder / "out", "--quiet", code=STEP_FAILED), "unpacks to more than", f"unpack it with {name} -d")
        nothing_left(folder / "out")


def test_a_point_cloud_whose_header_promises_more_than_it_holds(folder):
    names = "FIELDS x y z" + lines(1000, " a{}") + "\nSIZE 4 4 4" + " 8" * 1000 + "\nTYPE F F F" + " F" * 1000 + "\nCOUNT 1 1 1" + " 65536" * 1000
    street = copy_of("street", folder, frames=6)
    frame = sorted((street / "frames").iterdir())[2]
    for points, data in [(1, "ascii"), (10 ** 18, "binary"), (5, "binary_compressed")]:
        frame.write_text(f"{names}\nWIDTH {points}\nHEIGHT 1\nDATA {data}\n")
        refused(bounded("run", CASCADE, "--set", f"input={street}", *FAST, "-o", folder / "out", "--quiet", code=STEP_FAILED), frame.name)


def test_files_of_flags_are_of_bounded_size(folder):
    with open(folder / "huge", "wb") as file:
        file.truncate(1 << 40)
    street = sequence("street")
    good = ["run", CASCADE, "--set", f"input={street}", "-o", folder / "out"]
    refused(bounded("run", "--locked", folder / "huge", "-o", folder / "out", code=WRONG_INPUT), "no record of a run is larger than")
    refused(bounded(*good, "--cache-dir", folder / "store", *SLURM, folder / "huge", code=WRONG_INPUT), "no executor profile is larger than")
    for command in (["check", folder / "huge"], [*good, "--preset", folder / "huge"]):
        bounded(*command, code=WRONG_INPUT).has("no pipeline is larger than 1 MiB")
    refused(bounded("simulate", folder / "huge", "-o", folder / "sim", code=WRONG_INPUT), "no scene is larger than")
    refused(bounded("evaluate", street, folder / "huge", code=WRONG_INPUT), "more than this machine's memory holds")
    nothing_left(folder / "out")


# What is no file.

def test_devices_in_place_of_files_of_flags(folder):
    street = sequence("street")
    good = ["run", CASCADE, "--set", f"input={street}", "-o", folder / "out"]
    device = "/dev/zero"
    refused(bounded("run", "--locked", device, "-o", folder / "out", code=WRONG_INPUT), "/dev/zero: is a device, not a regular file")
    refused(bounded(*good, "--cache-dir", folder / "store", *SLURM, device, code=WRONG_INPUT), "is a device, not a regular file")
    for command in (["check", device], [*good, "--preset", device]):
        bounded(*command, code=WRONG_INPUT).has("'/dev/zero' is a device, not a pipeline")
    refused(bounded("evaluate", street, device, code=WRONG_INPUT), "is a device, not a regular file")
    nothing_left(folder / "out")


def test_pipes_in_place_of_files_of_flags(folder):
    pipe = folder / "pipe"
    os.mkfifo(pipe)
    street = sequence("street")
    good = ["run", CASCADE, "--set", f"input={street}", "-o", folder / "out"]
    refused(bounded("run", "--locked", pipe, "-o", folder / "out", code=WRONG_INPUT), "pipe: is a pipe, not a regular file")
    refused(bounded(*good, "--cache-dir", folder / "store", *SLURM, pipe, code=WRONG_INPUT), "is a pipe, not a regular file")
    for command in (["check", pipe], ["resolve", pipe], [*good, "--preset", pipe]):
        bounded(*command, code=WRONG_INPUT).has("pipe' is a pipe, not a pipeline")
    refused(bounded("evaluate", street, pipe, code=WRONG_INPUT), "is a pipe, not a regular file")
    refused(bounded("simulate", pipe, "-o", folder / "sim", code=WRONG_INPUT), "is neither a scene file nor a shipped scene")
    nothing_left(folder / "out")


def test_pipes_in_a_sequence(folder):
    for name in ["odometry.tum", "frames.txt", "frame"]:
        street = copy_of("street", folder / f"with {name}", frames=6)
        file = sorted((street / "frames").iterdir())[3] if name == "frame" else street / name
        file.unlink(missing_ok=True)
        os.mkfifo(file)
        for options in ([], ["--verify-inputs"]):
            command = ["run", CASCADE, "--set", f"input={street}", *FAST, *options, "-o", folder / "out", "--quiet"]
            refused(bounded(*command, code=STEP_FAILED), file.name, "not a regular file")
            nothing_left(folder / "out")


def test_a_pipe_as_graph_log_plan_or_truth(folder):
    pipe = folder / "pipe"
    os.mkfifo(pipe)
    for use, rest in [("source.g2o", "poses: {use: write.graph, from: {poses: read.poses, constraints: read.constraints}}"),
                      ("source.carmen", "poses: {use: write.trajectory, from: {trajectory: read.trajectory}}"),
                      ("source.trajectory", "poses: {use: write.trajectory, from: {trajectory: read.trajectory}}")]:
        pipeline = folder / "a.yaml"
        pipeline.write_text(f"plumb: 1\nsteps:\n  read: {{use: {use}, with: {{path: pipe}}}}\n  {rest}\n")
        refused(bounded("run", pipeline, "-o", folder / "out", "--quiet", code=STEP_FAILED), "pipe: is a pipe, not a regular file")
        nothing_left(folder / "out")


def test_a_pipe_as_the_record_in_a_folder_for_results(folder):
    (folder / "out").mkdir()
    os.mkfifo(folder / "out/run.lock.yaml")
    refused(bounded("run", CASCADE, "--set", f"input={sequence('street')}", "-o", folder / "out", code=WRONG_INPUT), "holds 'run.lock.yaml'")
    (folder / "sim").mkdir()
    os.mkfifo(folder / "sim/scene.yaml")
    refused(bounded("simulate", "city_loop", "-o", folder / "sim", code=WRONG_INPUT), "that the simulator did not make")


def test_a_pipeline_from_standard_input(folder):
    (folder / "a.yaml").write_text("plumb: 1\nsteps: {}\n")
    with open(folder / "a.yaml") as file:
        done = subprocess.run([str(PLUMB), "check", "/dev/stdin"], stdin=file, capture_output=True, text=True)
    assert done.returncode == WRONG_INPUT and "/dev/stdin:2:8: the pipeline has no steps" in done.stderr, done.stderr


# What is said.

STEERING = "\x1b[2J\x1b]0;title\x07\u202e\u009b31m\u2066\x7f"
SHOWN = "\\x1b[2J\\x1b]0;title\\x07\\u202e\\u009b31m\\u2066\\x7f"


def test_names_that_would_steer_the_terminal(folder):
    for what in ("check", "resolve", "graph"):
        bounded(what, folder / f"{STEERING}.yaml", code=WRONG_INPUT).has(f"{SHOWN}.yaml'")
    bounded("run", CASCADE, "--set", f"input={folder}/{STEERING}", "-o", folder / "out", code=WRONG_INPUT).has(SHOWN)
    bounded("check", CASCADE, "--set", f"{STEERING}=1", code=WRONG_INPUT).has(f"has no parameter '{SHOWN}'")
    bounded("run", "--locked", folder / STEERING, "-o", folder / "out", code=WRONG_INPUT).has(SHOWN)
    bounded("inspect", STEERING, code=WRONG_INPUT).has(SHOWN)
    bounded("check", CASCADE, f"--{STEERING}", code=2).has(SHOWN)


def test_keys_values_and_lines_of_a_pipeline_that_would_steer_the_terminal(folder):
    in_yaml = json.dumps(STEERING)
    checked(folder, f"plumb: 1\nsteps: {{}}\n{in_yaml}: 1\n", f"unknown key '{SHOWN}'")
    checked(folder, f"plumb: {in_yaml}\nsteps: {{a: {{use: {in_yaml}}}}}\n", SHOWN, "no module offers")
    checked(folder, "plumb: 1\nsteps: {}\n# \x1b[31m\nx: \u202e\n", "  4 | x: \\u202e")
    checked(folder, 'plumb: 1\nsteps: {"a\\nplumb: all is well": {use: x}}\n', "'a\\x0aplumb: all is well' is no name")
    (folder / "a.yaml").write_bytes(b"plumb: 1\nsteps: {\xff\xe4: {use: x}}\n")
    bounded("check", folder / "a.yaml", code=WRONG_INPUT).has("'\\xff\\xe4' is no name")


def test_data_that_would_steer_the_terminal(folder):
    street = copy_of("street", folder, frames=6)
    (street / "odometry.tum").write_text(f"1 2 3 \x1b[2J\x9b 5 6 7 8\n")
    bounded("run", CASCADE, "--set", f"input={street}", *FAST, "-o", folder / "out", code=STEP_FAILED).has("odometry.tum:1: '?[2J")
    named = folder / STEERING
    copy_of("street", folder / "other", frames=6).rename(named)
    (sorted((named / "frames").iterdir())[2]).write_text("no point cloud")
    bounded("run", CASCADE, "--set", f"input={named}", *FAST, "--log", folder / "log", "-o", folder / "out", code=STEP_FAILED).has(SHOWN)
    assert "\x1b" not in (folder / "log").read_text()


def test_what_is_resolved_is_read_back(folder):
    text = "a \x1b[31m \u202e \"b\" \\ \u0085 ä"
    in_yaml = json.dumps(text)
    (folder / "a.yaml").write_text(f"plumb: 1\nname: {in_yaml}\nsteps:\n  read: {{use: source.trajectory, with: {{path: {in_yaml}}}}}\n"
                                   "  kept: {use: write.trajectory, from: {trajectory: read.trajectory}}\n")
    first = bounded("resolve", folder / "a.yaml", code=0)
    assert "\\x1b[31m \\u202e" in first.out and "ä" in first.out, first
    (folder / "b.yaml").write_text(first.out)
    second = bounded("resolve", folder / "b.yaml", code=0)
    without_places = lambda said: [line.split("  # ")[0].rstrip() for line in said.out.splitlines()]
    assert without_places(first) == without_places(second), f"{first}\n{second}"


def test_files_that_are_no_pipelines_are_not_printed(folder):
    for name, text in {"passwd": "root:x:0:0:secret:/root:/bin/bash\n", "word": "secret\n", "list": "- secret\n",
                       "hosts.yml": "hosts:\n  steps: secret\n", "key": "-----BEGIN\nsecret: [\n", "toml": "x = \"secret\"\n\ty {\n"}.items():
        (folder / name).write_text(text)
        (folder / "p.yaml").write_text("plumb: 1\nsteps: {}\n")
        said = checked(folder, f"plumb: 1\nextends: {name}\n", f"{name}' is no pipeline")
        assert "secret" not in said.err + said.out, said
        for options in (["check", folder / name], ["check", folder / "p.yaml", "--preset", folder / name]):
            said = bounded(*options, code=WRONG_INPUT).has("is no pipeline")
            assert "secret" not in said.err + said.out, said
        command = ["run", CASCADE, "--set", f"input={sequence('street')}", "-o", folder / "out", "--cache-dir", folder / "store", *SLURM, folder / name]
        said = bounded(*command, code=WRONG_INPUT).has("an executor profile has no key" if name == "hosts.yml" else "is no executor profile")
        assert "secret" not in said.err + said.out, said
    checked(folder, "plumb: 1\nextends: /etc/passwd\n", "'/etc/passwd' is no pipeline")
