#!/usr/bin/env python3
"""What an experiment's variants have in common is made once: counted from the events of `plumb compare EXPERIMENT --events FILE`.

    python3 tools/made_once.py EXPERIMENT EVENTS.jsonl... [--plumb FILE]

Give the events of all runs over one cache in their order, also of those that were killed. A step is common to a variant where neither it nor anything that it
draws on differs from the pipeline's, by `plumb resolve`; of each result that is kept (`plumb check --plan`) it is counted how often it was made: those of
common steps over all variants together. Sources, and what only passes through, are made anew whenever they are asked for and are left out.
Exit 1 where a result was made twice though the run that made it first came to its end. What a killed run made and had not kept yet is made again; it is counted.
"""
import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[1]


class Plain(yaml.BaseDumper):
    """Writes texts without quotes, in which a '$' would stand for itself."""

    def ignore_aliases(self, data):
        return True


Plain.add_representer(str, lambda dumper, text: dumper.represent_scalar("tag:yaml.org,2002:str", text))
Plain.add_representer(list, lambda dumper, items: dumper.represent_sequence("tag:yaml.org,2002:seq", items))
Plain.add_representer(dict, lambda dumper, entries: dumper.represent_mapping("tag:yaml.org,2002:map", entries))


def said(options, *words):
    return subprocess.run([str(options.plumb), *map(str, words)], check=True, stdout=subprocess.PIPE, text=True).stdout


def texts_in(value):
    if isinstance(value, str):
        return [value]
    return [text for each in (value.values() if isinstance(value, dict) else value) for text in texts_in(each)]


class Pipeline:
    """The steps of a resolved pipeline: what each is, which others it draws on, and which keep their results."""

    def __init__(self, options, file):
        self.tree = yaml.load(said(options, "resolve", file, "--set", "input=."), yaml.BaseLoader)
        self.name = self.tree["name"]
        self.what, self.wires, self.rows = {}, {}, {}  # by path, also of what repeats carry
        self.add(self.tree, "")
        self.inputs = {path: {self.source_of(name, scope) for name, scope in wires} - {None} for path, wires in self.wires.items()}
        plan = said(options, "check", file, "--set", "input=.", "--plan").splitlines()
        rows = [re.split(r" {2,}", line.strip()) for line in plan]  # group, step, what a call sees, results, until, why
        self.kept = {row[1] for row in rows if len(row) > 3 and row[3] in ("kept", "remembered") and not self.what[row[1]][0].startswith("source.")}

    def add(self, tree, scope):
        for name, node in tree["steps"].items():
            path = f"{scope}.{name}".lstrip(".")
            if "use" in node:
                given = re.sub(r"\$(\w+)", lambda found: self.value_of(found[1], scope), json.dumps(node.get("with", {})))
                self.what[path] = (node["use"], given, json.dumps(node.get("from", "")))
                self.wires[path] = [(text, scope) for text in texts_in(node.get("from", ""))]
                continue
            repeat = node.get("repeat", {})
            self.rows[path] = repeat.get("passes", {})
            for carried, solved in repeat.get("carry", {}).items():
                self.what[f"{path}.{carried}"] = ("carried",)
                self.wires[f"{path}.{carried}"] = [(solved, path), (node["start"][carried], scope)]
            self.add(node, path)

    def value_of(self, name, scope):
        """What a `$name` stands for."""
        while scope:
            if name in self.rows.get(scope, {}):
                return str(self.rows[scope][name])
            scope = scope.rpartition(".")[0]
        return str(self.tree["parameters"].get(name, {}).get("default", f"${name}"))

    def source_of(self, name, scope):
        """The path that a wire comes from: of the innermost scope, without the name of the output."""
        while True:
            parts = name.split(".")
            for count in range(len(parts), 0, -1):
                path = ".".join([*filter(None, [scope]), *parts[:count]])
                if path in self.what:
                    return path
            if not scope:
                return None
            scope = scope.rpartition(".")[0]

    def common_with(self, other):
        changed = {path for path, what in self.what.items() if other.what.get(path) != what}
        while more := {path for path, inputs in self.inputs.items() if path not in changed and inputs & changed}:
            changed |= more
        return set(self.what) - changed


