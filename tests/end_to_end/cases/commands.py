"""Every command says what it promises, with exit codes that scripts can trust."""
import json
import os
import re

from plumb_test import (BUILD, CAR, CASCADE, PLUMB, WRONG_COMMAND_LINE, WRONG_INPUT, files_of, plumb, refused, sequence,
                        step_names)

COMMANDS = ["run", "check", "resolve", "graph", "migrate", "list", "inspect", "doctor", "schema", "simulate", "evaluate", "compare", "cache"]
INPUT = ["--set", "input=."]  # checking reads no data, but what it names must be there


def test_help_names_every_command_and_the_exit_codes(folder):
    plumb("--help").has(*COMMANDS, "Exit: 0", "plumb simulate city_loop")
    assert re.fullmatch(r"\d+\.\d+\.\d+\n", plumb("--version").out)


def test_each_command_has_help_with_its_options(folder):
    expected = {"run": ["--preset", "--set", "--output", "--threads", "--quiet", "--times"], "check": ["file:line:column", "--plan"],
                "graph": ["mermaid", "dot"], "migrate": ["--output", "Comments"], "list": ["--licences"], "inspect": ["--json"], "schema": ["--output"],
                "simulate": ["--frames", "--drift", "--seed", "city_loop"], "evaluate": ["--clouds", "--json", "--truth"],
                "compare": ["--variant", "--input", "--metric", "--time", "--json", "--cache-dir"], "cache": ["verify", "prune", "--cache-dir", "Example"]}
    for command in COMMANDS:
        plumb(command, "--help").has("Usage: plumb " + command, *expected.get(command, []))


def test_a_wrong_command_line_exits_with_2(folder):
    for arguments in ([], ["fly"], ["run"], ["run", CASCADE], ["check"], ["check", CASCADE, "--fast"], ["inspect"],
                      ["graph", CASCADE, "--format", "png"], ["evaluate", "a"], ["simulate"], ["cache", "fly"],
                      ["run", CASCADE, "-o", folder / "out", "--threads", "many"], ["check", CASCADE, "--set", "voxel_size"],
                      ["check", CASCADE, "--set", "=1m"], ["run", CASCADE, "-o", folder / "out", "--memory", "2 apples"],
                      ["run", folder / "none.yaml", "-o", folder / "out", "--explain", "--no-cache"]):
        said = plumb(*arguments, code=WRONG_COMMAND_LINE)
        refused(said)
        assert not said.out, said
    assert not (folder / "out").exists()


def test_a_misspelt_command_or_option_gets_the_nearest(folder):
    run = ["run", CASCADE, *INPUT]
    for arguments, words in ((["rnu", CASCADE, "-o", folder / "out"], "'plumb' has no command 'rnu'; did you mean 'run'?"),
                             (["simulte", "city_loop", "-o", folder / "out"], "did you mean 'simulate'?"),
                             (["fly"], "known: run, check, resolve"),
                             ([], "a command is missing; known: run, check, resolve"),
                             (["cache", "verfy"], "'plumb cache' has no command 'verfy'; did you mean 'verify'?"),
                             ([*run, "--ouput", folder / "out"], "'plumb run' has no option '--ouput'; did you mean '--output'?"),
                             ([*run, "-o", folder / "out", "--thread=2"], "has no option '--thread'; did you mean '--threads'?"),
                             ([*run, "-o", folder / "out", "--plugin-pth", folder], "did you mean '--plugin-path'?"),
                             ([*run, "-o", folder / "out", "--stores", folder], "has no option '--stores'; `plumb run --help`"),  # --store is a former name
                             (["check", CASCADE, "--fast"], "'plumb check' has no option '--fast'; `plumb check --help` says what there is"),
                             ([*INPUT, "check", CASCADE], "'--set' is an option of 'plumb check'"),
                             (["check", CASCADE, *INPUT, "voxel_size=1m"], "'voxel_size=1m' is one word more than 'plumb check' takes")):
        refused(plumb(*arguments, code=WRONG_COMMAND_LINE), words, "--help` says what there is")
    assert not (folder / "out").exists()


