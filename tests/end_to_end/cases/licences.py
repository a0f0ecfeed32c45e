"""What whoever loads a module accepts is stated in its manifest, shown, and no less than what the module loads."""
import functools
import json
import re
import shutil

from built import headers_of, lines_of, manifests, module_file, name_of, needed_by, objects_of_module
from plumb_test import BUILD, WRONG_INPUT, plumb, step_names

# What a module may link: of the system and of libplumb, under a BSD licence, and what asks for a licence of its own to be stated.
SYSTEM = {"libc", "libm", "libmvec", "libdl", "librt", "libpthread", "libstdc++", "libgcc_s", "libatomic", "ld-linux-x86-64", "libplumb", "libplumb_slam", "libtbb"}
BSD = {"libceres", "libglog", "libgflags", "liblapack", "libblas", "libf77blas", "libatlas", "libamd", "libcamd", "libcolamd", "libccolamd",
       "libsuitesparseconfig", "libpcl_common", "libpcl_kdtree", "libpcl_octree", "libpcl_search", "libpcl_sample_consensus", "libpcl_filters", "libpcl_features",
       "libpcl_registration", "libpcl_recognition"}
STATED = {"libbz2": {"bzip2-1.0.6"}, "liblz4": {"BSD-2-Clause"}, "libz": {"Zlib"}, "libpng16": {"libpng-2.0"}, "libmetis": {"Apache-2.0"},
          "libcholmod": {"GPL-2.0-or-later", "LGPL-2.1-or-later"}, "libspqr": {"GPL-2.0-or-later"}, "libumfpack": {"GPL-2.0-or-later"},
          "libcxsparse": {"LGPL-2.1-or-later"}, "libklu": {"LGPL-2.1-or-later"}, "libbtf": {"LGPL-2.1-or-later"}, "libfftw3": {"GPL-2.0-or-later"},
          "libgsl": {"GPL-3.0-or-later"}, "libreadline": {"GPL-3.0-or-later"}, "libgmp": {"LGPL-3.0-or-later"}, "libmpfr": {"LGPL-3.0-or-later"},
          "libjbig": {"GPL-2.0-or-later"}, "libusb-1.0": {"LGPL-2.1-or-later"}, "libsystemd": {"LGPL-2.1-or-later"}, "libudev": {"LGPL-2.1-or-later"},
          "libgcrypt": {"LGPL-2.1-or-later"}, "libgpg-error": {"LGPL-2.1-or-later"}, "libOpenNI": {"Apache-2.0"}, "libOpenNI2": {"Apache-2.0"},
          "libLerc": {"Apache-2.0"}, "libboost_filesystem": {"BSL-1.0"}, "libboost_iostreams": {"BSL-1.0"}, "libdeflate": {"MIT"}, "libjsoncpp": {"MIT"},
          "libtinyxml": {"Zlib"}, "libtiff": {"LicenseRef-libtiff"}, "libjpeg": {"LicenseRef-IJG"}, "liblz4": {"BSD-2-Clause"}}
# Libraries that are headers alone leave no trace in what is linked. CGAL's headers state their licence each.
HEADERS = {"/flann/": {"BSD-2-Clause"}, "/CGAL/": None}


def loaded_by(file):
    """The names of all that the loader takes for it, directly or not."""
    return {name_of(line.split()[0]) for line in lines_of("ldd", file) if line.strip()}


def brought_by_headers(module):
    """What the headers that the compiler read for its own code come under."""
    found = set()
    for header in headers_of(objects_of_module(module)):
        for folder in HEADERS:
            if folder in header:
                found |= HEADERS[folder] or spdx_of(header)
    return found


@functools.cache
def spdx_of(header):
    """What a header says of itself; of a choice the first. None of Boost's licence, which asks nothing of who links."""
    with open(header, encoding="utf-8", errors="replace") as text:
        stated = re.search(r"SPDX-License-Identifier: (\S+)", text.read(4000))
    assert stated, f"{header} states no licence"
    return frozenset({stated[1]} - {"BSL-1.0"})


def table():
    """{licences: {module's file: its steps}} as `plumb list --licences` prints it; reasons left out."""
    groups = {}
    for line in plumb("list", "--licences").out.splitlines():
        if re.match(r"  \S", line):
            file, steps = line.split(maxsplit=1)
            group[file] = steps.split(", ")
        elif re.match(r"\S", line):
            group = groups.setdefault(line, {})
    return groups


