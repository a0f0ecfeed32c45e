"""The order of the cascade's steps and its thresholds are in YAML alone."""
import re

from judge import Trajectory
from plumb_test import CASCADE, SOURCE, cascade, plumb, score, sequence, step_names

SIX = ["--set", "ranges.frames=6"]


def improved(street, out, factor=3):
    assert len(Trajectory.read(out / "trajectory.tum")) == 90
    result = score(street, out / "trajectory.tum")
    assert result["after"]["ate_rmse"] * factor < result["before"]["ate_rmse"], result


def run(folder, *options, pipeline=CASCADE):
    """Runs a changed cascade on the street. Returns what was said, with the passes."""
    street = sequence("street")
    said = plumb("run", pipeline, "--set", f"input={street}", *SIX, *options, "-o", folder / "out")
    improved(street, folder / "out")
    return said


def passes(said, loop):
    return int(re.search(rf"^{loop}: (\d+) pass", said.out, re.M)[1])


def overlay(folder, text):
    file = folder / "changed.yaml"
    file.write_text(f"plumb: 1\nname: changed\nextends: {CASCADE}\n{text}")
    return file


def test_a_row_is_changed_by_set(folder):
    said = plumb("check", CASCADE, "--set", "input=.", "--set", "coarse.max_correspondence_distance=3 m,2.5 m,2 m,1.5 m")
    said.has("3 m", "2.5 m", "2 m", "1.5 m")
    said = run(folder, "--set", "coarse.max_correspondence_distance=3 m,2.5 m,2 m,1.5 m", "--set", "fine.max_correspondence_distance=1 m,0.5 m")
    assert 3 <= passes(said, "coarse") <= 4 and passes(said, "fine") >= 5


def test_the_number_of_passes_is_changed_by_an_overlay(folder):
    file = overlay(folder, """replace:
  coarse:
    repeat:
      passes: {max_correspondence_distance: [2 m, 1 m]}
      carry: {poses: solved}
    start: {poses: drift.solved}
    steps:
      matches: {use: match.fpfh_mutual, from: {edges: neighbours, features: fpfh}}
      near:    {use: prune.distance,    from: {matches: matches, poses: poses}, with: {max_correspondence_distance: $max_correspondence_distance}}
      kept:    {use: prune.kmeans,      from: {matches: near, poses: poses}}
      solved:  {use: solve.pose_graph,  from: {matches: kept, poses: poses}}
""")
    assert passes(run(folder, pipeline=file), "coarse") == 2


def test_a_preset_sets_a_row_and_a_threshold_and_changes_the_result(folder):
    street = sequence("street")
    file = overlay(folder, "set:\n  coarse.max_correspondence_distance: [5 m, 3 m, 2 m]\n  coarse.kept.min_pairs: 8\n  ranges.frames: 6\n")
    cascade(street, folder / "a", "--preset", file)
    cascade(street, folder / "b", *SIX)
    improved(street, folder / "a")
    assert (folder / "a/trajectory.tum").read_bytes() != (folder / "b/trajectory.tum").read_bytes()


def test_a_step_is_dropped(folder):
    """Without the test for points at borders: what it gave is taken from the step before."""
    run(folder, pipeline=overlay(folder, """remove: [drift.inner, coarse.inner]
replace:
  drift.kept:  {use: prune.kmeans, from: {matches: near, poses: ranges.poses}}
  coarse.kept: {use: prune.kmeans, from: {matches: near, poses: poses}}
"""))


def test_a_whole_stage_is_dropped(folder):
    fine = re.search(r"^  fine:.*?(?=^  # Evaluation of each stage)", CASCADE.read_text(), re.M | re.S)[0]
    said = run(folder, pipeline=overlay(folder, f"""remove: [coarse, after_drift, after_coarse]
replace:
{fine.replace('coarse.solved', 'drift.solved')}
  match_rmse:
    use: measure.match_rmse
    from: {{edges: neighbours, segments: segments, poses: {{before: ranges.poses, drift: drift.solved, fine: fine.solved}}}}
  error: {{use: measure.trajectory, from: {{trajectories: {{before: sequence.trajectory, fine: straight}}}}, with: {{truth: $truth}}}}
  metrics:
    use: write.metrics
    from: {{metrics: {{drift: drift.solved.metrics, fine: fine.solved.metrics, match_rmse: match_rmse}}}}
"""))
    assert "coarse" not in said.out + said.err


