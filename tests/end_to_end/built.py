"""What compiler and linker left in the build folder: the headers that an object was compiled with, its symbols, what a module needs."""
import functools
import json
import os
import re
import shutil
import subprocess

from plumb_test import BUILD, skip

MODULES = BUILD / "lib/plumb"


def lines_of(tool, *arguments):
    if not shutil.which(tool):
        skip(f"{tool} is not on this machine")
    done = subprocess.run([tool, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def manifests():
    """{module: its manifest}."""
    files = sorted(MODULES.glob("*.json"))
    assert files
    return {file.stem: json.loads(file.read_text()) for file in files}


def module_file(module):
    return MODULES / f"{module}.so"


def name_of(library):
    return library.split(".so")[0].split("/")[-1]


def needed_by(file):
    """The names of the libraries that it is linked to."""
    return {name_of(name) for name in re.findall(r"\(NEEDED\).*\[(.+)\]", "\n".join(lines_of("readelf", "-d", file)))}


@functools.cache
def headers_by_object():
    """{object, by its path in the build folder: all files that the compiler read for it}."""
    found, headers = {}, None
    for line in lines_of("ninja", "-C", BUILD, "-t", "deps"):
        if line and not line.startswith(" "):
            name = line.split(": #deps")[0]
            headers = found.setdefault(name, set()) if (BUILD / name).exists() else None
        elif line.strip() and headers is not None:
            headers.add(os.path.normpath(BUILD / line.strip()))
    return found


def objects_of(target):
    """The objects of a target of CMake's."""
    found = [name for name in headers_by_object() if f"/{target}.dir/" in name]
    assert found, f"no object of {target} was compiled; build all of it first"
    return found


def objects_of_module(module):
    return objects_of(module.replace(".", "_") + "_objects")


def headers_of(objects):
    return set().union(*(headers_by_object()[name] for name in objects))


def symbols_of(name):
    """(what an object defines for others, what it asks of others)."""
    defined, asked = set(), set()
    for line in lines_of("nm", "-g", "--format=posix", BUILD / name):
        symbol, kind = line.split()[:2]
        (asked if kind == "U" else defined).add(symbol)
    return defined, asked
