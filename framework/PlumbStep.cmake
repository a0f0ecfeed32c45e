# plumb_add_shared(NAME [LIBRARIES ...] [PORTABLE])
#
# Builds plumb_shared_NAME, kernels that several steps share, from the .cpp files of the calling folder plugins/shared/NAME (all but *_test.cpp), and
# its test from *_test.cpp. Who links it includes "shared/NAME/FILE.hpp". Where there are headers alone, it is they that are linked.
# PORTABLE: compiled for any x86-64, for steps that are.
function(plumb_add_shared name)
  cmake_parse_arguments(arg "PORTABLE" "" "LIBRARIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  set(tests ${sources})
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
  set(target plumb_shared_${name})
  if(sources)
    add_library(${target} STATIC ${sources})
    target_include_directories(${target} PUBLIC ${CMAKE_SOURCE_DIR}/plugins)
    target_link_libraries(${target} PUBLIC plumb_slam ${arg_LIBRARIES})
    target_compile_options(${target} PRIVATE ${PLUMB_WARNINGS})
    if(arg_PORTABLE)
      plumb_precompiled_portable_step(${target})
    else()
      target_link_libraries(${target} PRIVATE plumb_kernel)
      plumb_precompiled_step(${target})
    endif()
    plumb_unity(${target})
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE ${CMAKE_SOURCE_DIR}/plugins)
    target_link_libraries(${target} INTERFACE plumb_slam ${arg_LIBRARIES})
  endif()

  if(PLUMB_TESTS AND tests)
    add_executable(test_shared_${name} ${tests})
    if(arg_PORTABLE)
      plumb_precompiled_portable_test(test_shared_${name})
    else()
      target_link_libraries(test_shared_${name} PRIVATE plumb_arch)
      plumb_precompiled_test(test_shared_${name})
    endif()
    target_link_libraries(test_shared_${name} PRIVATE ${target} GTest::gmock GTest::gtest_main)
    gtest_discover_tests(test_shared_${name} TEST_PREFIX "shared.${name}." DISCOVERY_MODE PRE_TEST)
  endif()
endfunction()

