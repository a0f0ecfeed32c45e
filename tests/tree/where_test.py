#!/usr/bin/env python3
"""CONTRIBUTING.md's table 'Where is ...?' is true: its files are there and hold the words that are named for them.

    python3 tests/tree/where_test.py [SOURCE]

In the second column every word in backquotes that is the path of a file begins with a folder of the tree; those behind it, up to the next path, stand in that
file. Line ends, indentation and the marks of C++ comments between the parts of a phrase do not count.
"""
import re
import sys
import tempfile
from pathlib import Path

FOLDERS = ("framework/", "pipelines/", "plugins/", "schemas/", "tests/", "tools/")
WANTED = ("misspelt step", "exit codes", "last value repeats", "former names", "hash of a cloud", "cache key", "Slurm chunk", "ABI tag",
          "eq. (1) of [Tang2024]", "eq. (2) of [Tang2024]", "eq. (3) of [Tang2024]", "(12) of [Zhang2023]", "eq. (13) of [Zhang2023]")


def rows(contributing):
    """[(what, [(file, [words])])] of the table."""
    section = contributing.partition("## Where is ...?\n")[2].partition("\n## ")[0]
    found = []
    for what, where in re.findall(r"^\| ((?!---|what \|).*?) \| (.*) \|$", section, re.M):
        files = []
        for word in re.findall(r"`([^`]+)`", where):
            if word.startswith(FOLDERS):
                files.append((word, []))
            elif files:
                files[-1][1].append(word)
        found.append((what, files))
    return found


def plain(text):
    """On one line, without the marks of comments."""
    return re.sub(r"\s+", " ", re.sub(r"^\s*(///?<?|#)", " ", text, flags=re.M))


def faults_of(source, wanted=WANTED):
    found = rows((source / "CONTRIBUTING.md").read_text())
    for what in wanted:
        if not any(what in row for row, _ in found):
            yield f"the table has no row for '{what}'"
    for what, files in found:
        if not files:
            yield f"'{what}': no file is named"
        for name, words in files:
            if not (source / name).is_file():
                yield f"'{what}': there is no file {name}"
                continue
            text = plain((source / name).read_text())
            if not words:
                yield f"'{what}': no word to search for in {name}"
            yield from (f"'{what}': {name} does not hold '{word}'" for word in words if plain(word) not in text)


def sees_what_is_wrong():
    """The judge itself, on a made-up table without and with each kind of fault."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder)
        (source / "tools").mkdir()
        (source / "tools/a.hpp").write_text("/// The rule of [Paper] eq.\n/// (1).\nint rule();\n")

        def told(where, what="the rule"):
            (source / "CONTRIBUTING.md").write_text(f"# A\n\n## Where is ...?\n\n| what | where |\n| --- | --- |\n| {what} | {where} |\n\n## B\n\n| x | y |\n")
            return list(faults_of(source, ["the rule"]))

        assert told("`tools/a.hpp`: `[Paper] eq. (1)`, `int rule`") == [], told("`tools/a.hpp`: `[Paper] eq. (1)`, `int rule`")
        for where, said in (("`tools/b.hpp`: `int rule`", "no file tools/b.hpp"), ("`tools/a.hpp`: `int ruler`", "does not hold 'int ruler'"),
                            ("`tools/a.hpp`", "no word to search for"), ("somewhere", "no file is named")):
            found = told(where)
            assert len(found) == 1 and said in found[0], (where, found)
        assert told("`tools/a.hpp`: `int rule`", "a law") == ["the table has no row for 'the rule'"]


if __name__ == "__main__":
    sees_what_is_wrong()
    found = list(faults_of(Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()))
    for fault in found:
        print(fault)
    sys.exit(1 if found else 0)