def test_the_plugin_path_serves_before_and_behind_the_command(folder):
    folder.chmod(0o755)
    (folder / "filter.torn.so").write_text("not a module")
    (folder / "filter.torn.so").chmod(0o644)
    for arguments in (["--plugin-path", folder, "list"], ["list", "--plugin-path", folder], ["list", f"--plugin-path={folder}"]):
        plumb(*arguments).has("refused: " + str(folder / "filter.torn.so"))
    plumb("check", "--plugin-path", folder, CASCADE, *INPUT).has("good")
    plumb("check", CASCADE, "--plugin-path", folder, *INPUT, "--plugin-path", folder).has("good")
    plumb("run", CASCADE, *INPUT, "-o", folder / "out", "--untrusted", "--plugin-path", folder, code=WRONG_COMMAND_LINE).has("--plugin-path")
    assert plumb("check", "--version").out == plumb("--version").out


def test_check_of_a_good_pipeline_shows_the_passes_of_each_loop(folder):
    plumb("check", CASCADE, *INPUT).has("good", "max_correspondence_distance", "4 m", "1.5 m")


def plan_of(*arguments):
    """The rows of `check --plan` by step or repeat, each as its columns, in their order; and what was said."""
    said = plumb("check", "--plan", *arguments, *INPUT).has("good")
    table = said.out[said.out.index("group "):said.out.index("\nresults: ")].splitlines()
    rows = [re.split(r" {2,}", line) for line in table]
    assert rows[0] == ["group", "step", "one call sees", "results", "until", "why"], said
    return {row[1]: row for row in rows[1:]}, said


def test_check_shows_the_plan_of_a_run_step_by_step(folder):
    rows, said = plan_of(CASCADE)
    steps = [row for row in rows.values() if len(row) > 2]
    assert len(steps) == int(re.search(r"good, (\d+) steps", said.out)[1]) and all(len(row) == 6 for row in steps), said
    for row in (["2", "ranged", "one frame of sequence", "passing", "map", "frames are transient, made for each of 2 inputs"],
                ["3", "merged", "one segment of ranges", "passing", "segments", "large, and only denoised takes them"],
                ["6", "segments", "one segment of ranges", "kept", "match_rmse", "large, but 9 inputs take them"],
                ["coarse/2", "coarse.near", "one edge of neighbours", "remembered", "coarse", "in a repeat"],
                ["14", "drift.solved", "whole collections", "remembered", "metrics", "solve.pose_graph occurs 3 times"]):
        assert rows[row[1]] == row, said
    assert rows["coarse: 3 to 4 passes"][0] == "16" and rows["map"][4] == "end of run", said
    order = list(rows)
    assert order.index("drift.solved") < order.index("coarse: 3 to 4 passes") < order.index("coarse.matches") < order.index("match_rmse"), said
    said.has("\n  7: esf, fpfh, drift.overlapping\n")
    assert said.out.count("memory: known after a first run") == 1, said
    assert "transient" not in plumb("check", CASCADE, *INPUT).out


def test_the_plan_follows_the_pipeline(folder):
    file = folder / "changed.yaml"
    file.write_text(f"plumb: 1\nname: changed\nextends: {CASCADE}\nremove: [map, denoised]\nreplace:\n"
                    "  voxels: {use: filter.voxel_grid, from: merged, with: {voxel_size: $voxel_size}}\n  esf: {use: describe.esf, from: merged}\n")
    rows, said = plan_of(file)
    assert rows["ranged"][3:] == ["passing", "merged", "frames are transient"], said
    assert rows["merged"][3:] == ["kept", "esf", "large, but 2 inputs take them"], said
    assert rows["voxels"][3:] == ["passing", "segments", "large, and only segments takes them"], said


