# What nearly every file reads, compiled once for libplumb, once for the modules and once for the tests. Files include what they need all the same:
# a build with -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON passes too.
set(PLUMB_PRECOMPILED <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <mutex> <optional> <set> <sstream>
                      <string> <string_view> <unordered_map> <variant> <vector>)
set(PLUMB_PRECOMPILED_SLAM <Eigen/Core> <Eigen/Geometry>)
set(PLUMB_PRECOMPILED_SDK <plumb/plugin/module.hpp> <plumb/slam/step.hpp>)  # by no path of this tree, so that ccache knows it in another

# plumb_unity(TARGET): its files may be compiled several at a time (PLUMB_UNITY). Names in unnamed namespaces must differ within a target.
function(plumb_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${PLUMB_UNITY} UNITY_BUILD_BATCH_SIZE 12)
  if(PLUMB_UNITY)
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)  # takes an included .cpp for a header
  endif()
endfunction()

# plumb_precompiled_by(OWNER LIBRARIES HEADER...): a target from which others that link the LIBRARIES, a list, take its precompiled headers.
function(plumb_precompiled_by owner libraries)
  set(nothing ${CMAKE_BINARY_DIR}/${owner}.cpp)
  if(NOT EXISTS ${nothing})
    file(WRITE ${nothing} "// Holds a precompiled header.\n")
  endif()
  add_library(${owner} OBJECT ${nothing})
  target_link_libraries(${owner} PRIVATE ${libraries})
  target_compile_options(${owner} PRIVATE ${PLUMB_WARNINGS})
  target_precompile_headers(${owner} PRIVATE ${ARGN})
endfunction()

# plumb_precompiled_step(TARGET): objects of a module, of the simulator, of a command's library.
function(plumb_precompiled_step target)
  if(NOT TARGET plumb_precompiled_for_steps)
    plumb_precompiled_by(plumb_precompiled_for_steps "plumb_slam;plumb_kernel" ${PLUMB_PRECOMPILED} ${PLUMB_PRECOMPILED_SLAM}
                         ${PLUMB_PRECOMPILED_SDK})
  endif()
  target_precompile_headers(${target} REUSE_FROM plumb_precompiled_for_steps)
endfunction()
# The same for a PORTABLE module, which is compiled for any x86-64.
function(plumb_precompiled_portable_step target)
  if(NOT TARGET plumb_precompiled_for_portable_steps)
    plumb_precompiled_by(plumb_precompiled_for_portable_steps plumb_slam ${PLUMB_PRECOMPILED} ${PLUMB_PRECOMPILED_SLAM} ${PLUMB_PRECOMPILED_SDK})
  endif()
  target_precompile_headers(${target} REUSE_FROM plumb_precompiled_for_portable_steps)
endfunction()

# A test program takes the header of OWNER, which is compiled as for a library.
function(plumb_precompiled_test_by owner target libraries)
  if(NOT TARGET ${owner})
    plumb_precompiled_by(${owner} "${libraries}" ${PLUMB_PRECOMPILED} ${ARGN} <gmock/gmock.h> <gtest/gtest.h>)
    target_link_libraries(${owner} PRIVATE GTest::gmock)
  endif()
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_compile_options(${target} PRIVATE -fPIC ${PLUMB_WARNINGS})
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()

# plumb_precompiled_test(TARGET): a test program. plumb_precompiled_portable_test(TARGET): one of a PORTABLE module.
# plumb_precompiled_core_test(TARGET): one of the core, without Eigen.
function(plumb_precompiled_test target)
  plumb_precompiled_test_by(plumb_precompiled_for_tests ${target} "plumb_slam;plumb_arch" ${PLUMB_PRECOMPILED_SLAM} ${PLUMB_PRECOMPILED_SDK})
endfunction()
function(plumb_precompiled_portable_test target)
  plumb_precompiled_test_by(plumb_precompiled_for_portable_tests ${target} plumb_slam ${PLUMB_PRECOMPILED_SLAM} ${PLUMB_PRECOMPILED_SDK})
endfunction()
function(plumb_precompiled_core_test target)
  plumb_precompiled_test_by(plumb_precompiled_for_core_tests ${target} plumb)
endfunction()