def pipelines_of(options):
    """That of the experiment, and those of its variants by their names."""
    experiment = yaml.load(options.experiment.read_text(), yaml.BaseLoader)
    base = (options.experiment.resolve().parent / experiment["pipeline"]).resolve()
    reference = Pipeline(options, base)
    found = {reference.name: reference}
    with tempfile.TemporaryDirectory() as folder:
        for name, edits in experiment["variants"].items():
            if not isinstance(edits, dict) or "file" in edits:
                sys.exit(f"variant {name}: only variants whose edits stand in the experiment can be looked at")
            file = Path(folder) / f"{name}.yaml"
            file.write_text(yaml.dump({"plumb": "1", "name": name, "extends": str(base), **edits}, Dumper=Plain, sort_keys=False, width=1000))
            found[name] = Pipeline(options, file)
    return reference, found


def events_in(file):
    """All but a last line that is torn."""
    with file.open(errors="replace") as lines:
        for line in lines:
            try:
                yield json.loads(line)
            except json.JSONDecodeError:
                return


class Makers:
    """Which runs made each result."""

    def __init__(self, pipelines, common):
        self.pipelines, self.common = pipelines, common
        self.runs, self.inputs, self.ended = {}, set(), []

    def read(self, file):
        variant = name = ""
        for event in events_in(file):
            if event["event"] == "run_begins":
                title = event["sentence"]
                variant = max((each for each in self.pipelines if title.startswith(f"{each} on ")), key=len)
                name = title[len(variant) + len(" on "):]
                self.inputs.add(name)
                self.ended.append(False)
            elif event["event"] == "run_ends":
                self.ended[-1] = True
            elif event["event"] == "item" and not event["reused"] and event["step"] in self.pipelines[variant].kept:
                step = sys.intern(event["step"])
                of = None if step in self.common[variant] else variant
                key = (name, of, step, event.get("pass", -1), sys.intern(event.get("item", "")))
                self.runs.setdefault(key, []).append(len(self.ended) - 1)

    def of_steps(self, steps):
        return [runs for key, runs in self.runs.items() if key[1] is None and key[2] in steps]

    def made_again(self, ended):
        """The keys of what was made more than once, where a run that made it before came to its end, or where none did."""
        return [key for key, runs in self.runs.items() if len(runs) > 1 and any(self.ended[run] for run in runs[:-1]) == ended]


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("experiment", type=Path, metavar="EXPERIMENT")
    arguments.add_argument("events", type=Path, nargs="+", metavar="EVENTS.jsonl")
    arguments.add_argument("--plumb", type=Path, default=ROOT / "build/bin/plumb")
    options = arguments.parse_args()
    reference, pipelines = pipelines_of(options)
    common = {name: pipeline.common_with(reference) for name, pipeline in pipelines.items()}
    makers = Makers(pipelines, common)
    for file in options.events:
        makers.read(file)

    of_all = set.intersection(*common.values()) & reference.kept
    shared, every = makers.of_steps(of_all), list(makers.runs.values())
    twice = makers.made_again(True)
    print(f"{len(pipelines)} variants on {len(makers.inputs)} inputs, in {len(makers.ended)} runs of which {makers.ended.count(False)} were cut off")
    print(f"common to all variants: {len(of_all)} of {len(reference.kept)} steps that keep their results: {', '.join(sorted(of_all))}")
    print(f"their results: {len(shared)}, made {sum(map(len, shared))} times")
    print(f"all results: {len(every)}, made {sum(map(len, every))} times; again after a run was cut off: {len(makers.made_again(False))}")
    print("\n".join([*(f"twice: {step} {item} of {name}" for name, _, step, _, item in twice[:20]), f"{len(twice)} made twice"]))
    return 1 if twice else 0


if __name__ == "__main__":
    sys.exit(main())