def test_every_module_is_listed_once_with_its_steps_under_its_licences(folder):
    groups = table()
    for module, manifest in manifests().items():
        found = [licences for licences, modules in groups.items() if module + ".so" in modules]
        assert found == [manifest["licence"]["expression"]], (module, found)
        assert groups[found[0]][module + ".so"] == sorted(step["name"] for step in manifest["steps"]), module
    assert sorted(step for modules in groups.values() for steps in modules.values() for step in steps) == sorted(step_names())


def test_inspect_shows_the_licences_and_the_reason(folder):
    for module, manifest in manifests().items():
        stated = manifest["licence"]
        for step in manifest["steps"]:
            plumb("inspect", step["name"]).has(f"Licence of its module: {stated['expression']}\n", stated["reason"])
            assert json.loads(plumb("inspect", step["name"], "--json").out)["licence"] == stated


def test_a_module_states_the_licences_of_all_that_it_links_and_of_the_headers_it_is_compiled_with(folder):
    of_libplumb = loaded_by(BUILD / "lib/libplumb_slam.so")
    assert not [name for name in of_libplumb & set(STATED) if any("GPL" in licence for licence in STATED[name])], of_libplumb
    for module, manifest in manifests().items():
        file, stated = module_file(module), set(manifest["licence"]["expression"].split(" AND "))
        linked = needed_by(file)
        unknown = {name for name in linked - SYSTEM - BSD - set(STATED) if not re.fullmatch(r"lib[a-z]+san", name)}  # sanitizers' builds
        assert not unknown, f"{module} links {sorted(unknown)}: add to STATED what that asks for, and this to the module's LICENCE"
        loaded = linked | (loaded_by(file) - of_libplumb)
        brought = set().union(*(STATED[name] for name in loaded & set(STATED)), brought_by_headers(module))
        assert {"BSD-3-Clause"} | brought <= stated, f"{module} loads what is {sorted(brought)} and states {sorted(stated)}"
        assert {licence for licence in stated if "GPL" in licence} <= brought, f"{module} states {sorted(stated)} and loads what is {sorted(brought)}"
        assert manifest["licence"]["reason"] or not brought, module


def foreign_module(folder, licence):
    """A folder with one module, whose manifest states `licence`; None: nothing. It came with nobody's Plumb."""
    folder.mkdir()
    folder.chmod(0o755)
    source, module = BUILD / "tests/end_to_end/modules/test.nothing", folder / "test.nothing.so"
    shutil.copy(source.with_name("test.nothing.so"), module)
    manifest = json.loads(source.with_name("test.nothing.json").read_text())
    assert manifest.pop("licence") == {"expression": "BSD-3-Clause", "reason": ""}
    if licence is not None:
        manifest["licence"] = licence
    file = folder / "test.nothing.json"
    file.write_text(json.dumps(manifest))
    for path in (module, file):
        path.chmod(0o644)
    return module


def test_a_module_from_elsewhere_is_listed_by_its_path_with_its_reason(folder):
    module = foreign_module(folder / "a", {"expression": "GPL-3.0-only OR LicenseRef-ours", "reason": "It links libours."})
    said = plumb("--plugin-path", module.parent, "list", "--licences")
    lines = said.out.splitlines()
    at = lines.index("GPL-3.0-only OR LicenseRef-ours")
    assert lines[at + 1].split(maxsplit=1)[0] == str(module) and lines[at + 2] == "      It links libours.", said


def test_a_manifest_of_an_earlier_build_states_no_licence_and_is_taken(folder):
    module = foreign_module(folder / "a", None)
    plumb("--plugin-path", module.parent, "list", "--licences").has(f"not stated\n  {module}")
    plumb("--plugin-path", module.parent, "inspect", "test.nothing").has("Licence of its module: not stated\n")
    assert json.loads(plumb("--plugin-path", module.parent, "inspect", "test.nothing", "--json").out)["licence"] is None


def test_a_manifest_with_an_empty_or_unknown_licence_is_refused(folder):
    for name, expression, words in (("empty", "", "its licence is empty; write an SPDX expression"),
                                    ("unknown", "MIT AND GPL", "its licence 'MIT AND GPL' names 'GPL', which is not known here; known are"),
                                    ("torn", "MIT AND", "its licence 'MIT AND' ends where something must follow")):
        module = foreign_module(folder / name, {"expression": expression, "reason": ""})
        said = plumb("--plugin-path", module.parent, "list", "--licences").has(f"refused: {module}", words)
        assert "test.nothing" not in said.out, said
        plumb("--plugin-path", module.parent, "doctor", code=WRONG_INPUT).has(words)
