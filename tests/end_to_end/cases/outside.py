"""Two modules that are built outside the tree, from the core's SDK alone: one defines value types and item kinds and fills them, the other takes them."""
import shutil
import subprocess
from functools import cache

from plumb_test import BUILD, HERE, SOURCE, WRONG_INPUT, files_of, plumb

PIPELINE = """plumb: 1
steps:
  row: {use: forest.plant, with: {trees: 5, spacing: 3 m}}
  grown: {use: forest.grow, from: row.trees, with: {by: 0.5 m}}
  gaps: {use: forest.measure, from: {pairs: row.neighbours, trees: grown}}
  tally: {use: forest.tally, from: {trees: grown, gaps: gaps}}
"""
HEIGHTS_AND_GAPS = b"17.5 12 4\n"  # 1.5 + 2.5 + 3.5 + 4.5 + 5.5 m; four gaps of 3 m


def build(folder, names=("plant", "tally"), change=lambda text: text):
    """Modules in folder/modules, compiled as somebody would who has the headers and the library."""
    sources, modules = folder / "sources", folder / "modules"
    shutil.copytree(HERE / "outside", sources, dirs_exist_ok=True)
    for source in sources.iterdir():
        source.write_text(change(source.read_text()))
    modules.mkdir(mode=0o755, exist_ok=True)
    for name in names:
        module = modules / f"forest.{name}.so"
        subprocess.run(["c++", "-std=c++20", "-O1", "-fPIC", "-shared", "-fvisibility=hidden", f"-I{SOURCE / 'framework'}", str(sources / f"{name}.cpp"),
                        f"-L{BUILD / 'lib'}", "-lplumb", f"-Wl,-rpath,{BUILD / 'lib'}", "-Wl,--no-undefined", "-o", str(module)], check=True)
        module.chmod(0o755)
        manifest = module.with_suffix(".json")
        subprocess.run([str(BUILD / "bin/plumb_manifest"), str(module), str(manifest)], check=True, stdout=subprocess.DEVNULL)
        manifest.chmod(0o644)
    return modules


@cache
def libraries_of(module):
    return subprocess.run(["ldd", str(module)], capture_output=True, text=True, check=True).stdout


def test_types_and_kinds_of_others_go_the_whole_way(folder):
    modules = build(folder)
    assert "plumb_slam" not in libraries_of(modules / "forest.plant.so")
    pipeline, store = folder / "forest.yaml", folder / "store"
    pipeline.write_text(PIPELINE)
    here = ["--plugin-path", modules]
    plumb(*here, "check", pipeline).has("good")
    first = plumb(*here, "run", pipeline, "--cache-dir", store, "-o", folder / "first")
    assert (folder / "first/forest.txt").read_bytes() == HEIGHTS_AND_GAPS
    first.has("5 trees grown", "5 trees planted")

    second = plumb(*here, "run", pipeline, "--cache-dir", store, "--explain", "-o", folder / "second")
    second.has("grown: reused, all 5", "gaps: reused, all 4", "tally: reused", "5 trees grown")
    assert files_of(folder / "second") == files_of(folder / "first")
    changed = plumb(*here, "run", pipeline, "--set", "grown.by=1 m", "--cache-dir", store, "--explain", "-o", folder / "third")
    changed.has("row: reused", "grown: made, all 5: by was 0.5 m, is 1 m")
    assert (folder / "third/forest.txt").read_bytes() == b"20 12 4\n"

    for executor in ("local", "process"):
        plumb(*here, "run", pipeline, "--cache-dir", folder / executor, "--executor", executor, "-o", folder / f"by_{executor}")
        assert (folder / f"by_{executor}/forest.txt").read_bytes() == HEIGHTS_AND_GAPS
    plumb("cache", "verify", "--cache-dir", store)  # without the modules that know the types
    shutil.rmtree(folder / "third")
    plumb(*here, "run", pipeline, "--set", "grown.by=1 m", "--cache-dir", store, "--explain", "-o", folder / "third").has("grown: reused, all 5")


