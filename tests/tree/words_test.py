#!/usr/bin/env python3
"""Declared names and prose use the field's words, as PCL, Open3D, Ceres, g2o, ROS and evo have them.

    python3 tests/tree/words_test.py [SOURCE]

Names are those of steps, inputs and parameters in schemas/pipeline.schema.json, of outputs in plugins/*/*/step.cpp, and of parameters, rows and what
presets set in pipelines/. Prose is the pages (*.md but the changelog), the pipelines' text, and string literals and /// comments of C++ files.
plugins/former_names.yaml and tests/end_to_end/former hold former names and are exempt.
"""
import json
import re
import sys
import tempfile
from pathlib import Path

# (what is not written, what is), for names of ports, parameters and rows. Words are whole parts of a name.
NAMES = [
    (r"(^|_)(leaf|grain)(_|$)|(^|_)voxel$", "voxel_size, or resolution of an octree"),
    (r"(^|_)cell(_|$)", "resolution"),
    (r"(^|_)(reach|cap|gate)(_|$)", "max_correspondence_distance, or search_window"),
    (r"^(min|max)$", "min_* or max_* with what it bounds"),
    (r"(^|_)(least|most|fewest|nearest|farthest|lowest|highest|greatest|smallest|largest)(_|$)", "min_* or max_*"),
    (r"^iterations$|^rounds$", "max_iterations, max_rounds"),
    (r"^deviations$", "stddev_mul_thresh"),
    (r"(^|_)(hold|trust)(_|$)", "*_sigma"),
    (r"^(search_|most_|max_)?turn$", "search_angle, or max_rotation"),
    (r"(^|_)way(_|$)", "path"),
    (r"^gap$|(^|_)path_gap$", "min_path_separation, or max_time_gap"),
    (r"^over$", "delta"),
    (r"(^|_)groups?(_|$)", "submap"),
    (r"(^|_)relations?(_|$)", "constraints"),
    (r"(^|_)fates?(_|$)", "status"),
    (r"(^|_)key_points?(_|$)", "keypoint"),
]
# For names of steps.
STEPS = [(r"^edges\.(loops|revisits)$|^loop\.", "loops.*"), (r"^relations\.", "constraints.*"), (r"group|leaf|lonel", "submap, voxel, outlier")]
# The benchmark of Kuemmerle et al. keeps its word.
KEPT = {"relations"}
KEPT_IN = {"measure.relations", "zhang2023.yaml", "judge2d.yaml"}
# What a preset sets of a repeat, by the language's own words.
OF_REPEATS = {"at_least", "at_most", "if_exhausted"}
# Of one step only: its names are PCL's.
OF_STEP = {"filter.statistical_outlier": {"neighbours": "mean_k"}}

PROSE = [
    (r"\blonel(y|ier|iest)\b", "outlier"),
    (r"\b(lay|lays|laid|laying)\s+(\w+\s+){0,4}onto\b", "register, align"),
    (r"\bfates?\b", "status"),
    (r"(?<!There )\bis no folder\b", "is not a directory"),
    (r"\bno finite numbers?\b", "non-finite"),
    (r"\bstitched groups?\b|\bpoint groups?\b|\bgroups? of points\b", "submap"),
    (r"\b(edges\.loops|edges\.revisits|loop\.group_to_map|relations\.collect)\b", "the step's name now"),
    (r"\bkey points?\b", "keypoint"),
]

LITERAL = re.compile(r'R"\((.*?)\)"|"((?:[^"\\\n]|\\.)*)"', re.S)
EXEMPT = ("plugins/former_names.yaml", "tests/end_to_end/former/")


def wrong_word(name, rules):
    return next((better for pattern, better in rules if re.search(pattern, name)), None)


def declared(source):
    """(where, step or file, name) of every port, parameter and row; steps by themselves with the name None."""
    schema = json.loads((source / "schemas/pipeline.schema.json").read_text())
    step = schema["definitions"]["step"]
    for name in step["properties"]["use"]["enum"]:
        yield "schemas/pipeline.schema.json", name, None
    for rule in step["allOf"]:
        name, then = rule["if"]["properties"]["use"]["const"], rule["then"].get("properties", {})
        for key in ("from", "with"):
            ports = then.get(key) or {}  # false: a source has no inputs
            for declared_name in ports.get("properties", {}):
                yield "schemas/pipeline.schema.json", name, declared_name
    for file in sorted((source / "plugins").glob("*/*/step.cpp")):
        for declared_name in re.findall(r'\boutput\(\s*"(\w+)"', file.read_text()):
            yield str(file.relative_to(source)), ".".join(file.parts[-3:-1]), declared_name
    for file in sorted((source / "pipelines").rglob("*.yaml")):
        for declared_name in names_of_pipeline(file.read_text()):
            if declared_name in OF_REPEATS:
                continue
            yield str(file.relative_to(source)), file.name, declared_name


