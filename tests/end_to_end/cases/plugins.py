"""A step is a folder: without it the project configures and builds, and a pipeline that names it is refused. A foreign module is too."""
import os
import re
import shutil
import subprocess
from pathlib import Path

from plumb_test import BUILD, CASCADE, SOURCE, WRONG_INPUT, installation, nothing_left, plumb, refused, sequence, skip, step_names, steps_by_library


def run(*command, **options):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, **options)
    assert done.returncode == 0, f"$ {' '.join(map(str, command))}\n{(done.stdout + done.stderr)[-4000:]}"
    return done.stdout


def copy_of_source(to):
    """The tree without its tests: as deep in the file system as the original, so that ccache knows its compilations."""
    root = to.joinpath(*["deep"] * (len(SOURCE.parts) - len(to.parts)))
    ignore = shutil.ignore_patterns("*_test.cpp")
    for part in ("framework", "plugins", "tools", "pipelines"):
        shutil.copytree(SOURCE / part, root / part, ignore=ignore)
    shutil.copy(SOURCE / "CMakeLists.txt", root / "CMakeLists.txt")
    return root


def configure(root, build, *options):
    return run("cmake", "-S", root, "-B", build, "-G", "Ninja", "-DPLUMB_TESTS=OFF", "-DPLUMB_BENCHMARKS=OFF", *options)


def test_each_folder_can_be_left_out_of_the_configuration(folder):
    if not shutil.which("ninja"):
        skip("ninja is not on this machine")
    root = copy_of_source(folder)
    folders = sorted(f.parent.relative_to(root / "plugins") for f in (root / "plugins").glob("*/*/CMakeLists.txt"))
    folders = [folder for folder in folders if folder.parts[0] != "shared"]  # what those use is no step
    configure(root, folder / "build")

    def targets():
        return (folder / "build/build.ninja").read_text()

    # Steps whose libraries are not on this machine are left out in any case.
    whole = targets()
    steps = [step for step in folders if f"build step_{'_'.join(step.parts)}:" in whole]
    assert len(steps) >= 30 and whole.count("build step_") == len(steps)
    for step in steps:
        shutil.move(root / "plugins" / step, folder / "away")
        configure(root, folder / "build")
        gone = "step_" + "_".join(step.parts)
        assert f"build {gone}:" not in targets() and targets().count("build step_") == len(steps) - 1, step
        shutil.move(folder / "away", root / "plugins" / step)


def test_builds_without_one_folder_and_runs_what_is_left(folder):
    """Quick only where ccache has the compilations of the tree itself."""
    if not shutil.which("ninja") or not shutil.which("ccache"):
        skip("ninja or ccache is not on this machine, and a whole build takes too long")
    root = copy_of_source(folder)
    left_out = "filter.statistical_outlier"
    shutil.rmtree(root / "plugins" / left_out.replace(".", "/"))
    configure(root, root / "build")
    run("ninja", "-C", root / "build")
    program = root / "build/bin/plumb"
    names = {line.split()[0] for line in plumb("list", program=program).out.splitlines()}
    assert names == set(step_names()) - {left_out}
    plumb("doctor", program=program)
    refuses_the_cascade(folder, left_out, program=program)
    file = folder / "without.yaml"
    file.write_text(f"plumb: 1\nname: without\nextends: {CASCADE}\nremove: [denoised]\nreplace:\n"
                    "  voxels: {use: filter.voxel_grid, from: merged, with: {voxel_size: $voxel_size}}\n")
    plumb("run", file, "--set", f"input={sequence('straight')}", "--set", "ranges.frames=5", "-o", folder / "out", program=program)


def refuses_the_cascade(folder, step, **options):
    line = next(n for n, text in enumerate(CASCADE.read_text().splitlines(), 1) if f"use: {step}" in text)
    said = plumb("run", CASCADE, "--set", f"input={sequence('straight')}", "-o", folder / "refused", code=WRONG_INPUT, **options)
    said.has(f"tang2024.yaml:{line}:", f"no module offers '{step}'", "plumb list")
    nothing_left(folder / "refused")


