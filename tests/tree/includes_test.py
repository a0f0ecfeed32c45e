#!/usr/bin/env python3
"""Who includes whom: as CONTRIBUTING.md's table 'Where a line lives' allows it, and never in a cycle.

    python3 tests/tree/includes_test.py [SOURCE]

Each row of the table names a folder below framework/plumb and the folders that it may use; what those may use, it may use too. Files of a part
that lie beside its folders stand above them. Tests, and headers for tests (testing.hpp, *_testing.hpp, testing/), may use all of their own part and
what that may use. A step sees its own folder, libraries plugins/shared/NAME that it links, and the parts in the row of `plugins`, never another step;
a library in plugins/shared sees the parts in its own row, and no step. What stands in plugins/FAMILY/STEP is in namespace plumb::FAMILY_STEP, what
stands in plugins/shared/NAME in plumb::NAME. Whatever the table says, the core (CORE below) and its tests know no SLAM and no Eigen.
"""
import re
import sys
import tempfile
from pathlib import Path

INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)
CORE = ("data", "plugin", "pipeline", "store", "engine")
NOT_IN_CORE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"](?:(?:unsupported/)?Eigen|plumb/slam)/[^>"]+[>"])', re.M)
NAMESPACE = re.compile(r"^namespace (plumb\S*) \{", re.M)


def allowed_uses(contributing):
    """{folder: every folder that it may use}, by the table."""
    direct = {}
    for folder, uses in re.findall(r"^\| `(?:framework/plumb/)?([\w/]+)` \|[^|]*\| ([^|]*) \|$", contributing, re.M):
        direct[folder] = [use for use in re.findall(r"`([\w/]+)`", uses)]
    unknown = {use for uses in direct.values() for use in uses} - set(direct)
    assert not unknown, f"CONTRIBUTING.md: may use {sorted(unknown)}, which have no row of their own"

    def reached(folder, on_the_way):
        assert folder not in on_the_way, f"CONTRIBUTING.md: {' -> '.join(on_the_way + (folder,))} is a cycle"
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


def faults_of_core(source):
    for part in CORE:
        for file in sorted((source / "framework/plumb" / part).rglob("*.[ch]pp")):
            for name in NOT_IN_CORE.findall(file.read_text()):
                yield f"{file.relative_to(source)} includes {name}: the core and its tests know no SLAM and no Eigen"


def fault_of_plugin(source, rows, file, name):
    """What is wrong with a file of plugins/ that includes `name`; None: nothing."""
    own = "plugins/shared" if file.is_relative_to(source / "plugins/shared") else "plugins"
    if name.startswith("plumb/"):
        target = Path(name).relative_to("plumb")
        if not (source / "framework" / name).exists():
            return ", which is not there"
        if not for_tests(file) and folder_of(target, rows) not in rows[own]:
            return f": `{own}` may not use `{folder_of(target, rows)}`"
    elif name.startswith("shared/"):
        target = source / "plugins" / name
        if not target.exists():
            return ", which is not there"
        if for_tests(target) and not for_tests(file):
            return ", which is for tests"
        library = f"plumb_shared_{target.parent.name}"
        if file.parent != target.parent and library not in (file.parent / "CMakeLists.txt").read_text():
            return f", but its CMakeLists.txt does not link {library}"
    elif ".." in name or own == "plugins/shared" or not (for_tests(file) or (file.parent / name).exists()):
        return ", which is not in its folder"
    return None


def faults_of_plugins(source, rows):
    for file in sorted((source / "plugins").rglob("*.[ch]pp")):
        text, shown = file.read_text(), file.relative_to(source)
        for name in INCLUDE.findall(text):
            if fault := fault_of_plugin(source, rows, file, name):
                yield f"{shown} includes {name}{fault}"
        _, family, step = shown.parts[:3]
        own = f"plumb::{step if family == 'shared' else f'{family}_{step}'}"
        for other in sorted(set(NAMESPACE.findall(text)) - {own}):
            yield f"{shown} opens namespace {other}, but its folder has {own}"


def cycles(source):
    """Headers that include each other, by whatever way."""
    uses = {str(f.relative_to(root)): INCLUDE.findall(f.read_text())
            for root, below in ((source / "framework", "."), (source / "plugins", "shared")) for f in (root / below).rglob("*.hpp")}
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
    return [*faults_of_framework(source, rows), *faults_of_core(source), *faults_of_plugins(source, rows),
            *(f"a cycle: {cycle}" for cycle in cycles(source))]


def sees_what_is_wrong():
    """The judge itself, on a tree of three parts in which each kind of fault was made."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder)
        (source / "CONTRIBUTING.md").write_text("| `framework/plumb/low` | x | - |\n| `framework/plumb/high/inner` | x | `low` |\n"
                                                "| `framework/plumb/high` | x | `high/inner` |\n| `plugins/shared` | x | `low` |\n"
                                                "| `plugins` | x | `plugins/shared` |\n")

        def write(name, *includes, namespace=None):
            file = source / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text("".join(f'#include "{include}"\n' for include in includes) + (f"namespace {namespace} {{\n" if namespace else ""))

        write("framework/plumb/low/a.hpp")
        write("framework/plumb/high/inner/b.hpp", "plumb/low/a.hpp")
        write("framework/plumb/high/c.hpp", "plumb/high/inner/b.hpp", "plumb/low/a.hpp")
        write("framework/plumb/high/inner/b_test.cpp", "plumb/high/c.hpp")
        write("plugins/shared/lib/lib.hpp", "plumb/low/a.hpp", namespace="plumb::lib")
        write("plugins/shared/lib/lib_testing.hpp", "shared/lib/lib.hpp")
        write("plugins/one/step/step.cpp", "plumb/low/a.hpp", "kernel.hpp", "shared/lib/lib.hpp", namespace="plumb::one_step")
        write("plugins/one/step/kernel.hpp")
        for folder_of_step, text in (("one/step", "plumb_add_step(one.step LIBRARIES plumb_shared_lib)\n"), ("two/step", "plumb_add_step(two.step)\n")):
            (source / "plugins" / folder_of_step).mkdir(parents=True, exist_ok=True)
            (source / "plugins" / folder_of_step / "CMakeLists.txt").write_text(text)
        assert faults_of(source) == [], faults_of(source)
        for name, include, said in (("framework/plumb/low/d.hpp", "plumb/high/c.hpp", "`low` may not use `high`"),
                                    ("framework/plumb/high/inner/d.hpp", "plumb/high/c.hpp", "`high/inner` may not use `high`"),
                                    ("framework/plumb/low/d.hpp", "a.hpp", "PART/FILE"),
                                    ("framework/plumb/low/a.hpp", "plumb/low/a.hpp", "a cycle"),
                                    ("plugins/two/step/step.cpp", "../../one/step/kernel.hpp", "not in its folder"),
                                    ("plugins/two/step/step.cpp", "plumb/high/c.hpp", "may not use `high`"),
                                    ("plugins/two/step/step.cpp", "shared/lib/lib.hpp", "does not link plumb_shared_lib"),
                                    ("plugins/two/step/step.cpp", "shared/lib/none.hpp", "not there"),
                                    ("plugins/one/step/step.cpp", "shared/lib/lib_testing.hpp", "for tests"),
                                    ("plugins/shared/lib/more.hpp", "plumb/high/c.hpp", "`plugins/shared` may not use `high`"),
                                    ("plugins/shared/lib/more.hpp", "../../one/step/kernel.hpp", "not in its folder"),
                                    ("plugins/shared/lib/lib.hpp", "shared/lib/lib.hpp", "a cycle")):
            before = (source / name).read_text() if (source / name).exists() else None
            write(name, include)
            found = faults_of(source)
            assert len(found) == 1 and said in found[0], (name, include, found)
            (source / name).unlink() if before is None else (source / name).write_text(before)
        write("plugins/two/step/step.cpp", namespace="plumb::one_step")
        found = faults_of(source)
        assert len(found) == 1 and "its folder has plumb::two_step" in found[0], found


def sees_slam_in_the_core():
    """The judge of the core, on a tree whose table allows what the core must not do."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder)
        (source / "CONTRIBUTING.md").write_text("| `framework/plumb/slam` | x | - |\n" +
                                                "".join(f"| `framework/plumb/{part}` | x | `slam` |\n" for part in CORE))

        def write(name, line):
            file = source / "framework/plumb" / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(line + "\n")
            return file

        for name, line in (("slam/pose.hpp", "#include <Eigen/Core>"), ("slam/pose_test.cpp", '#include "plumb/slam/pose.hpp"'),
                           ("data/hash.cpp", "// #include <Eigen/Core>"), ("data/hash_test.cpp", "#include <Eigenvalues.h>")):
            write(name, line)
        assert faults_of(source) == [], faults_of(source)
        for name in ("data/a.hpp", "plugin/a_test.cpp", "pipeline/testing/steps.hpp", "store/a_testing.hpp", "engine/run/a.cpp"):
            for line in ("#include <Eigen/Core>", "  # include <unsupported/Eigen/FFT>", '#include "plumb/slam/pose.hpp"', "#include <plumb/slam/pose.hpp>"):
                file = write(name, line)
                found = faults_of(source)
                assert len(found) == 1 and name in found[0] and "no SLAM and no Eigen" in found[0], (name, line, found)
                file.unlink()


if __name__ == "__main__":
    sees_what_is_wrong()
    sees_slam_in_the_core()
    found = faults_of(Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve())
    for fault in found:
        print(fault)
    sys.exit(1 if found else 0)