def test_two_steps_change_places(folder):
    """Points at borders are dropped before far pairs."""
    run(folder, pipeline=overlay(folder, """replace:
  coarse.inner: {use: prune.edge_points, from: matches}
  coarse.near:  {use: prune.distance, from: {matches: inner, poses: poses}, with: {max_correspondence_distance: $max_correspondence_distance}}
  coarse.kept:  {use: prune.kmeans, from: {matches: near, poses: poses}}
"""))


def test_kmeans_is_swapped_for_ransac(folder):
    said = run(folder, pipeline=overlay(folder, """replace:
  drift.kept:  {use: prune.ransac, from: inner}
  coarse.kept: {use: prune.ransac, from: inner}
"""))
    said.has("coarse.kept")
    assert "prune.kmeans" not in (folder / "out/run.lock.yaml").read_text().split("pipeline:")[0]
    assert "prune.ransac" in (folder / "out/run.lock.yaml").read_text().split("pipeline:")[0]


def code_of(file):
    """A C++ file without comments and without the examples that --help shows."""
    text = re.sub(r"//[^\n]*", "", re.sub(r"/\*.*?\*/", "", file.read_text(), flags=re.S))
    text = re.sub(r"footer\(.*?\);", "", text, flags=re.S)
    return re.sub(r"add_option\(.*?\)\s*;", "", text, flags=re.S)


def code_files():
    files = [f for part in ("framework", "tools/command", "tools/manifest") for f in (SOURCE / part).rglob("*.[ch]pp")]
    files = [f for f in files if not re.search(r"(_test\.cpp|test_steps\.hpp|testing\.hpp)$", f.name)]
    assert len(files) > 50
    return files


def test_no_c_plus_plus_outside_the_plugins_names_a_step(folder):
    names = step_names()
    assert len(names) >= 30
    pattern = re.compile("|".join(rf"\b{re.escape(name)}\b" for name in names))
    found = [f"{file.relative_to(SOURCE)}: {match[0]}" for file in code_files() for match in pattern.finditer(code_of(file))]
    assert not found, found


def test_no_c_plus_plus_outside_the_plugins_names_a_stage_or_parameter_of_the_cascade(folder):
    """Paths as `coarse.max_correspondence_distance`, and the names of the pipeline's parameters that are no words of every day."""
    text = CASCADE.read_text()
    paths = {f"{stage}.{name}" for stage in ("drift", "coarse", "fine") for name in re.findall(r"^ +([a-z]\w*):", text, re.M)}
    odd = {name for name in re.findall(r"^  (\w+): +\{type:", text, re.M) if "_" in name}
    assert len(odd) > 5 and "coarse.max_correspondence_distance" in paths
    pattern = re.compile("|".join(rf"[\"$ ]{re.escape(name)}\b" for name in paths | odd))
    found = [f"{file.relative_to(SOURCE)}: {match[0]}" for file in code_files() for match in pattern.finditer(code_of(file))]
    assert not found, found


def test_no_build_file_outside_the_plugins_names_a_step(folder):
    words = [w for name in step_names() for w in (name, name.replace(".", "_"), name.replace(".", "/"))]
    for file in (SOURCE / "CMakeLists.txt", SOURCE / "framework/CMakeLists.txt", SOURCE / "tools/CMakeLists.txt",
                 SOURCE / "framework/PlumbStep.cmake"):
        text = re.sub(r"#[^\n]*", "", file.read_text())
        assert not [w for w in words if re.search(rf"\b{re.escape(w)}\b", text)], file


def test_no_plugin_includes_another(folder):
    for file in (SOURCE / "plugins").rglob("*.[ch]pp"):
        for name in re.findall(r'#include "([^"]+)"', file.read_text()):
            own = (file.parent / name).exists() and ".." not in name
            allowed = own or name.startswith(("plumb/", "shared/")) or (file.name.endswith("_test.cpp") and ".." not in name)
            assert allowed, f"{file.relative_to(SOURCE)} includes {name}"
            assert not re.match(r"plumb/(pipeline|engine|slam/report)/", name) or file.name.endswith("_test.cpp"), f"{file} sees {name}"
