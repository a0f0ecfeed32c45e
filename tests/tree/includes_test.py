#!/usr/bin/env python3
"""Who includes whom: as CONTRIBUTING.md's table 'Where a line lives' allows it, and never in a circle.

    python3 tests/tree/includes_test.py [SOURCE]

Each row of the table names a folder below framework/plumb and the folders that it may use; what those may use, it may use too. Files of a part
that lie beside its folders stand above them. Tests, and headers for tests (testing.hpp, *_testing.hpp, testing/), may use all of their own part and
what that may use. A step sees its own folder and the parts in the row of `plugins`, never another step.
"""
import re
import sys
import tempfile
from pathlib import Path

INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)


def allowed_uses(contributing):
    """{folder: every folder that it may use}, by the table."""
    direct = {}
    for folder, uses in re.findall(r"^\| `(?:framework/plumb/)?([\w/]+)` \|[^|]*\| ([^|]*) \|$", contributing, re.M):
        direct[folder] = [use for use in re.findall(r"`([\w/]+)`", uses)]
    unknown = {use for uses in direct.values() for use in uses} - set(direct)
    assert not unknown, f"CONTRIBUTING.md: may use {sorted(unknown)}, which have no row of their own"

    def reached(folder, on_the_way):
        assert folder not in on_the_way, f"CONTRIBUTING.md: {' -> '.join(on_the_way + (folder,))} is a circle"
        found = set()
        for use in direct[folder]:
            found |= {use} | reached(use, on_the_way + (folder,))
        return found

    return {folder: reached(folder, ()) for folder in direct}


def for_tests(path):
    return path.name.endswith(("_test.cpp", "testing.hpp")) or "testing" in path.parts[:-1]


def folder_of(path, rows):
    """The row that a file below framework/plumb belongs to: the deepest folder that has one."""
    parent = path.parent
    while str(parent) not in rows:
        assert parent != parent.parent, f"framework/plumb/{path}: no row of CONTRIBUTING.md has its folder"
        parent = parent.parent
    return str(parent)


def faults_of_framework(source, rows):
    root = source / "framework/plumb"
    for file in sorted(root.rglob("*.[ch]pp")):
        path = file.relative_to(root)
        own, part = folder_of(path, rows), path.parts[0]
        may = rows[own] | {own}
        if for_tests(path):
            may |= rows.get(part, set()) | {row for row in rows if row.split("/")[0] == part}
        for name in INCLUDE.findall(file.read_text()):
            target = Path(name).relative_to("plumb") if name.startswith("plumb/") else None
            if target is None or not (root / target).exists():
                yield f'framework/plumb/{path} includes "{name}": includes are "plumb/PART/FILE.hpp", of a file that is there'
            elif folder_of(target, rows) not in may:
                yield f"framework/plumb/{path} includes {name}: `{own}` may not use `{folder_of(target, rows)}`"
            elif for_tests(target) and not for_tests(path):
                yield f"framework/plumb/{path} includes {name}, which is for tests"


def faults_of_plugins(source, rows):
    for file in sorted((source / "plugins").rglob("*.[ch]pp")):
        for name in INCLUDE.findall(file.read_text()):
            shown = f"{file.relative_to(source)} includes {name}"
            if name.startswith("plumb/"):
                target = Path(name).relative_to("plumb")
                if not (source / "framework" / name).exists():
                    yield f"{shown}, which is not there"
                elif not for_tests(file) and folder_of(target, rows) not in rows["plugins"]:
                    yield f"{shown}: a step may not use `{folder_of(target, rows)}`"
            elif ".." in name or not (file.parent / name).exists():
                if not (for_tests(file) and ".." not in name):
                    yield f"{shown}, which is not in its folder"


def circles(source):
    """Headers that include each other, by whatever way."""
    root = source / "framework"
    uses = {str(f.relative_to(root)): INCLUDE.findall(f.read_text()) for f in root.rglob("*.hpp")}
    done, way = set(), []

    def walk(name):
        if name in way:
            yield " -> ".join(way[way.index(name):] + [name])
        elif name not in done and name in uses:
            way.append(name)
            for used in uses[name]:
                yield from walk(used)
            way.pop()
            done.add(name)

    for name in sorted(uses):
        yield from walk(name)


def faults_of(source):
    rows = allowed_uses((source / "CONTRIBUTING.md").read_text())
    return [*faults_of_framework(source, rows), *faults_of_plugins(source, rows), *(f"a circle: {circle}" for circle in circles(source))]


def sees_what_is_wrong():
    """The judge itself, on a tree of three parts in which each kind of fault was made."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder)
        (source / "CONTRIBUTING.md").write_text("| `framework/plumb/low` | x | - |\n| `framework/plumb/high/inner` | x | `low` |\n"
                                                "| `framework/plumb/high` | x | `high/inner` |\n| `plugins` | x | `low` |\n")

        def write(name, *includes):
            file = source / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text("".join(f'#include "{include}"\n' for include in includes))

        write("framework/plumb/low/a.hpp")
        write("framework/plumb/high/inner/b.hpp", "plumb/low/a.hpp")
        write("framework/plumb/high/c.hpp", "plumb/high/inner/b.hpp", "plumb/low/a.hpp")
        write("framework/plumb/high/inner/b_test.cpp", "plumb/high/c.hpp")
        write("plugins/one/step/step.cpp", "plumb/low/a.hpp", "kernel.hpp")
        write("plugins/one/step/kernel.hpp")
        assert faults_of(source) == [], faults_of(source)
        for name, include, said in (("framework/plumb/low/d.hpp", "plumb/high/c.hpp", "`low` may not use `high`"),
                                    ("framework/plumb/high/inner/d.hpp", "plumb/high/c.hpp", "`high/inner` may not use `high`"),
                                    ("framework/plumb/low/d.hpp", "a.hpp", "PART/FILE"),
                                    ("framework/plumb/low/a.hpp", "plumb/low/a.hpp", "a circle"),
                                    ("plugins/two/step/step.cpp", "../../one/step/kernel.hpp", "not in its folder"),
                                    ("plugins/two/step/step.cpp", "plumb/high/c.hpp", "may not use `high`")):
            before = (source / name).read_text() if (source / name).exists() else None
            write(name, include)
            found = faults_of(source)
            assert len(found) == 1 and said in found[0], (name, include, found)
            (source / name).unlink() if before is None else (source / name).write_text(before)


if __name__ == "__main__":
    sees_what_is_wrong()
    found = faults_of(Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve())
    for fault in found:
        print(fault)
    sys.exit(1 if found else 0)
