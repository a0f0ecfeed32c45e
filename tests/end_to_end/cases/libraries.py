"""Which modules use PCL, FLANN and CGAL, by what compiler and linker left: those that say so, and no other part of Plumb."""
import re

from built import headers_by_object, headers_of, lines_of, manifests, module_file, needed_by, objects_of, objects_of_module, symbols_of
from plumb_test import BUILD, SOURCE, left_out, steps_by_library

FOLDER = re.compile(r"(?<!/shared)/(pcl|flann|CGAL)/")  # of headers; plugins/shared/pcl is ours
OF_CGAL = {"libgmp", "libmpfr"}
# The header of the class, or function, that each step wraps.
WRAPPED = {"describe.gasd": "pcl/features/gasd.h", "describe.shot": "pcl/features/shot.h", "describe.vfh": "pcl/features/vfh.h",
           "edges.overlap_octree": "CGAL/Octree.h", "estimate.normals_jet": "CGAL/Monge_via_jet_fitting.h",
           "filter.covariance_sampling": "pcl/filters/covariance_sampling.h", "filter.normal_space": "pcl/filters/normal_space.h",
           "filter.radius_outlier": "pcl/filters/radius_outlier_removal.h", "filter.spatial_sort": "CGAL/hilbert_sort.h",
           "keypoints.harris3d": "pcl/keypoints/harris_3d.h", "keypoints.iss": "pcl/keypoints/iss_3d.h", "match.features_flann": "flann/flann.hpp",
           "prune.geometric_consistency": "pcl/recognition/cg/geometric_consistency.h", "prune.hough": "pcl/recognition/cg/hough_3d.h",
           "prune.one_to_one": "pcl/registration/correspondence_rejection_one_to_one.h", "register.gicp": "pcl/registration/gicp.h",
           "register.ndt": "pcl/registration/ndt.h", "segment.planes": "CGAL/Shape_detection/Region_growing/Region_growing.h"}


def built(steps):
    return sorted(set(steps) - set(left_out()))


def library_of(module):
    """PCL, FLANN, CGAL or nothing, as its CMakeLists.txt has it."""
    library, _ = steps_by_library().get(module, ("", ""))
    return library.split()[0] if library else ""


def read_by(objects):
    return {found[1] for header in headers_of(objects) if (found := FOLDER.search(header))}


def test_each_module_uses_the_library_that_it_says_and_no_other(folder):
    for module in manifests():
        library, read, needed = library_of(module), read_by(objects_of_module(module)), needed_by(module_file(module))
        assert ("pcl" in read) == (library == "PCL"), (module, read)
        assert ("CGAL" in read) == (library == "CGAL"), (module, read)
        assert "flann" in read if library == "FLANN" else "flann" not in read or library == "PCL", (module, read)  # PCL's trees are FLANN's
        assert any(name.startswith("libpcl_") for name in needed) == (library == "PCL"), (module, needed)
        assert not needed & OF_CGAL or library == "CGAL", (module, needed)


def test_neither_the_command_nor_the_libraries_that_all_link_use_any(folder):
    objects = [name for name in headers_by_object() if name.startswith(("framework/", "tools/")) or "/plumb_shared_" in name and "/plumb_shared_pcl" not in name]
    assert len(objects) > 100, objects  # batches of files where the build is a unity build
    users = {name: read for name in objects if (read := read_by([name]))}
    assert not users, users


def test_no_library_gives_its_eigen_to_others(folder):
    """One compiled with AVX would be called by PCL and Ceres, which were compiled without, in the place of their own."""
    for library in ("libplumb.so", "libplumb_slam.so"):
        names = [line.split()[0] for line in lines_of("nm", "-D", "--defined-only", "--format=posix", BUILD / "lib" / library)]
        assert len(names) > 500, (library, len(names))
        assert not [name for name in names if name.startswith(("_ZN5Eigen", "_ZNK5Eigen", "_ZZN5Eigen", "_ZGVZN5Eigen"))], library


def test_a_module_states_the_licence_of_the_library_that_it_uses_and_its_page_does(folder):
    for module, manifest in manifests().items():
        library, licence = library_of(module), manifest["licence"]
        page = SOURCE.joinpath("plugins", *module.split(".", 1), "README.md").read_text()
        stated = licence["expression"].split(" AND ")
        if library:
            assert library in licence["reason"] and licence["reason"].endswith("."), (module, licence)
        else:
            assert not any("3.0" in one for one in stated), (module, licence)
        if library == "CGAL":
            assert "LGPL-3.0-or-later" in stated and "LGPL-3.0-or-later" in page, (module, licence)
            assert module == "filter.spatial_sort" or "GPL-3.0-or-later" in stated and re.search(r"\bGPL-3.0-or-later", page), (module, licence)


def test_each_wrapped_class_is_called_by_a_test_of_its_kernel(folder):
    """From the symbols that the test asks for, over objects of the kernel, to one that was compiled with the class; the step itself left aside."""
    odd = set(WRAPPED) ^ set(steps_by_library())
    assert not odd, f"WRAPPED has a row for each step by PCL, FLANN or CGAL: {sorted(odd)}"
    for module in built(WRAPPED):
        kernel = [name for name in objects_of_module(module) if not name.endswith("/step.cpp.o")]
        wrapping = {name for name in kernel if any(header.endswith("/" + WRAPPED[module]) for header in headers_of([name]))}
        assert wrapping, f"{module}: no object of its kernel was compiled with {WRAPPED[module]}"
        symbols = {name: symbols_of(name) for name in kernel}
        asked = set().union(*(symbols_of(name)[1] for name in objects_of("test_" + module.replace(".", "_"))))
        reached = set()
        while new := {name for name in kernel if name not in reached and symbols[name][0] & asked}:
            reached |= new
            asked |= set().union(*(symbols[name][1] for name in new))
        assert reached & wrapping, f"{module}: no test calls what {sorted(wrapping)} define"