def test_check_of_a_wrong_pipeline_names_the_place_and_the_cure(folder):
    file = folder / "wrong.yaml"
    file.write_text(CASCADE.read_text().replace("use: prune.kmeans", "use: prune.kmean", 1))
    line = next(n for n, text in enumerate(file.read_text().splitlines(), 1) if "prune.kmean," in text)
    plumb("check", file, *INPUT, code=WRONG_INPUT).has(f"wrong.yaml:{line}:", "Did you mean 'prune.kmeans'?")
    plumb("check", folder / "none.yaml", code=WRONG_INPUT).has("none.yaml")
    street = sequence("street")
    said = plumb("check", street, code=WRONG_INPUT).has(f"'{street}' is a folder, not a pipeline", f"behind --set, as in --set input={street}")
    assert "scene.yaml" not in said.err, said


def test_check_says_that_the_input_is_missing(folder):
    plumb("check", CASCADE, code=WRONG_INPUT).has("'input'")


def test_resolve_shows_each_value_with_its_origin(folder):
    said = plumb("resolve", CASCADE, "--preset", CAR, *INPUT, "--set", "coarse.max_correspondence_distance=3 m,1 m")
    said.has("[3 m, 1 m]", "--set", "car_64line.yaml", "default of prune.kmeans", "segment.by_distance")


def test_a_resolved_pipeline_is_a_pipeline_that_resolves_to_itself(folder):
    file = folder / "resolved.yaml"
    values = lambda text: [line.split("  #")[0].rstrip() for line in text.splitlines()]
    first = plumb("resolve", CASCADE, "--preset", CAR, *INPUT).out
    file.write_text(first)
    plumb("check", file).has("good")
    assert values(plumb("resolve", file).out) == values(first)


def test_graph_draws_every_step_in_both_formats(folder):
    mermaid, dot = (plumb("graph", CASCADE, *INPUT, "--format", form).out for form in ("mermaid", "dot"))
    assert mermaid.startswith(("flowchart", "graph", "---")) and dot.startswith("digraph") and dot.rstrip().endswith("}")
    for step in set(re.findall(r"use: ([a-z0-9_.]+)", CASCADE.read_text())):
        assert step in mermaid and step in dot, step
    assert dot.count("{") == dot.count("}")


def installed():
    """The names of the steps in each module of the build, from its manifest."""
    folder = BUILD / "lib/plumb"
    modules = {f.stem: [step["name"] for step in json.loads(f.read_text())["steps"]] for f in folder.glob("*.json")}
    assert sorted(modules) == sorted(f.name[:-3] for f in folder.glob("*.so"))
    return modules


def test_list_and_inspect_show_every_installed_step(folder):
    names, modules = step_names(), installed()
    assert sorted(names) == sorted(name for steps in modules.values() for name in steps)
    assert all(module in steps for module, steps in modules.items()), modules  # a module is named after its step, or its first
    for name in names:
        text = plumb("inspect", name).out
        declared = json.loads(plumb("inspect", name, "--json").out)
        assert text.startswith(name) and ", a E" not in text.splitlines()[0] and "Inputs" in text and "Outputs" in text and "Parameters" in text
        for parameter in declared["parameters"]:
            assert parameter["doc"] and f"  {parameter['name']}: " in text, (name, parameter["name"])
        for port in declared["inputs"] + declared["outputs"]:
            assert port["doc"], (name, port["name"])
        assert declared["summary"].endswith("."), name


def test_inspect_of_an_unknown_step_offers_the_nearest(folder):
    refused(plumb("inspect", "prune.kmens", code=WRONG_INPUT), "prune.kmens", "Did you mean 'prune.kmeans'?", "plumb list")


def test_doctor_finds_all_modules_and_every_one_loads(folder):
    said = plumb("doctor")
    modules = len(installed())
    said.has(f"{len(step_names())} steps in {modules} modules; {modules} load", "ABI: plumb-sdk", str((BUILD / "lib/plumb").resolve()))
    assert "refused" not in said.out