def names_of_pipeline(text):
    """Parameters, rows, and what a preset sets: by the last part of its path."""
    section, depth = None, 0
    for line in text.splitlines():
        found = re.match(r"( *)([\w.]+): *(.*)", line)
        if not found:
            continue
        indent, key, rest = len(found[1]), found[2], found[3]
        if section and indent <= depth:
            section = None
        if section:
            yield key.split(".")[-1]
        elif key in ("parameters", "passes", "set"):
            if rest.startswith("{"):
                yield from (path.split(".")[-1] for path in re.findall(r"[{,] *([\w.]+):", rest))
            else:
                section, depth = key, indent


def faults_of_names(source):
    for where, owner, name in declared(source):
        if name is None:
            better = wrong_word(owner, STEPS)
            if better:
                yield f"{where}: the step '{owner}': write {better}"
            continue
        if name in KEPT and owner in KEPT_IN:
            continue
        better = OF_STEP.get(owner, {}).get(name) or wrong_word(name, NAMES)
        if better:
            yield f"{where}: '{name}' of {owner}: write {better}"


def prose(source):
    """(where, text) of all that is checked for phrases."""
    for file in sorted(source.rglob("*.md")):
        if file.name != "CHANGELOG.md":
            yield file, file.read_text()
    for file in sorted((source / "pipelines").rglob("*.yaml")):
        yield file, file.read_text()
    for part in ("framework", "plugins", "tools", "tests"):
        for file in sorted((source / part).rglob("*.[ch]pp")):
            text = file.read_text()
            # Literals that stand side by side are one; so are /// comments line after line.
            literals = re.sub(r'"\s*\n\s*"', "", "\n".join(line for line in text.splitlines() if not line.lstrip().startswith(("//", "#include"))))
            comments = re.sub(r"\n\s*/// ?", " ", "\n" + "\n".join(re.findall(r"^\s*///.*|///<.*", text, re.M)))
            yield file, "\n".join(a or b for a, b in LITERAL.findall(literals)) + "\n" + comments


def faults_of_prose(source):
    for file, text in prose(source):
        where = str(file.relative_to(source))
        if where.startswith(EXEMPT) or where.startswith(("build", ".")):
            continue
        for pattern, better in PROSE:
            for found in re.finditer(pattern, text, re.I):
                yield f"{where}: '{' '.join(found[0].split())}': write {better}"


def faults_of(source):
    return [*faults_of_names(source), *faults_of_prose(source)]


def sees_what_is_wrong():
    """The judge itself, on a made-up tree without and with each kind of fault."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder)

        def write(name, text):
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            (source / name).write_text(text)

        def tree(step="filter.thin", port="segment", parameter="voxel_size", output="segment", row="max_correspondence_distance", pipeline="voxel_size",
                 preset="voxel_size", page="Removes outliers.", doc="the cloud", comment="Registers a scan to a submap."):
            rule = {"if": {"properties": {"use": {"const": step}}},
                    "then": {"properties": {"from": {"properties": {port: {}}}, "with": {"properties": {parameter: {}}}}}}
            write("schemas/pipeline.schema.json", json.dumps({"definitions": {"step": {"properties": {"use": {"enum": [step]}}, "allOf": [rule]}}}))
            write("plugins/filter/thin/step.cpp", f'is.output(\n    "{output}", &Out::a,\n    "{doc[:4]}"\n    "{doc[4:]}");\n/// {comment[:15]}\n/// {comment[15:]}\n')
            write("plugins/filter/thin/README.md", f"# filter.thin\n\n{page}\n")
            write("pipelines/a.yaml", f"parameters:\n  {pipeline}: {{type: length}}\nsteps:\n  fine:\n    repeat:\n      passes:\n        {row}: [1 m]\n      carry: {{a: b}}\n")
            write("pipelines/presets/b.yaml", f"set:\n  fine.{preset}: 1 m\n")
            write("plugins/former_names.yaml", "steps:\n  edges.loops: loops.descriptor\n")
            write("tests/end_to_end/former/a.md", "The lonely points' fate.")
            return faults_of(source)

        assert tree() == [], tree()
        assert tree(preset="at_least") == [], tree(preset="at_least")
        for change, said in (({"step": "edges.loops"}, "loops.*"), ({"port": "relations"}, "constraints"), ({"parameter": "leaf"}, "voxel_size"),
                             ({"parameter": "overlap_voxel"}, "resolution"), ({"parameter": "max"}, "max_*"), ({"parameter": "most_points"}, "max_*"),
                             ({"step": "filter.statistical_outlier", "parameter": "neighbours"}, "mean_k"), ({"output": "groups"}, "submap"),
                             ({"row": "gate"}, "max_correspondence_distance"), ({"pipeline": "key_leaf"}, "voxel_size"), ({"preset": "reach"}, "search_window"),
                             ({"page": "Drops lonely points."}, "outlier"), ({"page": "Each scan is laid\nonto the map."}, "register"),
                             ({"doc": "the stitched group"}, "submap"), ({"comment": "A value that is no finite number."}, "non-finite"),
                             ({"doc": "'a' is no folder"}, "is not a directory")):
            found = tree(**change)
            assert len(found) == 1 and said in found[0], (change, found)


if __name__ == "__main__":
    sees_what_is_wrong()
    found = faults_of(Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve())
    for fault in found:
        print(fault)
    sys.exit(1 if found else 0)