def test_they_are_shown_like_any_other(folder):
    here = ["--plugin-path", build(folder)]
    plumb(*here, "inspect", "forest.measure").has("forest.Pairs (says which pairs there are)", "forest.Tree, one per tree (of both ends)", "forest.Gap, one per pair")
    plumb(*here, "inspect", "forest.grow").has("a TreeStep")
    plumb(*here, "list").has("forest.plant")
    plumb(*here, "schema", "-o", folder / "schemas")
    assert "forest.plant" in (folder / "schemas/pipeline.schema.json").read_text()


def test_wires_of_them_are_checked(folder):
    here = ["--plugin-path", build(folder)]
    pipeline = folder / "forest.yaml"
    pipeline.write_text(PIPELINE.replace("from: row.trees", "from: row.neighbours"))
    plumb(*here, "check", pipeline, code=WRONG_INPUT).has("forest.yaml:4:", "gives forest.Pairs", "forest.Tree, one per tree")
    pipeline.write_text(PIPELINE.replace("trees: grown}}\n  tally", "trees: gaps}}\n  tally"))
    plumb(*here, "check", pipeline, code=WRONG_INPUT).has("wants forest.Tree, one per tree")


def test_modules_that_mean_another_type_by_one_name_are_refused(folder):
    """The second one compiled with another header: another version, another layout, another kind."""
    pipeline = folder / "forest.yaml"
    pipeline.write_text(PIPELINE)
    for change, told in ((lambda text: text.replace('"forest.Tree";\n  static constexpr int version = 1', '"forest.Tree";\n  static constexpr int version = 2'), "its version is 1 there and 2 here"),
                         (lambda text: text.replace("double place = 0, height = 0;", "double place = 0, height = 0, girth = 0;"), "its layout in memory is 16/8 there and 24/8 here"),
                         (lambda text: text.replace('{.name = "tree"}', '{.name = "tree", .transient = true}'), "item kind 'tree' is defined twice")):
        at = folder / str(len(told))
        modules = build(at, ["plant"])
        build(at, ["tally"], change)
        # The module was not taken, so that its steps are not there.
        plumb("--plugin-path", modules, "check", pipeline, code=WRONG_INPUT).has("no module offers 'forest.grow'", "plumb doctor")
        plumb("--plugin-path", modules, "doctor", code=WRONG_INPUT).has(told)


def test_an_edited_kernel_is_never_stale(folder):
    """Changed and built again under the same version, as an author does all day; and built again from the same source."""
    pipeline, store = folder / "forest.yaml", folder / "store"
    pipeline.write_text(PIPELINE)

    def run(modules, out):
        return plumb("--plugin-path", modules, "run", pipeline, "--cache-dir", store, "--explain", "-o", folder / out)

    run(build(folder), "first")
    run(build(folder), "second").has("grown: reused, all 5", "tally: reused")
    edited = build(folder, ["tally"], lambda text: text.replace("in.tree->height + params.by", "in.tree->height + 2 * params.by"))
    run(edited, "third").has("row: reused", "grown: made, all 5: the build of forest.grow was ")
    assert (folder / "third/forest.txt").read_bytes() == b"20 12 4\n"
    elsewhere = build(folder / "elsewhere", ["tally"], lambda text: text.replace("in.tree->height + params.by", "in.tree->height + 2 * params.by"))
    shutil.copy2(folder / "modules/forest.plant.so", elsewhere)
    shutil.copy2(folder / "modules/forest.plant.json", elsewhere)
    run(elsewhere, "fourth").has("grown: reused, all 5")


def test_an_author_may_answer_for_all_builds_of_a_version(folder):
    pipeline, store = folder / "forest.yaml", folder / "store"
    pipeline.write_text(PIPELINE)
    answered = 'version(1).across_builds()'
    for turn, kernel in (("first", "+ params.by"), ("second", "+ 2 * params.by")):
        modules = build(folder, change=lambda text: text.replace("version(1)", answered).replace("+ params.by", kernel))
        said = plumb("--plugin-path", modules, "run", pipeline, "--cache-dir", store, "--explain", "-o", folder / turn)
    said.has("grown: reused, all 5")
    assert (folder / "second/forest.txt").read_bytes() == (folder / "first/forest.txt").read_bytes() == HEIGHTS_AND_GAPS