def test_doctor_refuses_a_folder_that_others_may_write_into(folder):
    loose = folder / "loose"
    loose.mkdir()
    loose.chmod(0o777)
    plumb("--plugin-path", loose, "doctor", code=WRONG_INPUT).has("refused", str(loose), "may be written by everybody", "chmod go-w")
    plumb("doctor", environment={"PLUMB_PLUGIN_PATH": str(folder / "none")}, code=WRONG_INPUT).has("there is no such folder")


def test_doctor_refuses_a_file_that_is_no_module(folder):
    folder.chmod(0o755)
    (folder / "filter.torn.so").write_text("not a module")
    (folder / "filter.torn.so").chmod(0o644)
    plumb("--plugin-path", folder, "doctor", code=WRONG_INPUT).has("filter.torn.so", "manifest")
    (folder / "filter.torn.json").write_text('{"plumb_manifest": ')
    (folder / "filter.torn.json").chmod(0o644)
    plumb("--plugin-path", folder, "doctor", code=WRONG_INPUT).has("refused", "filter.torn")
    plumb("--plugin-path", folder, "list").has("refused: " + str(folder / "filter.torn.so"), "not a manifest that can be used")


def test_simulate_writes_a_sequence_and_the_scene_that_repeats_it(folder):
    arguments = ["--frames", 6, "--lines", 4, "--columns", 64, "--drift", 0.5]
    plumb("simulate", "blocks", *arguments, "--seed", 7, "-o", folder / "a").has("6 frames")
    assert sorted(p.name for p in (folder / "a").iterdir()) == ["frames", "odometry.tum", "scene.yaml", "truth.tum"]
    assert len(list((folder / "a/frames").glob("*.pcd"))) == 6
    plumb("simulate", folder / "a/scene.yaml", "-o", folder / "b")
    assert files_of(folder / "a") == files_of(folder / "b")
    plumb("simulate", "blocks", *arguments, "--seed", 8, "-o", folder / "c")
    assert files_of(folder / "a")["odometry.tum"] != files_of(folder / "c")["odometry.tum"]


def test_simulate_makes_the_same_bytes_with_one_and_with_two_threads(folder):
    for threads in (1, 2):
        plumb("simulate", "figure_eight", "--frames", 8, "--lines", 8, "--columns", 128, "--threads", threads, "-o", folder / str(threads))
    assert files_of(folder / "1") == files_of(folder / "2")


def test_simulate_refuses_what_it_cannot_make(folder):
    out = folder / "out"
    few = ["--frames", 4, "--lines", 4, "--columns", 32, "-o", out]
    for arguments, code in ((["moon"], WRONG_INPUT), (["--path", folder / "none.tum"], WRONG_INPUT), (["blocks", "--noise", "2deg"], WRONG_COMMAND_LINE),
                            (["blocks", "--seed", "x"], WRONG_COMMAND_LINE), (["rooms"], WRONG_COMMAND_LINE)):
        said = plumb("simulate", *arguments, *few, code=code)
        assert len(said.err.strip()) > 30, said
        assert not out.exists()
    out.mkdir()
    (out / "thesis.tex").write_text("mine")
    plumb("simulate", "blocks", *few, code=WRONG_INPUT).has("holds something that the simulator did not make", "another folder")
    assert files_of(out) == {"thesis.tex": b"mine"}


def test_evaluate_prints_a_table_and_refuses_what_is_missing(folder):
    street = sequence("street")
    plumb("evaluate", street, street / "truth.tum", "--clouds").has("before", "after", "90/90", "ATE", "ghosting")
    refused(plumb("evaluate", street, folder / "none.tum", code=WRONG_INPUT), "none.tum")
    refused(plumb("evaluate", folder, street / "truth.tum", code=WRONG_INPUT), "has no truth.tum", "--truth")


def test_the_command_works_from_any_folder_and_with_relative_paths(folder):
    street = os.path.relpath(sequence("street"), folder)
    plumb("check", os.path.relpath(CASCADE, folder), "--set", f"input={street}", cwd=folder).has("good")
    assert plumb("evaluate", street, f"{street}/odometry.tum", "--json", cwd=folder, program=PLUMB).out.startswith("{")
