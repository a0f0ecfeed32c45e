"""Pipelines of an earlier release run with warnings, and `plumb migrate` rewrites them by the names of now.

`tests/end_to_end/former` holds pipelines and presets as they were before names changed.
"""
import os
import shutil

from plumb_test import CASCADE, PIPELINES, SOURCE, WRONG_INPUT, plumb, shipped_pipelines, skip

FORMER = SOURCE / "tests/end_to_end/former"


def former(folder):
    """A copy of the old pipelines, beside the shipped ones as in the source; skips when there are none."""
    if not list(FORMER.rglob("*.yaml")):
        skip("tests/end_to_end/former holds no pipelines")
    (folder / "pipelines").symlink_to(PIPELINES)
    copy = folder / "tests/end_to_end/former"
    shutil.copytree(FORMER, copy)
    return sorted(copy.rglob("*.yaml"))


def values(said):
    return [line.split(" # ")[0].rstrip() for line in said.out.splitlines()]


def comments(text):
    return [line[line.index("#"):] for line in text.splitlines() if line.lstrip().startswith("#") or " # " in line]


def test_old_pipelines_are_read_with_warnings_alone(folder):
    warned = 0
    for file in former(folder):
        said = plumb("resolve", file)
        lines = said.err.splitlines()
        assert all(": warning: '" in line and "0.3.0" in line for line in lines), said
        assert all(f"'plumb migrate {line.split(':')[0]}'" in line for line in lines), said
        warned += bool(lines)
        assert plumb("graph", file).err == said.err
    assert warned


def test_migrated_ones_are_read_without_a_word_and_say_the_same(folder):
    files = former(folder)
    texts = {file: file.read_text() for file in files}
    before = {file: values(plumb("resolve", file)) for file in files}
    for file in files:
        warned = [line for line in plumb("resolve", file).err.splitlines() if line.startswith(f"{file}:")]
        said = plumb("migrate", file)
        assert len(said.out.splitlines()) >= (len(warned) + 1 if warned else 1) and not said.err, said
        assert not any(line.startswith(f"{file}:") for line in plumb("resolve", file).err.splitlines()), file
        assert comments(file.read_text()) == comments(texts[file]), file
        assert len(file.read_text().splitlines()) - len(texts[file].splitlines()) <= said.out.count("former default"), file
    for file in files:
        said = plumb("resolve", file)
        assert not said.err and values(said) == before[file], file
        text = file.read_bytes()
        plumb("migrate", file).has("nothing to do")
        assert file.read_bytes() == text
    assert any(file.read_text() != texts[file] for file in files)


def test_the_result_is_put_in_place_as_a_whole(folder):
    file = next(file for file in former(folder) if "warning" in plumb("resolve", file).err)
    name = file.read_text()
    file.chmod(0o640)
    link = file.with_name("link.yaml")
    link.symlink_to(file.name)
    plumb("migrate", file, "-o", file.with_name("beside.yaml")).has("beside.yaml: written")
    assert file.read_text() == name
    plumb("migrate", link)
    assert link.is_symlink() and file.read_text() == file.with_name("beside.yaml").read_text() != name
    assert file.stat().st_mode & 0o777 == file.with_name("beside.yaml").stat().st_mode & 0o777 == 0o640
    assert not list(file.parent.glob(".*"))


def test_shipped_pipelines_need_no_migration(folder):
    for pipeline in shipped_pipelines():
        assert not plumb("resolve", pipeline).err
        before = pipeline.read_bytes()
        plumb("migrate", pipeline).has("nothing to do")
        assert pipeline.read_bytes() == before


def test_what_is_no_pipeline_is_refused_and_left_as_it_is(folder):
    (folder / "thesis.tex").write_text("\\section{Drift}\n")
    (folder / "wrong.yaml").write_text(CASCADE.read_text().replace("use: prune.kmeans", "use: prune.kmean", 1))
    (folder / "run.lock.yaml").write_text("# A run of Plumb: what made the files beside this one.\n")
    os.mkfifo(folder / "pipe")
    for name, told in (("thesis.tex", "is no pipeline"), ("wrong.yaml", "Did you mean 'prune.kmeans'?"), ("run.lock.yaml", "the record of a run"),
                       ("pipe", "a pipe, not a pipeline"), ("none.yaml", "there is no file"), (".", "is a folder, not a pipeline")):
        file = folder / name
        before = file.read_bytes() if file.is_file() else None
        plumb("migrate", file, code=WRONG_INPUT).has(told)
        assert before is None or file.read_bytes() == before
    plumb("migrate", CASCADE, "-o", folder, code=WRONG_INPUT).has("is a folder")
    plumb("migrate", CASCADE, "-o", folder / "far/off.yaml", code=WRONG_INPUT).has("cannot be written")
    plumb("migrate", CASCADE, "-o", folder / "copy.yaml").has("nothing to do")
    (folder / "mine.txt").write_text("my only copy")
    plumb("migrate", CASCADE, "-o", folder / "mine.txt", code=WRONG_INPUT).has("mine.txt: is there already")
    assert (folder / "mine.txt").read_text() == "my only copy"
    assert (folder / "copy.yaml").read_bytes() == CASCADE.read_bytes()
