"""A Slurm of one node on the loopback, for tests: no accounting, no cgroups, ports of its own. Facts from the manual pages of slurm.conf and munged."""
import os
import shutil
import socket
import subprocess
import time
from pathlib import Path

from plumb_test import skip


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def running(pid_file):
    try:
        pid = int(Path(pid_file).read_text())
        os.kill(pid, 0)
        return pid
    except (OSError, ValueError):
        return None


def wait_until(what, seconds=30, why=""):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = what()
        if found:
            return found
        time.sleep(0.05)
    raise AssertionError(f"{why or what} did not come within {seconds} s")


class OneNodeSlurm:
    """`with OneNodeSlurm(folder) as slurm:` starts munged if there is none, slurmctld and slurmd; what it started it ends, by its id."""

    def __init__(self, folder):
        for program in ("slurmctld", "slurmd", "sbatch", "squeue", "munged"):
            if not (shutil.which(program) or Path("/usr/sbin", program).exists()):
                skip(f"{program} is not on this machine (packages slurm-wlm and munge)")
        if os.geteuid() != 0:
            skip("starting slurmd needs root")
        self.folder = Path(folder)
        self.environment = os.environ | {"SLURM_CONF": str(self.folder / "slurm.conf"), "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"}
        self.munged = None

    def __enter__(self):
        for inner in ("state", "spool", "log"):
            (self.folder / inner).mkdir(parents=True)
        self.start_munge()
        (self.folder / "slurm.conf").write_text("\n".join([
            "ClusterName=plumbtest", "SlurmctldHost=localhost(127.0.0.1)", "SlurmUser=root", "AuthType=auth/munge",
            f"SlurmctldPort={free_port()}", f"SlurmdPort={free_port()}", f"StateSaveLocation={self.folder}/state", f"SlurmdSpoolDir={self.folder}/spool",
            f"SlurmctldPidFile={self.folder}/ctld.pid", f"SlurmdPidFile={self.folder}/d.pid", f"SlurmctldLogFile={self.folder}/log/ctld.log",
            f"SlurmdLogFile={self.folder}/log/d.log", "ProctrackType=proctrack/linuxproc", "TaskPlugin=task/none", "SwitchType=switch/none",
            "MpiDefault=none", "SelectType=select/cons_tres", "SelectTypeParameters=CR_Core", "SchedulerType=sched/backfill",
            "SchedulerParameters=batch_sched_delay=1,sched_interval=5,sched_min_interval=10000,bf_interval=5,defer", "JobAcctGatherType=jobacct_gather/none",
            "AccountingStorageType=accounting_storage/none", "ReturnToService=2", "SlurmdTimeout=20", "KillWait=3", "MinJobAge=300",
            f"NodeName=localhost NodeAddr=127.0.0.1 CPUs={os.cpu_count()} State=UNKNOWN",
            "PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP", ""]))
        self.run("slurmctld")
        self.start_node()
        wait_until(lambda: "idle" in self.run("sinfo", "-h", "-o", "%t", check=False).stdout, why="an idle node")
        return self

    def __exit__(self, *_):
        for name in ("d", "ctld"):
            if pid := running(self.folder / f"{name}.pid"):
                os.kill(pid, 15)
                wait_until(lambda: not running(self.folder / f"{name}.pid"), why=f"the end of slurm{name}")
        if self.munged:
            self.munged.terminate()
            self.munged.wait()

    def run(self, *words, check=True):
        done = subprocess.run(words, env=self.environment, capture_output=True, text=True)
        assert not check or done.returncode == 0, f"$ {' '.join(words)}\n{done.stdout}{done.stderr}"
        return done

    def start_munge(self):
        if subprocess.run(["munge", "-n"], capture_output=True).returncode == 0:
            return
        key, place = Path("/etc/munge/munge.key"), Path("/run/munge")
        if not key.exists():
            key.write_bytes(os.urandom(128))
            key.chmod(0o400)
            shutil.chown(key, "munge", "munge")
        place.mkdir(exist_ok=True)
        shutil.chown(place, "munge", "munge")
        self.munged = subprocess.Popen(["setpriv", "--reuid=munge", "--regid=munge", "--init-groups", "munged", "--foreground"], env=self.environment,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        wait_until(lambda: subprocess.run(["munge", "-n"], capture_output=True).returncode == 0, why="munged")

    def start_node(self):
        self.run("slurmd", "-N", "localhost")

    def kill_node(self):
        os.kill(running(self.folder / "d.pid"), 9)


def processes_with(*words):
    """Ids of processes whose command line holds all words."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                line = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
            except OSError:
                continue
            if all(str(word) in line for word in words):
                found.append(int(entry.name))
    return found