def test_without_optional_libraries_their_steps_are_left_out_and_that_is_said(folder):
    """By CMake; by doctor and by whoever names one, in an installation without these modules."""
    if not shutil.which("ninja"):
        skip("ninja is not on this machine")
    root, needing = copy_of_source(folder), steps_by_library()
    said = configure(root, folder / "build", "-DCMAKE_DISABLE_FIND_PACKAGE_PCL=ON", "-Dcgal_headers:PATH=", "-Dflann_headers:PATH=")
    targets = (folder / "build/build.ninja").read_text()
    every = {".".join(f.parts[-3:-1]) for f in (root / "plugins").glob("*/*/CMakeLists.txt")}
    every = {step for step in every if not step.startswith("shared.")}
    assert {step for step in every if f"build step_{step.replace('.', '_')}:" in targets} == every - set(needing)
    program, modules, environment = installation(folder)
    shutil.copy(folder / "build/lib/plumb/left_out.txt", modules / "left_out.txt")
    for file in [file for file in modules.iterdir() if file.stem in needing]:
        file.unlink()
    told = plumb("doctor", program=program, environment=environment)
    for library, package in set(needing.values()):
        names = ", ".join(sorted(step for step, needed in needing.items() if needed == (library, package)))
        assert f"{library} was not found: left out are {names}\n" in said, said
        told.has(f"left out of this build: {names}: {library} was not found; install {package} and build again\n")
    pipeline = folder / "shot.yaml"
    pipeline.write_text(f"plumb: 1\nextends: {CASCADE}\nreplace:\n  fpfh: {{use: describe.shot, from: segments}}\n")
    plumb("check", pipeline, "--set", "input=.", code=WRONG_INPUT, program=program, environment=environment).has(
        "shot.yaml:4:15: step 'fpfh': 'describe.shot' is not in this build: PCL was not found; install libpcl-dev and build again.")
    refused(plumb("inspect", "segment.planes", code=WRONG_INPUT, program=program, environment=environment),
            "'segment.planes' is not in this build: CGAL 5.5 was not found; install libcgal-dev and build again")


def test_a_list_of_what_was_left_out_that_others_may_write_is_refused_and_what_is_there_is_not_left_out(folder):
    program, modules, environment = installation(folder)
    listed = modules / "left_out.txt"
    listed.write_text("prune.kmeans: it was not found; install it and build again\n")
    listed.chmod(0o644)
    assert "left out" not in plumb("doctor", program=program, environment=environment).out
    listed.chmod(0o666)
    plumb("doctor", program=program, environment=environment, code=WRONG_INPUT).has("left_out.txt may be written by everybody", "chmod go-w")
    listed.chmod(0o644)
    listed.write_text("prune.kmeans\n")
    plumb("doctor", program=program, environment=environment, code=WRONG_INPUT).has("left_out.txt:1: expected 'STEP: WHY', found 'prune.kmeans'")


def test_a_pipeline_that_names_a_missing_module_is_refused(folder):
    program, modules, environment = installation(folder)
    plumb("check", CASCADE, "--set", "input=.", program=program, environment=environment).has("good")
    (modules / "prune.kmeans.so").unlink()
    refuses_the_cascade(folder, "prune.kmeans", program=program, environment=environment)
    plumb("doctor", program=program, environment=environment)  # what is not there is no fault


def foreign_module(folder, step, manifest_too):
    """Gives `step` the ABI tag of another SDK: in its module, and in its manifest if asked to."""
    program, modules, environment = installation(folder)
    for kind in [".so", ".json"] if manifest_too else [".so"]:
        file = modules / (step + kind)
        data = file.read_bytes()
        assert b"plumb-sdk 3," in data, "the tag has another text now; change the test"
        file.unlink()
        file.write_bytes(data.replace(b"plumb-sdk 3,", b"plumb-sdk 0,"))
    return program, environment


def test_a_module_of_another_abi_is_refused_by_its_manifest(folder):
    program, environment = foreign_module(folder, "prune.kmeans", manifest_too=True)
    refuses_the_cascade(folder, "prune.kmeans", program=program, environment=environment)
    said = plumb("doctor", program=program, environment=environment, code=WRONG_INPUT)
    said.has("prune.kmeans.so", "was built for another Plumb", "plumb-sdk 0,", "plumb-sdk 3,", "build the module again")


def test_a_module_of_another_abi_behind_a_manifest_of_ours_is_refused_when_it_is_loaded(folder):
    program, environment = foreign_module(folder, "prune.kmeans", manifest_too=False)
    said = plumb("run", CASCADE, "--set", f"input={sequence('straight')}", "--quiet", "-o", folder / "refused", program=program,
                 environment=environment, code=WRONG_INPUT)
    said.has("prune.kmeans.so", "was built for another Plumb", "plumb-sdk 0,", "build the module again")
    nothing_left(folder / "refused")
    plumb("doctor", program=program, environment=environment, code=WRONG_INPUT).has("prune.kmeans.so", "another Plumb")


