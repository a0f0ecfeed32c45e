"""The commands that are disturbed, and what lies there before."""
from world import lay_out_users_own, plumb


class Scenario:
    """`before` prepares a world; `command` is disturbed, and `again` is what a user does next: the results are whole then."""

    def __init__(self, name, command, before=lambda work, world: None, again=None):
        self.name, self.before, self._command, self._again = name, before, command, again or command

    def command(self, work, world):
        return self._command(work, world)

    def again(self, work, world):
        return self._again(work, world)

    def prepare(self, work, world):
        world.mkdir()
        lay_out_users_own(world)
        self.before(work, world)


def small(*options, pipeline="small.yaml"):
    return lambda work, world: ["run", work / pipeline, "--set", f"input={work / 'sequence'}", "--cache-dir", world / "store", "-o", world / "out",
                                "--threads", 1, "--quiet", *options]


def compare(work, world):
    return ["compare", work / "small.yaml", "--variant", f"coarse={work / 'coarse.yaml'}", "--input", work / "sequence", "--metric", "solved.*",
            "--cache-dir", world / "store", "-o", world / "out", "--threads", 1, "--quiet"]


def prune(work, world):
    return ["cache", "prune", "--size", "0B", "--cache-dir", world / "store"]


def verify(work, world):
    return ["cache", "verify", "--cache-dir", world / "store"]


def earlier(work, world):
    """An earlier run with a coarser map: half of the store serves, and its results are replaced."""
    plumb(*small("--set", "voxel_size=1m")(work, world))


def the_same(work, world):
    plumb(*small()(work, world))


def compared(work, world):
    plumb(*compare(work, world))


ALL = [
    Scenario("fresh", small()),
    Scenario("over", small(), earlier),
    Scenario("same", small(), the_same),
    Scenario("isolated", small("--executor", "process"), earlier),
    Scenario("compared", compare),
    Scenario("compared_again", compare, compared),
    Scenario("pruned", prune, the_same, again=small()),
    Scenario("verified", verify, the_same, again=small()),
]
