"""Other processes and other machines: the same bytes, whatever is killed."""
import os
import re
import subprocess
import time

from one_node_slurm import OneNodeSlurm, free_port, processes_with, wait_until
from plumb_test import CASCADE, PLUMB, SOURCE, WRONG_COMMAND_LINE, WRONG_INPUT, files_of, plumb, refused, sequence

PROFILE = "partition: main\ncpus: 1\nchunk: 8\nsubmit_above: 0 s   # everything goes to the cluster\npoll: 0.3 s\n"


def words(folder, out, *options):
    return ["run", CASCADE, "--set", f"input={sequence('street')}", "--set", "ranges.frames=10", *options, "-o", folder / out]


def expected(folder):
    plumb(*words(folder, "expected", "--cache-dir", "none"))
    return files_of(folder / "expected")


def counted(said):
    return [line for line in said.out.splitlines() if line.startswith("counted: ")]


def blobs(store):
    return {p: p.stat().st_ino for p in (store / "blobs").rglob("*") if p.is_file()}


def test_workers_leave_the_same_bytes_and_counts(folder):
    bytes_ = expected(folder)
    plain = plumb(*words(folder, "plain", "--cache-dir", "none"))
    for threads in ("1", "2"):
        said = plumb(*words(folder, "out", "--cache-dir", folder / ("store" + threads), "--executor", "process", "--threads", threads))
        assert files_of(folder / "out") == bytes_
        assert counted(said) == counted(plain)
    first = blobs(folder / "store2")
    plumb(*words(folder, "out", "--cache-dir", folder / "store2"))
    assert files_of(folder / "out") == bytes_ and blobs(folder / "store2") == first
    assert not processes_with("worker", folder), "a worker outlived its run"


def test_workers_end_when_their_driver_is_killed(folder):
    command = [str(w) for w in (PLUMB, *words(folder, "out", "--cache-dir", folder / "store", "--executor", "process"))]
    driver = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_until(lambda: processes_with(" worker ", folder), why="a worker")
    driver.kill()
    driver.wait()
    wait_until(lambda: not processes_with(" worker ", folder), seconds=10, why="the end of the workers")
    plumb(*words(folder, "out", "--cache-dir", folder / "store", "--executor", "process"))
    assert files_of(folder / "out") == expected(folder)


def test_workers_that_are_killed_are_replaced(folder):
    command = [str(w) for w in (PLUMB, *words(folder, "out", "--cache-dir", folder / "store", "--executor", "process"))]
    driver = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    killed = 0
    while driver.poll() is None and killed < 3:
        for pid in processes_with(" worker ", folder / "store")[:1]:
            os.kill(pid, 9)
            killed += 1
        time.sleep(0.4)
    assert driver.wait() == 0 and killed > 0
    assert files_of(folder / "out") == expected(folder)


