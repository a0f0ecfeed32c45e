"""Ends commands at random moments by random signals, and checks that nothing is lost and nothing stays behind.

    kill_test.py [--seed S] N

N times one command of a kind (KINDS below) is ended by one signal at a moment between its begin and its usual end (signals that come too late do
not count). Then: results are as they were or new and whole; after a signal that can be caught nothing unfinished stands beside them; the other of
two runs ends as if it had been alone; workers end. And after the next run: its bytes are those of an undisturbed one, no result is made again
whose file was whole after the kill, nothing is left beside the results or in the store, and the store is good. The seed is printed; the same seed
gives the same commands, signals and moments (what a moment hits is up to the machine).
"""
import argparse
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import promise
from scenarios import Scenario, compare, compared, earlier, prune, small, the_same
from world import make_input, renewed, results_in, run, said_by, started

SIGNALS = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGPIPE, signal.SIGQUIT]
KINDS = {
    "run": [Scenario("run", small()), Scenario("run over an earlier one", small(), earlier)],
    "compare": [Scenario("compare", compare), Scenario("compare again", compare, compared)],
    "workers": [Scenario("workers", small("--executor", "process")), Scenario("workers over an earlier run", small("--executor", "process"), earlier)],
    "prune": [Scenario("prune", prune, the_same, again=small())],
    "two runs": [Scenario("two runs", small()), Scenario("two runs over an earlier one", small(), earlier)],
}


class Undisturbed:
    """A scenario's world before, its results after, and how long it takes."""

    def __init__(self, scenario, work):
        self.scenario, self.work = scenario, work
        self.template = work / (scenario.name + ".before")
        scenario.prepare(work, self.template)
        self.old = results_in(self.template / "out")
        world = work / "undisturbed"
        renewed(world, self.template)
        begin = time.monotonic()
        said = run(scenario.command(work, world))
        self.seconds = time.monotonic() - begin
        assert said.code == 0, said
        self.after = results_in(world / "out")
        assert run(scenario.again(work, world)).code == 0
        self.new = results_in(world / "out")


def whole_files(store):
    return {p: (p.stat().st_ino, p.stat().st_mtime_ns) for p in (store / "blobs").glob("*/*")}


def workers_of(world):
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_bytes().split(b"\0")
        except OSError:
            continue
        if b"worker" in words and str(world / "store").encode() in words:
            found.append(int(folder.name))
    return found


def workers_end(world):
    for _ in range(200):
        if not workers_of(world):
            return []
        time.sleep(0.05)
    return ["workers outlive their run by 10 s"]


def right_end(said, number):
    """The exit of a process that a signal ended, or that was faster."""
    if said.code not in (0, -number, 128 + number):
        return [f"exit {said.code}"]
    return ["it does not say that it was interrupted"] if said.code == 128 + number and "interrupted" not in said.err else []


def beside_it(kind, undisturbed, world):
    """The second of two runs on one store: with results of its own."""
    if kind != "two runs":
        return None
    command = undisturbed.scenario.command(undisturbed.work, world)
    at = command.index("-o") + 1
    return started([*command[:at], world / "output/other", *command[at + 1:]])


def ended(kind, undisturbed, world, number, moment):
    """What was broken when the command got the signal `number` at `moment`, and after the next run; and its exit."""
    other = beside_it(kind, undisturbed, world)
    process = started(undisturbed.scenario.command(undisturbed.work, world))
    time.sleep(moment)
    process.send_signal(number)
    said = said_by(process)
    wrong = right_end(said, number) + workers_end(world)
    if other:
        others = said_by(other)
        if others.code != 0 or results_in(world / "output/other").get(".") != undisturbed.new["."]:
            wrong.append(f"the other run suffers: exit {others.code}, {others.err.strip()}")
        shutil.rmtree(world / "output/other", ignore_errors=True)
    wrong += promise.results(results_in(world / "out"), undisturbed.old, undisturbed.after, said.code == 0)
    wrong += [w for w in promise.surroundings(world, undisturbed.old | undisturbed.new, number != signal.SIGKILL) if "in the store" not in w]
    before = whole_files(world / "store")
    wrong += promise.goes_on(undisturbed.scenario, undisturbed.work, world, undisturbed.new, False)
    after = whole_files(world / "store")
    again = [p.name for p, seen in before.items() if after.get(p) != seen]
    if again:
        wrong.append(f"{len(again)} results were made again though their files were whole")
    return wrong, said.code


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kills", type=int, metavar="N")
    parser.add_argument("--seed", type=int)
    options = parser.parse_args()
    seed = options.seed if options.seed is not None else random.SystemRandom().randrange(1 << 32)
    print(f"seed {seed}", flush=True)
    chance = random.Random(seed)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    work = Path(tempfile.mkdtemp(prefix="plumb_kills_")).resolve()
    make_input(work)
    undisturbed = {kind: [Undisturbed(scenario, work) for scenario in all_of] for kind, all_of in KINDS.items()}
    kills, attempts, broken = Counter(), 0, 0
    while sum(kills.values()) < options.kills and attempts < 5 * options.kills:
        kind, by = list(KINDS)[attempts % len(KINDS)], SIGNALS[attempts % len(SIGNALS)]  # 5 and 6: all pairs come by
        one, moment = chance.choice(undisturbed[kind]), chance.random()
        attempts += 1
        renewed(work / "world", one.template)
        wrong, code = ended(kind, one, work / "world", by, moment * one.seconds)
        if code != 0:
            kills[kind, by.name] += 1
        for sentence in wrong:
            broken += 1
            print(f"attempt {attempts}: {one.scenario.name}, {by.name} at {moment * one.seconds:.3f} s (exit {code}): {sentence}", flush=True)
    shutil.rmtree(work, ignore_errors=True)
    done = sum(kills.values())
    print(f"{done} kills, {len(kills)} pairs of command and signal; {attempts - done} more came when all was done; {broken} promises broken")
    return 1 if broken or done < options.kills else 0


if __name__ == "__main__":
    sys.exit(main())
