# What nearly every file reads, compiled once for libplumb, once for the modules and once for the tests. Files include what they need all the same:
# a build with -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON passes too.
set(PLUMB_PRECOMPILED <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <mutex> <optional> <set> <sstream>
                      <string> <string_view> <unordered_map> <variant> <vector> <Eigen/Core> <Eigen/Geometry>)

# plumb_precompiled_by(OWNER HEADER...): a target from which others take its precompiled headers.
function(plumb_precompiled_by owner)
  set(nothing ${CMAKE_BINARY_DIR}/${owner}.cpp)
  if(NOT EXISTS ${nothing})
    file(WRITE ${nothing} "// Holds a precompiled header.\n")
  endif()
  add_library(${owner} OBJECT ${nothing})
  target_link_libraries(${owner} PRIVATE plumb)
  target_compile_options(${owner} PRIVATE ${PLUMB_WARNINGS})
  target_precompile_headers(${owner} PRIVATE ${ARGN})
endfunction()

# plumb_precompiled_step(TARGET): objects of a module, of the simulator, of a command's library.
function(plumb_precompiled_step target)
  if(NOT TARGET plumb_precompiled_for_steps)
    plumb_precompiled_by(plumb_precompiled_for_steps ${PLUMB_PRECOMPILED})
  endif()
  target_precompile_headers(${target} REUSE_FROM plumb_precompiled_for_steps)
endfunction()

# plumb_precompiled_test(TARGET): a test program. Compiled as for a library, as the header is.
function(plumb_precompiled_test target)
  if(NOT TARGET plumb_precompiled_for_tests)
    plumb_precompiled_by(plumb_precompiled_for_tests ${PLUMB_PRECOMPILED} <gmock/gmock.h> <gtest/gtest.h>)
    target_link_libraries(plumb_precompiled_for_tests PRIVATE GTest::gmock)
  endif()
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_compile_options(${target} PRIVATE -fPIC ${PLUMB_WARNINGS})
  target_precompile_headers(${target} REUSE_FROM plumb_precompiled_for_tests)
endfunction()