# plumb_add_step(FAMILY.NAME [SOURCES a.cpp ...] [TESTS a_test.cpp ...] [LIBRARIES ...] [TEST_LIBRARIES ...] [NOT_INSTALLED] [PORTABLE]
#                [LICENCE "SPDX expression" LICENCE_REASON "sentence"])
#
# Builds the module of one step from the .cpp files of the calling folder (all but *_test.cpp), writes its manifest
# (what `plumb list` reads without running the module), and builds its test from *_test.cpp.
#
# PORTABLE: compiled for any x86-64, as libraries are that it exchanges Eigen's matrices with, and not for the processors of PLUMB_ARCH.
#
# LICENCE is what whoever loads the module accepts: the licence of its own code AND those of all libraries that it loads beside libplumb and what
# that loads; BSD-3-Clause if not given. LICENCE_REASON names the libraries and says which brings what.
# A module is loaded only from where nobody else may write, whatever the umask of who builds it: plumb_close_folder(FOLDER) makes such a folder.
function(plumb_close_folder folder)
  file(MAKE_DIRECTORY ${folder})
  file(CHMOD ${folder} DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
endfunction()

function(plumb_add_step step)
  cmake_parse_arguments(PARSE_ARGV 1 arg "NOT_INSTALLED;PORTABLE" "LICENCE;LICENCE_REASON" "SOURCES;TESTS;LIBRARIES;TEST_LIBRARIES")
  if(NOT arg_SOURCES)
    file(GLOB arg_SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
    list(FILTER arg_SOURCES EXCLUDE REGEX "_test\\.cpp$")
  endif()
  if(NOT arg_TESTS)
    file(GLOB arg_TESTS CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp)
  endif()
  if(NOT arg_LICENCE)
    set(arg_LICENCE BSD-3-Clause)
  elseif(NOT arg_LICENCE_REASON)
    message(FATAL_ERROR "${step}: LICENCE needs LICENCE_REASON, a sentence that says which library brings what")
  endif()
  string(REPLACE "." "_" id ${step})

  # The objects are compiled once; the module and the test both link them.
  add_library(${id}_objects OBJECT ${arg_SOURCES})
  target_link_libraries(${id}_objects PUBLIC plumb_slam ${arg_LIBRARIES})
  target_compile_options(${id}_objects PRIVATE ${PLUMB_WARNINGS})
  plumb_unity(${id}_objects)
  if(NOT arg_PORTABLE)
    target_link_libraries(${id}_objects PRIVATE plumb_kernel)
    plumb_precompiled_step(${id}_objects)
  else()
    plumb_precompiled_portable_step(${id}_objects)
  endif()

  add_library(step_${id} MODULE $<TARGET_OBJECTS:${id}_objects>)
  target_link_libraries(step_${id} PRIVATE plumb_slam ${arg_LIBRARIES} -Wl,--no-undefined)
  set_target_properties(step_${id} PROPERTIES PREFIX "" OUTPUT_NAME ${step}
                        LIBRARY_OUTPUT_DIRECTORY ${PLUMB_MODULE_DIR})
  if(NOT TARGET plumb_modules)
    add_custom_target(plumb_modules)  # all of them, for who builds no tests
  endif()
  add_dependencies(plumb_modules step_${id})
  if(TARGET plumb_manifest)
    add_custom_command(TARGET step_${id} POST_BUILD
                       COMMAND chmod go-w $<TARGET_FILE:step_${id}>
                       COMMAND plumb_manifest $<TARGET_FILE:step_${id}> ${PLUMB_MODULE_DIR}/${step}.json
                               ${arg_LICENCE} "${arg_LICENCE_REASON}"
                       COMMAND chmod go-w ${PLUMB_MODULE_DIR}/${step}.json
                       COMMENT "Manifest of ${step}" VERBATIM)
    add_dependencies(step_${id} plumb_manifest)
  endif()
  if(NOT arg_NOT_INSTALLED)
    install(TARGETS step_${id} LIBRARY DESTINATION lib/plumb)
    install(FILES ${PLUMB_MODULE_DIR}/${step}.json DESTINATION lib/plumb OPTIONAL)
  endif()

  if(PLUMB_TESTS AND arg_TESTS)
    add_executable(test_${id} ${arg_TESTS} $<TARGET_OBJECTS:${id}_objects>)
    if(NOT arg_PORTABLE)
      target_link_libraries(test_${id} PRIVATE plumb_arch)
      plumb_precompiled_test(test_${id})
    else()
      plumb_precompiled_portable_test(test_${id})
    endif()
    target_link_libraries(test_${id} PRIVATE plumb_slam ${arg_LIBRARIES} ${arg_TEST_LIBRARIES} GTest::gmock
                                             GTest::gtest_main)
    target_compile_definitions(test_${id} PRIVATE PLUMB_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
    gtest_discover_tests(test_${id} TEST_PREFIX "${step}." DISCOVERY_MODE PRE_TEST)
  endif()
endfunction()

# plumb_leave_out(STEP LIBRARY PACKAGE): a step that is not built because LIBRARY was not found, which Debian's PACKAGE brings. plumb_say_left_out() says so in
# one line for each library, and writes it beside the modules (plugin/left_out.hpp): `plumb doctor` lists it, and who names such a step is told.
function(plumb_leave_out step library package)
  set_property(GLOBAL APPEND_STRING PROPERTY PLUMB_LEFT_OUT "${step}: ${library} was not found; install ${package} and build again\n")
  set_property(GLOBAL APPEND PROPERTY "PLUMB_STEPS_WITHOUT_${library}" ${step})
  get_property(known GLOBAL PROPERTY PLUMB_LIBRARIES_MISSED)
  if(NOT library IN_LIST known)
    set_property(GLOBAL APPEND PROPERTY PLUMB_LIBRARIES_MISSED "${library}")
  endif()
endfunction()

function(plumb_say_left_out)
  get_property(libraries GLOBAL PROPERTY PLUMB_LIBRARIES_MISSED)
  foreach(library IN LISTS libraries)
    get_property(steps GLOBAL PROPERTY "PLUMB_STEPS_WITHOUT_${library}")
    list(JOIN steps ", " steps)
    message(STATUS "${library} was not found: left out are ${steps}")
  endforeach()
  get_property(lines GLOBAL PROPERTY PLUMB_LEFT_OUT)
  set(file ${PLUMB_MODULE_DIR}/left_out.txt)
  file(WRITE ${file} "${lines}")  # empty where nothing is left out: an installation over an earlier one then says so too
  file(CHMOD ${file} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  install(FILES ${file} DESTINATION lib/plumb)
endfunction()
