"""Fails every file-system call of small runs, once in each way, and checks after each what is promised (promise.py).

    faults_test.py [--scenario NAME]... [--stride N] [--call N] [--way WAY]... [--jobs N] LAYER

LAYER is the library that watch.hpp describes. Each command is run once undisturbed to count its calls; then once for each call and each way in
which that call can fail, and a power cut is put before each call that follows a change (power.py). With --stride N, every N-th of these. Prints
what was found and the number of pairs of a call site (the chain of callers) and a failure; exit 1 when a promise was broken.
"""
import argparse
import shutil
import sys
import tempfile
from collections import Counter, defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import promise
import scenarios
from calls import LOSING, REMOVAL, read_log
from power import LOSSES, Disk
from world import blobs_in, make_input, renewed, results_in, run

CHANGES = {"open", "write", "ftruncate", "mkdir", "rename", "unlink", "rmdir", "remove", "link", "symlink", "fsync", "fdatasync", "syncfs"}


class Trial:
    """One scenario in a folder of its own: as it goes undisturbed, and disturbed."""

    def __init__(self, scenario, work, layer):
        self.scenario, self.work, self.layer = scenario, work, layer
        self.template = work / (scenario.name + ".before")
        scenario.prepare(work, self.template)
        self.old = results_in(self.template / "out")
        world = self.world("undisturbed")
        said, self.calls = self.disturbed(world)
        assert said.code == 0, said
        self.kept = len(blobs_in(world / "store"))
        said = run(scenario.again(work, world))
        assert said.code == 0, said
        self.new = results_in(world / "out")

    def world(self, name):
        world = self.work / f"{self.scenario.name}.{name}" / "world"
        world.parent.mkdir(exist_ok=True)
        renewed(world, self.template)
        return world

    def disturbed(self, world, **how):
        count, log = world.parent / "count", world.parent / "log"
        count.write_bytes(bytes(8))
        log.unlink(missing_ok=True)
        said = run(self.scenario.command(self.work, world), LD_PRELOAD=str(self.layer), FAULTS_FOLDERS=str(world), FAULTS_COUNT=str(count),
                   FAULTS_LOG=str(log), **how)
        return said, read_log(log)

    def injections(self):
        """All that can befall it: (call, way)."""
        for call in self.calls:
            for way in call.ways():
                yield call, way
            if call.number > 1 and self.calls[call.number - 2].name in CHANGES:
                for loss in LOSSES:
                    yield call, "power " + loss
        for loss in LOSSES:
            yield None, "power " + loss  # when all is over

    def inject(self, call, way, slot):
        """What was broken by one disturbance, and the call that was hit: other than `call` when the run took another course."""
        if way.startswith("power "):
            return self.power_cut(call, way.split()[1], slot)
        world = self.world(slot)
        said, calls = self.disturbed(world, FAULTS_AT=str(call.number), FAULTS_HOW=way)
        hit = next((c for c in calls if c.failed), None)
        if hit is None:
            return (["the call is not reached"] if way != "short" else []), call, said
        now, killed, dead = results_in(world / "out"), way in LOSING, way == "EIO..."
        wrong = [] if killed else promise.sentence(said) + promise.kept(said, world, self.kept if self.scenario.name != "pruned" else 0)
        if self.scenario.name in ("pruned", "verified"):
            wrong += promise.results(now, self.old, self.old, True)
        else:
            wrong += promise.results(now, self.old, self.new, said.code in (promise.DONE, promise.IN_PLACE))
        wrong += promise.surroundings(world, self.old | self.new, not killed and not dead and hit.name not in REMOVAL)
        wrong += promise.goes_on(self.scenario, self.work, world, self.new, False)
        return wrong, hit, said

    def power_cut(self, call, loss, slot):
        world = self.world(slot)
        disk = Disk(world)
        _, calls = self.disturbed(world, **({"FAULTS_AT": str(call.number), "FAULTS_HOW": "kill"} if call else {}))
        for made in calls:
            disk.make(made)
        disk.lose(loss)
        wrong = promise.surroundings(world, self.old | self.new, False)
        untouched = self.scenario.name in ("pruned", "verified")
        wrong += promise.results(results_in(world / "out"), self.old, self.old if untouched else self.new, call is None)
        wrong += promise.goes_on(self.scenario, self.work, world, self.new, True)
        return wrong, calls[-1] if call else None, None


class Report:
    def __init__(self):
        self.injections = Counter()
        self.pairs, self.places = set(), set()
        self.broken = defaultdict(list)

    def add(self, scenario, call, way, wrong, said):
        self.injections[scenario] += 1
        self.pairs.add((call.callers if call else (), call.name if call else "", way))
        self.places.add((call.callers[:1] if call else (), call.name if call else "", way))
        for sentence in wrong:
            self.broken[sentence, call.name if call else "the end", way, scenario].append((call, said))

    def print_broken(self, scenario):
        for (sentence, name, way, of), cases in sorted(self.broken.items(), key=lambda item: item[0]):
            if of != scenario:
                continue
            call, said = cases[0]
            print(f"  {name}, {way}: {sentence}   ({len(cases)} calls)")
            if call:
                print(f"      call {call.number}, {call.path.split('/world/')[-1]} {call.second.split('/world/')[-1]}  {' '.join(call.callers[:6])}")
            if said:
                print("      " + str(said).split("\n", 1)[1].strip().replace("\n", "\n      ")[:600], flush=True)

    def print(self):
        print(f"{sum(self.injections.values())} injections, {len(self.pairs)} pairs of call site (with all its callers) and failure, "
              f"{len(self.places)} of place in the code and failure; {len(self.broken)} kinds of broken promises")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("layer", type=Path)
    parser.add_argument("--scenario", action="append", choices=[s.name for s in scenarios.ALL])
    parser.add_argument("--stride", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--call", type=int)
    parser.add_argument("--way", action="append")
    options = parser.parse_args()
    report = Report()
    work = Path(tempfile.mkdtemp(prefix="plumb_faults_")).resolve()
    make_input(work)
    number = 0
    for scenario in scenarios.ALL:
        if options.scenario and scenario.name not in options.scenario:
            continue
        trial = Trial(scenario, work, options.layer.resolve())
        chosen = []
        for injection in trial.injections():
            number += 1
            call, way = injection
            asked = (not options.way or way in options.way) and (options.call is None or (call is not None and call.number == options.call))
            if asked and number % options.stride == 0:
                chosen.append(injection)
        slots = list(range(options.jobs))

        def one(injection):
            slot = slots.pop()
            try:
                return injection, trial.inject(*injection, f"slot{slot}")
            finally:
                slots.append(slot)

        with ThreadPoolExecutor(options.jobs) as pool:
            for (_, way), (wrong, hit, said) in pool.map(one, chosen):
                report.add(scenario.name, hit, way, wrong, said)
        print(f"{scenario.name}: {len(trial.calls)} calls, {len(chosen)} injections", flush=True)
        report.print_broken(scenario.name)
    report.print()
    shutil.rmtree(work, ignore_errors=True)
    return 1 if report.broken or not report.injections else 0


if __name__ == "__main__":
    sys.exit(main())