def test_a_module_of_a_foreign_compiler_is_refused(folder):
    """A library in C with our entry and another tag, as another SDK would build it."""
    if not shutil.which("cc"):
        skip("no C compiler on this machine")
    source = folder / "old.c"
    source.write_text('struct Module { unsigned magic, version; const char* tag; unsigned long count; void* steps; };\n'
                      'static struct Module module = {0x504c554d, 1, "plumb-sdk 9, gcc 3", 0, 0};\n'
                      'const struct Module* plumb_module(void) { return &module; }\n')
    program, modules, environment = installation(folder)
    kmeans = modules / "prune.kmeans.so"
    kmeans.unlink()
    run("cc", "-shared", "-fPIC", source, "-o", kmeans)
    plumb("doctor", program=program, environment=environment, code=WRONG_INPUT).has("plumb-sdk 9, gcc 3", "build the module again")


def test_a_crashing_module_is_named_by_doctor(folder):
    if not shutil.which("cc"):
        skip("no C compiler on this machine")
    (folder / "crash.c").write_text("__attribute__((constructor)) static void crash(void) { *(volatile int*)0 = 1; }\n")
    program, modules, environment = installation(folder)
    kmeans = modules / "prune.kmeans.so"
    kmeans.unlink()
    run("cc", "-shared", "-fPIC", folder / "crash.c", "-o", kmeans)
    plumb("doctor", program=program, environment=environment, code=WRONG_INPUT).has("prune.kmeans.so", "crashes when it is loaded")


def refused_module(folder, change, *words):
    """A module that would leave a trace when it is loaded, and what `change(module, its folder)` makes of it: it is named, and never loaded."""
    folder.mkdir(exist_ok=True)
    trace = folder / "trace"
    (folder / "trace.c").write_text("#include <fcntl.h>\n__attribute__((constructor)) static void trace(void) "
                                    f'{{ open("{trace}", O_CREAT | O_WRONLY, 0600); }}\n')
    program, modules, environment = installation(folder)
    kmeans = modules / "prune.kmeans.so"
    kmeans.unlink()
    run("cc", "-shared", "-fPIC", folder / "trace.c", "-o", kmeans)
    kmeans.chmod(0o755)
    plumb("doctor", program=program, environment=environment, code=WRONG_INPUT).has("not a module of Plumb")
    assert trace.exists(), "a module that may be loaded was not: this test would not notice one that is"
    trace.unlink()
    change(kmeans, modules)
    plumb("doctor", program=program, environment=environment, code=WRONG_INPUT).has("refused: " + str(modules), *words)
    plumb("list", program=program, environment=environment).has("refused: " + str(modules), *words)
    refuses_the_cascade(folder, "prune.kmeans", program=program, environment=environment)
    assert not trace.exists(), "code of a refused module ran"


def needs_a_compiler():
    if not shutil.which("cc"):
        skip("no C compiler on this machine")


def needs_root():
    if os.geteuid() != 0:
        skip("only root can give files away")


def test_a_module_that_its_group_may_write_is_not_loaded(folder):
    needs_a_compiler()
    refused_module(folder, lambda module, _: module.chmod(0o775), "prune.kmeans.so", "may be written by its group (mode 0775)", "chmod go-w")


def test_a_module_that_everybody_may_write_is_not_loaded(folder):
    needs_a_compiler()
    refused_module(folder, lambda module, _: module.chmod(0o666), "prune.kmeans.so", "may be written by everybody (mode 0666)", "chmod go-w")


def test_a_module_of_another_user_is_not_loaded(folder):
    needs_a_compiler()
    needs_root()
    refused_module(folder, lambda module, _: os.chown(module, 65534, 65534), "prune.kmeans.so", "belongs to user", "chown")


def test_a_link_to_a_module_that_others_may_write_is_not_loaded(folder):
    needs_a_compiler()
    target = folder / "target.so"

    def link(module, _):
        module.rename(target)
        target.chmod(0o666)
        module.symlink_to(target)

    refused_module(folder, link, "prune.kmeans.so", f"{target} may be written by everybody", f"chmod go-w '{target}'")


def test_a_module_that_is_a_pipe_is_not_waited_for(folder):
    needs_a_compiler()

    def pipe(module, _):
        module.unlink()
        os.mkfifo(module, 0o600)

    refused_module(folder, pipe, "prune.kmeans.so", "is a pipe, not a regular file")


