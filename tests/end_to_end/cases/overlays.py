"""Presets and `--set` reach every parameter of every step of the shipped pipelines, however it gets its value there."""
import json

import yaml

from plumb_test import plumb, shipped_pipelines

INPUT = "somewhere"  # resolving reads no data


def pipelines():
    files = shipped_pipelines()
    assert len(files) >= 8, files
    return files


def resolved(pipeline, *options):
    return yaml.load(plumb("resolve", pipeline, "--set", f"input={INPUT}", *options).out, yaml.BaseLoader)


def steps_of(tree, path="", rows=()):
    """(path, step, rows of the repeats around it) of each step, through groups and repeats."""
    for name, node in tree["steps"].items():
        inner = f"{path}.{name}" if path else name
        if "use" in node:
            yield inner, node, dict(rows)
        else:
            yield from steps_of(node, inner, [*rows, *node.get("repeat", {}).get("passes", {}).items()])


def value_of(tree, rows, text):
    """What a step is given: of a parameter of the pipeline its value, of a row the first."""
    if not text.startswith("$"):
        return text
    row = rows.get(text[1:])
    if row is None:
        return tree["parameters"][text[1:]].get("default", "/somewhere")
    return row[0] if isinstance(row, list) else row


def given(tree):
    """{path of a step: {parameter: value}}."""
    return {path: {name: value_of(tree, rows, text) for name, text in step.get("with", {}).items()} for path, step, rows in steps_of(tree)}


def shown(tree, path, name):
    return next(step for at, step, _ in steps_of(tree) if at == path)["with"][name]


def optional():
    """{step: its parameters that may be none}."""
    names = {line.split()[0] for line in plumb("list").out.splitlines()}
    steps = (json.loads(plumb("inspect", name, "--json").out) for name in sorted(names))
    return {step["name"]: {p["name"] for p in step["parameters"] if p.get("may_be_none")} for step in steps}


def test_every_parameter_of_every_step_can_be_set_to_the_value_that_it_has(folder):
    for pipeline in pipelines():
        for path, values in given(resolved(pipeline)).items():
            if not values:
                continue
            sets = [word for name, value in values.items() for word in ("--set", f"{path}.{name}={value}")]
            after = resolved(pipeline, *sets)
            for name, value in values.items():
                assert shown(after, path, name) == value, (pipeline, path, name, value, shown(after, path, name))


def test_each_parameter_can_be_set_alone(folder):
    """Those that a row or a parameter of the pipeline feeds: what feeds them may be left without a use."""
    for pipeline in pipelines():
        tree = resolved(pipeline)
        values = given(tree)
        for path, step, _ in steps_of(tree):
            for name, text in step.get("with", {}).items():
                if text.startswith("$"):
                    after = resolved(pipeline, "--set", f"{path}.{name}={values[path][name]}")
                    assert shown(after, path, name) == values[path][name], (pipeline, path, name)


def test_every_optional_parameter_can_be_set_to_none(folder):
    may_be_none = optional()
    assert sum(map(len, may_be_none.values())) > 5, may_be_none
    for number, pipeline in enumerate(pipelines()):
        paths = [f"{path}.{name}" for path, step, _ in steps_of(resolved(pipeline)) for name in sorted(may_be_none[step["use"]])]
        preset = folder / f"{number}.yaml"
        preset.write_text(f"plumb: 1\nextends: {pipeline}\nset: {{{', '.join(f'{path}: none' for path in paths)}}}\n")
        for after in (resolved(pipeline, *[word for path in paths for word in ("--set", f"{path}=none")]), resolved(preset),
                      resolved(pipeline, "--preset", preset)):
            for path in paths:
                step, _, name = path.rpartition(".")
                assert shown(after, step, name) == "none", (pipeline, path)


def test_resolve_and_graph_need_no_input(folder):
    for pipeline in pipelines():
        plumb("resolve", pipeline).has("steps:")
        plumb("graph", pipeline).has("flowchart")
