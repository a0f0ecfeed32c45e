"""The page of the language, pipelines/README.md: its examples are pipelines and presets, and it has every key.

A fenced block is `yaml file=NAME`, a whole pipeline or preset (with `over=PIPELINE`, one that is also laid over another), `yaml steps`, steps that are added
to street.yaml, `yaml experiment=NAME`, an experiment over them, or `sh`, a command a line.
"""
import json
import re
import shlex
import textwrap

from plumb_test import PIPELINES, SOURCE, WRONG_INPUT, plumb

PAGE = PIPELINES / "README.md"
INPUT = ["--set", "input=."]


def blocks():
    """[(language, {mark: value}, text)]."""
    found = re.findall(r"^```([^\n]*)\n(.*?)^```$", PAGE.read_text(), re.M | re.S)
    assert PAGE.read_text().count("```") == 2 * len(found) and len(found) > 8
    return [(info.split()[0], dict(mark.partition("=")[::2] for mark in info.split()[1:]), text) for info, text in found]


def examples(folder):
    """Writes the whole files and a preset for each block of steps; {file: pipeline that it is laid over too, or None}."""
    files = {}
    for number, (language, marks, text) in enumerate(blocks()):
        assert language == "sh" or language == "yaml" and marks, f"block {number} has no mark, so that nothing checks it:\n{text}"
        if "file" in marks:
            (folder / marks["file"]).write_text(text)
            files[marks["file"]] = marks.get("over")
        elif "steps" in marks:
            (folder / f"steps_{number}.yaml").write_text("plumb: 1\nextends: street.yaml\nadd:\n" + textwrap.indent(text, "  "))
            files[f"steps_{number}.yaml"] = None
    return files


def test_every_example_checks(folder):
    files = examples(folder)
    assert "street.yaml" in files and sum(name.startswith("steps_") for name in files) >= 4, files
    for name, over in files.items():
        plumb("check", folder / name, *INPUT).has("good")
        if over:
            plumb("check", folder / over, "--preset", folder / name, *INPUT).has("good")


def test_every_experiment_can_be_run(folder):
    """But for its inputs, which are not there."""
    examples(folder)
    found = [(marks["experiment"], text) for _, marks, text in blocks() if "experiment" in marks]
    assert found
    for name, text in found:
        (folder / "inner").mkdir(exist_ok=True)
        for file in folder.glob("*.yaml"):
            (folder / "inner" / file.name).write_text(file.read_text())
        (folder / "inner" / name).write_text(text)
        plumb("compare", folder / "inner" / name, code=WRONG_INPUT).has("input '../street': there is no such file or folder")
        (folder / "street").mkdir()
        (folder / "street/odometry.tum").write_text("0 0 0 0 0 0 0 1\n")
        plumb("compare", folder / "inner" / name, code=WRONG_INPUT).has("input '../mall': there is no such file or folder")


def test_the_page_has_every_key_of_experiments(folder):
    reader = (SOURCE / "framework/plumb/slam/experiment/experiment_file.cpp").read_text()
    keys = re.findall(r'"([a-z_]+)"', re.search(r"known = \{(.*?)\};", reader, re.S)[1])
    assert {"experiment", "primary", "sweep_by"} < set(keys), keys
    missing = [key for key in keys if f"`{key}`" not in PAGE.read_text()]
    assert not missing, missing


def test_every_command_works(folder):
    examples(folder)
    lines = [line for language, _, text in blocks() if language == "sh" for line in text.splitlines()]
    assert len(lines) >= 4
    for line in lines:
        program, *words = shlex.split(line.replace("DIR", "."))
        assert program == "plumb", line
        plumb(*words, cwd=folder).has("good")


def test_what_it_says_of_rows_is_so(folder):
    examples(folder)
    said = plumb("check", folder / "car.yaml", *INPUT)
    assert re.search(r"fine: 4 passes\n.*\n +1 +2 m\n +2 +1 m\n +3-4 +1 m\n", said.out), said
    plumb("check", folder / "street.yaml", *INPUT, "--set", "fine.at_least=2", code=1).has("means nothing without 'until'")


def keys_of(node):
    """Every name of a property that a schema declares."""
    if isinstance(node, dict):
        for name, inner in node.get("properties", {}).items():
            yield name
            yield from keys_of(inner)
        for key in ("then", "else", "items", "additionalProperties", "anyOf"):
            yield from keys_of(node.get(key))
    elif isinstance(node, list):
        for inner in node:
            yield from keys_of(inner)


def test_the_page_has_every_key_type_and_unit(folder):
    definitions = json.loads((SOURCE / "schemas/pipeline.schema.json").read_text())["definitions"]
    keys = {key for name in ("pipeline", "overlay", "edits", "parameter", "group", "repeat", "step") for key in keys_of(definitions[name])}
    assert {"until", "below", "also", "on_error"} < keys, keys
    types = definitions["parameter"]["properties"]["type"]["enum"]
    units = re.findall(r'\{Quantity::\w+, "([^"]+)"', (SOURCE / "framework/plumb/plugin/unit.cpp").read_text())
    assert len(types) > 10 and len(units) > 10
    text = PAGE.read_text()
    missing = [word for word in [*sorted(keys), *types, *units] if f"`{word}`" not in text]
    assert not missing, missing