def test_a_manifest_that_others_may_write_or_that_is_a_pipe_is_not_read(folder):
    needs_a_compiler()

    def loose(module, _):
        manifest = module.with_suffix(".json")
        text = manifest.read_text()
        manifest.unlink()
        manifest.write_text(text)
        manifest.chmod(0o646)

    refused_module(folder / "one", loose, "its manifest", "prune.kmeans.json may be written by everybody", "chmod go-w")

    def pipe(module, _):
        manifest = module.with_suffix(".json")
        manifest.unlink()
        os.mkfifo(manifest, 0o600)

    refused_module(folder / "other", pipe, "its manifest", "is a pipe")


def test_a_folder_of_modules_that_others_may_write_is_not_searched(folder):
    program, modules, environment = installation(folder)
    for mode, words in ((0o777, "everybody"), (0o775, "its group")):
        modules.chmod(mode)
        said = plumb("doctor", program=program, environment=environment, code=WRONG_INPUT)
        said.has(f"refused: {modules}", f"may be written by {words}", "chmod go-w")
        refuses_the_cascade(folder, "source.sequence", program=program, environment=environment)
    modules.chmod(0o755)
    plumb("doctor", program=program, environment=environment)
    if os.geteuid() == 0:
        os.chown(modules, 65534, 65534)
        plumb("doctor", program=program, environment=environment, code=WRONG_INPUT).has(f"refused: {modules}", "belongs to user")


def test_modules_below_a_folder_that_others_may_write_are_not_loaded(folder):
    loose, modules = folder / "loose", folder / "loose/inner/modules"
    modules.mkdir(parents=True)
    for file in ("test.nothing.so", "test.nothing.json"):
        shutil.copy(BUILD / "tests/end_to_end/modules" / file, modules / file)
    for path in (loose, loose / "inner", modules):
        path.chmod(0o755)
    assert "test.nothing" in plumb("--plugin-path", modules, "list").out
    for mode, words in ((0o777, "everybody"), (0o775, "its group")):
        loose.chmod(mode)
        said = plumb("--plugin-path", modules, "list").has(f"refused: {modules}: {loose} may be written by {words}", "chmod go-w")
        assert "test.nothing" not in said.out
        plumb("doctor", environment={"PLUMB_PLUGIN_PATH": str(modules)}, code=WRONG_INPUT).has(f"{loose} may be written by {words}")
    loose.chmod(0o1777)  # as /tmp
    assert "test.nothing" in plumb("--plugin-path", modules, "list").out


def test_a_program_built_under_umask_002_takes_its_own_modules(folder):
    """A checkout in a folder of the user's own group: whoever may write there has the program itself."""
    program, modules, environment = installation(folder)
    for path in (folder, folder / "lib", folder / "bin"):
        path.chmod(0o775)
    modules.chmod(0o755)
    plumb("doctor", program=program, environment=environment)
    (folder / "lib").chmod(0o777)
    plumb("doctor", program=program, environment=environment, code=WRONG_INPUT).has(f"{folder / 'lib'} may be written by everybody")


def test_the_installed_command_finds_its_modules_beside_it(folder):
    if not (BUILD / "cmake_install.cmake").exists():
        skip("this build cannot be installed from here")
    run("cmake", "--install", BUILD, "--prefix", folder / "usr")
    program = folder / "usr/bin/plumb"
    assert {line.split()[0] for line in plumb("list", program=program).out.splitlines()} == set(step_names())
    plumb("doctor", program=program).has(str((folder / "usr/lib/plumb").resolve()))
    os.rename(folder / "usr", folder / "moved")
    plumb("doctor", program=Path(folder / "moved/bin/plumb")).has(str((folder / "moved/lib/plumb").resolve()))


def test_the_installed_headers_include_none_that_are_not_installed(folder):
    if not (BUILD / "cmake_install.cmake").exists():
        skip("this build cannot be installed from here")
    run("cmake", "--install", BUILD, "--prefix", folder / "usr")
    headers = folder / "usr/include"
    files = sorted(headers.rglob("*.hpp"))
    assert headers / "plumb/plugin/module.hpp" in files and headers / "plumb/slam/step.hpp" in files, files
    missing = [f"{file.relative_to(headers)} includes {name}" for file in files
               for name in re.findall(r'^#include "([^"]+)"', file.read_text(), re.M) if not (headers / name).is_file()]
    assert not missing, missing