def slurm_run(folder, slurm, out, store):
    (folder / "profile.yaml").write_text(PROFILE)
    command = words(folder, out, "--cache-dir", folder / store, "--executor", "slurm", "--executor-profile", folder / "profile.yaml")
    return subprocess.Popen([str(w) for w in (PLUMB, *command)], env=slurm.environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def ends_well(run):
    _, said = run.communicate(timeout=900)
    assert run.returncode == 0, said


def test_slurm_leaves_the_same_bytes_when_processes_and_the_node_are_killed(folder):
    with OneNodeSlurm(folder / "slurm") as slurm:
        run = slurm_run(folder, slurm, "out", "store")
        for _ in range(3):
            chunk = wait_until(lambda: processes_with("--task", folder / "store"), why="a chunk's process")
            for pid in processes_with(" worker ", folder / "store"):
                if pid != run.pid:
                    try:
                        os.kill(pid, 9)
                    except ProcessLookupError:
                        pass
            wait_until(lambda: not set(chunk) & set(processes_with("--task", folder / "store")), why="the end of the chunk")
        slurm.kill_node()
        time.sleep(1)
        slurm.start_node()
        ends_well(run)
        assert files_of(folder / "out") == expected(folder)
        assert not list((folder / "store/jobs").iterdir())


def test_a_driver_of_slurm_that_is_killed_takes_up_where_it_was(folder):
    with OneNodeSlurm(folder / "slurm") as slurm:
        run = slurm_run(folder, slurm, "out", "store")
        for _ in range(2):
            wait_until(lambda: processes_with("--task", folder / "store"), why="a chunk's process")
            run.kill()
            run.wait()
            before = blobs(folder / "store")
            run = slurm_run(folder, slurm, "out", "store")
            time.sleep(1)
        ends_well(run)
        after = blobs(folder / "store")
        assert all(after[p] == inode for p, inode in before.items()), "a finished item was made again"
        assert files_of(folder / "out") == expected(folder)


def test_wrong_profiles_and_options_are_refused_with_their_place(folder):
    good = words(folder, "out", "--cache-dir", folder / "store")
    profile = folder / "profile.yaml"

    def told(text, *sentences, code=WRONG_INPUT):
        profile.write_text(text)
        plumb(*good, "--executor", "slurm", "--executor-profile", profile, code=code).has(*sentences)

    told("partiton: main\n", "profile.yaml:1:1:", "no key 'partiton'", "Did you mean 'partition'")
    told("chunk: 0\n", "profile.yaml:1:8:", "'chunk'", "1")
    told("poll: 3\n", "profile.yaml:1:7:", "no unit")
    told("memory: much\n", "profile.yaml:1:9:", "memory much", "4GiB")
    refused(plumb(*good, "--executor", "slurm", "--executor-profile", folder / "none.yaml", code=WRONG_INPUT), "none.yaml: cannot be opened (No such file or directory)")
    refused(plumb(*good, "--executor-profile", profile, code=WRONG_COMMAND_LINE), "--executor slurm, which is not given")
    refused(plumb(*good, "--item-memory", "1GiB", code=WRONG_COMMAND_LINE), "--executor", "process")
    refused(plumb(*good, "--executor", "process", "--item-memory", "10MiB", code=WRONG_COMMAND_LINE), "--item-memory 10MiB", "64MiB or more")
    refused(plumb(*good, "--executor", "process", "--memory", "256MiB", "--threads", "8", code=WRONG_COMMAND_LINE), "--memory for 8 workers", "32 MiB")
    refused(plumb(*words(folder, "out", "--cache-dir", "none", "--executor", "process"), code=WRONG_COMMAND_LINE), "a cache is needed")
    refused(plumb(*words(folder, "out", "--cache-dir", "none", "--memory", "2GiB"), code=WRONG_COMMAND_LINE), "a cache is needed")
    refused(plumb(*good, "--memory", "2 apples", code=WRONG_COMMAND_LINE), "--memory", "GiB")
    refused(plumb(*good, "--memory", "1MiB", code=WRONG_COMMAND_LINE), "too little")
    refused(plumb("worker", "--cache-dir", folder / "s2", code=WRONG_COMMAND_LINE), "not by hand")
    plumb(*good, "--executor", "condor", code=WRONG_COMMAND_LINE).has("condor")
    assert not (folder / "out").exists()


def test_the_page_has_every_key_of_the_profile_with_its_default(folder):
    profile = folder / "profile.yaml"
    profile.write_text("no_key: 1\n")
    command = words(folder, "out", "--cache-dir", folder / "store", "--executor", "slurm", "--executor-profile", profile)
    keys = re.search(r"Known: (.*)\.", plumb(*command, code=WRONG_INPUT).err)[1].split(", ")
    block = re.search(r"```yaml\n# profile.yaml.*?\n(.*?)```", (SOURCE / "README.md").read_text(), re.S)[1]
    assert len(keys) >= 8 and re.findall(r"^(\w+):", block, re.M) == keys, (keys, block)
    profile.write_text(block + "no_key: 1\n")
    said = plumb(*command, code=WRONG_INPUT)
    assert said.err.count("profile.yaml:") == 1, said  # what the page shows is taken


def test_a_slurm_that_does_not_answer_or_lacks_the_partition_is_refused_before_anything_runs(folder):
    (folder / "profile.yaml").write_text("partition: nightly\n")
    good = words(folder, "out", "--cache-dir", folder / "store", "--executor", "slurm", "--executor-profile", folder / "profile.yaml")
    (folder / "slurm.conf").write_text(f"ClusterName=none\nSlurmctldHost=localhost(127.0.0.1)\nSlurmctldPort={free_port()}\nNodeName=localhost\n"
                                       "MessageTimeout=1\nPartitionName=main Nodes=ALL\n")
    refused(plumb(*good, code=WRONG_INPUT, environment={"SLURM_CONF": str(folder / "slurm.conf")}), "--executor slurm", "without --executor")
    with OneNodeSlurm(folder / "slurm") as slurm:
        refused(plumb(*good, code=WRONG_INPUT, environment={"SLURM_CONF": slurm.environment["SLURM_CONF"]}),
                "no partition 'nightly'", "it has: main")
    assert not (folder / "out").exists()


def test_a_call_that_crashes_on_the_cluster_is_set_aside_after_two_tries(folder):
    from importlib import util
    spec = util.spec_from_file_location("faults", SOURCE / "tests/end_to_end/cases/faults.py")
    faults = util.module_from_spec(spec)
    spec.loader.exec_module(faults)
    with OneNodeSlurm(folder / "slurm") as slurm:
        (folder / "profile.yaml").write_text(PROFILE)
        variables = {"SLURM_CONF": slurm.environment["SLURM_CONF"]}
        options = ["--executor", "slurm", "--executor-profile", folder / "profile.yaml"]
        said = plumb("--plugin-path", faults.MODULES, "run", faults.pipeline(folder, "drop"), "--set", f"input={sequence('street')}", "--set",
                     "bad.deed=segfault", "--cache-dir", folder / "store", *options, "-o", folder / "out", environment=variables)
        said.has("edge 1-2: its process was ended by signal 11", "is dropped (on_error: drop)")
    faults.run(folder, "here", "segfault", "--executor", "process", on_error="drop", store="other", code=0)
    assert files_of(folder / "out")["trajectory.tum"] == files_of(folder / "here")["trajectory.tum"]
