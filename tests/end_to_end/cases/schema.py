"""The JSON Schema says of pipelines what the command says."""
import json
import re

import jsonschema
import yaml

from plumb_test import CASCADE, SOURCE, WRONG_INPUT, installation, left_out, plumb, shipped_pipelines, step_names

SCHEMA = SOURCE / "schemas/pipeline.schema.json"


def pipelines():
    files = shipped_pipelines()
    assert len(files) >= 4, files
    return files


def judge():
    schema = json.loads(plumb("schema").out)
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


class PlainLoader(yaml.SafeLoader):
    """YAML 1.2's core schema, by which editors judge: `yes` is a word, 1e-4 a number."""


PlainLoader.yaml_implicit_resolvers = {}
for tag, pattern, first in (("null", "~|null|", ["~", "n", ""]), ("bool", "true|false", list("tf")), ("int", "[-+]?[0-9]+", list("-+0123456789")),
                            ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", list("-+.0123456789"))):
    PlainLoader.add_implicit_resolver("tag:yaml.org,2002:" + tag, re.compile(f"^(?:{pattern})$"), first)


def read(text):
    return yaml.load(text, PlainLoader)


def without(text, steps):
    """A schema's text, laid out anew, as it would be if there were none of these steps, each of which it must have."""
    schema = json.loads(text)
    step = schema["definitions"]["step"]
    use = step["properties"]["use"]
    assert set(steps) <= set(use["enum"]), f"the schema lacks {sorted(set(steps) - set(use['enum']))}"
    kept = [pair for pair in zip(use["enum"], use["enumDescriptions"], strict=True) if pair[0] not in steps]
    use["enum"], use["enumDescriptions"] = (list(each) for each in zip(*kept))
    step["allOf"] = [rule for rule in step["allOf"] if rule["if"]["properties"]["use"]["const"] not in steps]
    return json.dumps(schema, indent=1)


def test_checked_in_is_the_one_that_the_steps_declare(folder):
    """Of all steps: a build that left some out lacks these and declares the others alike."""
    assert SCHEMA.exists(), "write it: plumb schema -o schemas"
    cure = "a declaration changed; write the schema again, with all optional libraries installed: plumb schema -o schemas"
    checked_in, declared, missing = SCHEMA.read_text(), plumb("schema").out, left_out()
    assert without(checked_in, missing) == without(declared, []), cure
    assert missing or checked_in == declared, cure


def test_of_a_build_that_left_steps_out_lacks_these_alone(folder):
    """So what the case above compares is enough."""
    program, modules, environment = installation(folder)
    gone = ["describe.esf", "write.trajectory"]
    for step in gone:
        (modules / f"{step}.so").unlink()
        (modules / f"{step}.json").unlink()
    text = plumb("schema").out
    assert without(plumb("schema", program=program, environment=environment).out, []) == without(text, gone) != without(text, gone[:1])


def test_is_written_into_a_folder_or_refused(folder):
    plumb("schema", "-o", folder)
    assert (folder / "pipeline.schema.json").read_text() == plumb("schema").out
    plumb("schema", "-o", folder)
    plumb("schema", "-o", folder / "new/deep")
    assert (folder / "new/deep/pipeline.schema.json").exists()
    plumb("schema", "-o", folder / "pipeline.schema.json", code=WRONG_INPUT).has("pipeline.schema.json", "cannot be written")
    (folder / "pipeline.schema.json").write_text("{}")
    plumb("schema", "-o", folder, code=WRONG_INPUT).has("is not a schema of Plumb")
    assert (folder / "pipeline.schema.json").read_text() == "{}"


def test_is_draft_07_and_has_every_step_in_its_enum(folder):
    schema = judge().schema
    assert schema["$schema"] == "http://json-schema.org/draft-07/schema#"
    step = schema["definitions"]["step"]
    assert step["properties"]["use"]["enum"] == step_names()
    assert sorted(rule["if"]["properties"]["use"]["const"] for rule in step["allOf"]) == step_names()


def test_is_named_by_the_first_line_of_every_pipeline(folder):
    for file in pipelines():
        first = file.read_text().splitlines()[0]
        found = re.fullmatch(r"# yaml-language-server: \$schema=(\S+)", first)
        assert found, f"{file}: the first line is no modeline: {first}"
        assert (file.parent / found[1]).resolve() == SCHEMA, f"{file}: the modeline names {found[1]}"


def test_accepts_every_pipeline_and_preset(folder):
    validator = judge()
    for file in pipelines():
        errors = [f"{list(e.absolute_path)}: {e.message}" for e in validator.iter_errors(read(file.read_text()))]
        assert not errors, f"{file}: {errors}"


def test_accepts_what_resolve_prints(folder):
    text = plumb("resolve", CASCADE, "--set", "input=.").out
    errors = [f"{list(e.absolute_path)}: {e.message}" for e in judge().iter_errors(read(text))]
    assert not errors, errors


# What is wrong, and the piece of tang2024.yaml that is exchanged to make it so.
MISTAKES = {
    "an unknown step": ("use: prune.kmeans", "use: prune.k_means"),
    "an unknown key": ("use: describe.esf,               from:", "use: describe.esf,               form:"),
    "an unknown parameter": ("with: {frames: 60}", "with: {frame: 60}"),
    "an unknown port": ("from: {frames: ranged, ranges: ranges.ranges}", "from: {frames: ranged, range: ranges.ranges}"),
    "an unknown unit": ("loss_to:   {type: length, default: 0.5 m", "loss_to:   {type: length, default: 0.5 ell"),
    "a length without a unit": ("voxel_size: {type: length, default: 0.3 m", "voxel_size: {type: length, default: 0.3"),
    "an angle for a length": ("default: 300 m", "default: 300 deg"),
    "a number that should be whole": ("{frames: 60}", "{frames: 6.5}"),
    "a number out of range": ("{frames: 60}", "{frames: 0}"),
    "an unknown choice": ("loss: geman_mcclure", "loss: german_mcclure"),
    "an unknown type of a parameter": ("input:     {type: path", "input:     {type: pth"),
    "another version of the language": ("plumb: 1", "plumb: 2"),
    "no steps": ("steps:\n  # 2.2", "stages:\n  # 2.2"),
    "a name that is none": ("  ranges:   {use", "  2ranges:   {use"),
    "a yes for a truth value": ("loss: geman_mcclure,", "loss: geman_mcclure, sequential_huber: yes,"),
    "an unknown key of a loop": ("if_exhausted: accept", "if_exhausted: accept\n      colour: red"),
    "until without a bound": ("falls_by_less_than: 2 %", "falls: 2 %"),
    "an unknown ending": ("if_exhausted: accept", "if_exhausted: shrug"),
    "input to a source": ("use: source.sequence,            with", "use: source.sequence, from: ranges, with"),
}


def test_and_the_command_refuse_the_same_mistakes(folder):
    validator = judge()
    text = CASCADE.read_text()
    missed = []
    for mistake, (good, bad) in MISTAKES.items():
        assert good in text, f"'{good}' is no longer in {CASCADE.name}; change the test"
        file = folder / "wrong.yaml"
        file.write_text(text.replace(good, bad, 1))
        said = plumb("check", file, "--set", "input=.", code=WRONG_INPUT)
        assert re.search(r"wrong\.yaml:\d+:\d+: ", said.err), said
        if validator.is_valid(read(file.read_text())):
            missed.append(mistake)
    assert not missed, f"valid under the schema: {missed}"


# Wrong for the command alone: a schema cannot follow names.
BEYOND_A_SCHEMA = {
    "a wire from a step that is not there": ("{frames: ranged, ranges: ranges.ranges}", "{frames: rangde, ranges: ranges.ranges}"),
    "a wire of another type": ("from: merged, with: {mean_k", "from: sequence.frames, with: {mean_k"),
    "a value from nowhere": ("voxel_size: $map_voxel_size", "voxel_size: $map_voxel_sise"),
    "a parameter that nothing uses": ("parameters:\n", "parameters:\n  spare: {type: number, default: 1}\n"),
    "rows of different lengths": ("max_correspondence_distance: [4 m, 2 m, 1 m]", "max_correspondence_distance: [4 m, 2 m, 1 m]\n        other: [1, 2]"),
    "a circle": ("use: segment.by_count,           from: sequence.trajectory", "use: segment.by_count, from: straight"),
}


def test_leaves_to_the_command_what_needs_names_followed(folder):
    text = CASCADE.read_text()
    for mistake, (good, bad) in BEYOND_A_SCHEMA.items():
        assert good in text, f"'{good}' is no longer in {CASCADE.name}; change the test"
        file = folder / "wrong.yaml"
        file.write_text(text.replace(good, bad, 1))
        said = plumb("check", file, "--set", "input=.", code=WRONG_INPUT)
        assert re.search(r"wrong\.yaml:\d+:\d+: ", said.err), f"{mistake}: {said}"
