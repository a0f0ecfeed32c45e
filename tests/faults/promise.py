"""What is promised whatever happens, and whether it was kept: each check gives sentences, none when all is well."""
import re

from world import beside, blobs_in, results_in, run, unfinished_in, users_loss
from scenarios import verify

DONE, WRONG_INPUT, STEP_FAILED, IN_PLACE = 0, 1, 3, 4  # the last: the results are in place, and something is to be said of them

NO_SENTENCE = re.compile(r"(std::|terminate called|basic_|what\(\)|filesystem error|bad_alloc|^plumb: .{0,25}$|Segmentation)", re.MULTILINE)


NUMBERS = re.compile(r"[0-9a-f]*\d[0-9a-f]*")  # and tokens: what differs from run to run in a name


def sentence(said):
    """The exit and what is said of it."""
    if said.code is None:
        return ["it hangs"]
    if said.code not in (DONE, WRONG_INPUT, STEP_FAILED, IN_PLACE):
        return [f"exit {said.code}"]
    wrong = []
    lines = said.err.strip().splitlines()
    if said.code and not (lines and lines[-1].startswith("plumb: ")) and "damaged" not in said.out + said.err:
        wrong.append("no sentence of plumb's comes last")
    if said.code and sum(line.startswith("plumb: ") and "is in place, but" not in line for line in lines) > 1:
        wrong.append("more than one sentence")
    if NO_SENTENCE.search(said.err):
        wrong.append("the sentence is none for a user")
    return wrong


def results(now, old, new, whole):
    """Every folder of results is as it was, or new and whole; with `whole` it is new."""
    wrong = []
    for folder in sorted(old | new):
        there = now.get(folder)
        if whole:
            if there != new.get(folder):
                wrong.append("the exit says that the results are in place, and they are not whole")
        elif there is None:
            if folder in old:
                wrong.append("the old results are gone")
        elif there not in (old.get(folder), new.get(folder)):
            wrong.append("the results are neither the old ones nor the new")
    return sorted(set(wrong))


def surroundings(world, folders, tidy):
    """What is the user's is there, and (`tidy`) nothing that is nobody's; results may stand in `folders`."""
    lost = users_loss(world)
    wrong = [f"the user's {lost} is not as it was"] if lost else []
    if tidy:
        left = beside(world, folders)
        wrong += ["something is left beside the results: " + NUMBERS.sub("#", left[0])] if left else []
        left = unfinished_in(world / "store")
        wrong += ["something is left in the store: " + NUMBERS.sub("#", left[0])] if left else []
    return wrong


def kept(said, world, expected):
    """Results that should be in the store and are not are a matter of a sentence."""
    if said.code == 0 and len(blobs_in(world / "store")) < expected and "cache: " not in said.err:
        return ["results were not kept, and not a word of it"]
    return []


def goes_on(scenario, work, world, new, torn):
    """The next run makes the results whole; what a power cut tore (`torn`) it may have to make again."""
    said = run(scenario.again(work, world))
    if said.code != 0:
        return [f"the next run fails (exit {said.code}): " + (said.err.strip().splitlines() or ["?"])[-1].replace(str(world), "WORLD")]
    wrong = results(results_in(world / "out"), {}, new, True)
    wrong += [f"the next run says: {said.err.strip()}"] if "damaged" in said.err and not torn else []
    wrong += surroundings(world, new, True)
    checked = run(verify(work, world))
    if checked.code == 1 and torn:
        checked = run(verify(work, world))
    if checked.code != 0 or "all whole" not in checked.out:
        wrong.append(f"the store is not good: {checked.out + checked.err}".replace(str(world), "WORLD"))
    return ["after the next run: " + sentence if not sentence.startswith("the ") else sentence for sentence in wrong]
