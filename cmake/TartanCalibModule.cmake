# A module is a folder: include/tartan_calib/<name>, src/<name>, test/<name>, one static library tartan_calib_<name>
# and, where there is a folder test/<name>, one test executable <name>_test.

set(TARTAN_CALIB_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_CXX_COMPILER_VERSION VERSION_LESS 12)
  # False positives on Eigen's fixed-size expressions, inlined into our code where SYSTEM does not reach them.
  list(APPEND TARTAN_CALIB_WARNINGS -Wno-array-bounds -Wno-stringop-overread -Wno-maybe-uninitialized)
endif()
if(TARTAN_CALIB_WERROR)
  list(APPEND TARTAN_CALIB_WARNINGS -Werror)
endif()

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

# The repository itself, also where a workspace only links to its files.
get_filename_component(TARTAN_CALIB_SOURCE_DIR ${PROJECT_SOURCE_DIR}/CMakeLists.txt REALPATH)
get_filename_component(TARTAN_CALIB_SOURCE_DIR ${TARTAN_CALIB_SOURCE_DIR} DIRECTORY)

# A third of the time of a build goes into reading the same headers in every file. Off by default, so that a file that lacks an
# include does not compile, and since ccache cannot look into precompiled headers.
option(TARTAN_CALIB_PRECOMPILED_HEADERS "Read Eigen's, GoogleTest's and the most used standard headers once" OFF)

# tartan_calib_precompile(<target> <first target> [<header>...]): precompiles these headers for the first target; the others
# that name it share them.
function(tartan_calib_precompile target first)
  if(NOT TARTAN_CALIB_PRECOMPILED_HEADERS)
    return()
  endif()
  if(target STREQUAL first)
    target_precompile_headers(${target} PRIVATE <Eigen/Core> <Eigen/Geometry> <algorithm> <cmath> <functional> <map> <memory>
                              <optional> <random> <sstream> <string> <variant> <vector> ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${first})
  endif()
endfunction()

# tartan_calib_module(<name> [USES <module>...] [LINK <library>...] [INCLUDE <third-party include dir>...])
function(tartan_calib_module name)
  cmake_parse_arguments(ARG "" "" "USES;LINK;INCLUDE" ${ARGN})
  set(target tartan_calib_${name})
  set(used)
  foreach(module ${ARG_USES})
    list(APPEND used tartan_calib_${module})
  endforeach()

  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  if(sources)
    add_library(${target} STATIC ${sources})
    target_compile_options(${target} PRIVATE ${TARTAN_CALIB_WARNINGS})
    tartan_calib_precompile(${target} tartan_calib_geometry)
    set(scope PUBLIC)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(${target} ${scope} ${PROJECT_SOURCE_DIR}/include)
  target_include_directories(${target} SYSTEM ${scope} ${ARG_INCLUDE})
  target_link_libraries(${target} ${scope} ${used} ${ARG_LINK})

  if(TARTAN_CALIB_BUILD_TESTS)
    tartan_calib_tests(${name} ${target})
  endif()
endfunction()

# tartan_calib_test_support([USES <module>...] [FOR <test executable>...]): test/support/*.cpp as a library, the scenes that
# these tests look at.
function(tartan_calib_test_support)
  cmake_parse_arguments(ARG "" "" "USES;FOR" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/test/support/*.cpp)
  add_library(tartan_calib_test_support STATIC EXCLUDE_FROM_ALL ${sources})
  target_compile_options(tartan_calib_test_support PRIVATE ${TARTAN_CALIB_WARNINGS})
  tartan_calib_precompile(tartan_calib_test_support tartan_calib_geometry)
  target_include_directories(tartan_calib_test_support PUBLIC ${PROJECT_SOURCE_DIR}/test)
  foreach(module ${ARG_USES})
    target_link_libraries(tartan_calib_test_support PUBLIC tartan_calib_${module})
  endforeach()
  foreach(test ${ARG_FOR})
    if(TARGET ${test})
      target_link_libraries(${test} PRIVATE tartan_calib_test_support)
    endif()
  endforeach()
endfunction()

# tartan_calib_tests(<name> <library>...): one executable from test/<name>/*.cpp, its cases known to ctest one by one.
function(tartan_calib_tests name)
  file(GLOB tests CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/test/${name}/*.cpp)
  if(NOT tests)
    return()
  endif()
  find_package(GTest REQUIRED)
  include(GoogleTest)
  add_executable(${name}_test ${tests})
  set_target_properties(${name}_test PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test)
  if(TARTAN_CALIB_IN_WORKSPACE)  # as usual there: `catkin_make` builds no tests, `catkin_make tests` does
    set_target_properties(${name}_test PROPERTIES EXCLUDE_FROM_ALL ON)
    add_dependencies(tests ${name}_test)
  endif()
  target_compile_options(${name}_test PRIVATE ${TARTAN_CALIB_WARNINGS} $<$<CONFIG:Release>:-O1>)  # compiles faster
  tartan_calib_precompile(${name}_test geometry_test <gtest/gtest.h>)
  target_include_directories(${name}_test PRIVATE ${PROJECT_SOURCE_DIR}/test)
  target_compile_definitions(${name}_test PRIVATE TARTAN_CALIB_SOURCE_DIR="${TARTAN_CALIB_SOURCE_DIR}")
  target_link_libraries(${name}_test PRIVATE ${ARGN} GTest::GTest GTest::Main)  # the names that CMake 3.16 knows too
  gtest_discover_tests(${name}_test TEST_PREFIX ${name}. NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60)
endfunction()

# tartan_calib_test_programs(<folder> <library>...): every test/<folder>/*.cpp is a program of its own that scripts run, built
# with the tests and put beside them.
function(tartan_calib_test_programs folder)
  file(GLOB programs CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/test/${folder}/*.cpp)
  foreach(source ${programs})
    get_filename_component(program ${source} NAME_WE)
    add_executable(${program} ${source})
    set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test)
    if(TARTAN_CALIB_IN_WORKSPACE)
      set_target_properties(${program} PROPERTIES EXCLUDE_FROM_ALL ON)
      add_dependencies(tests ${program})
    endif()
    target_compile_options(${program} PRIVATE ${TARTAN_CALIB_WARNINGS})
    target_link_libraries(${program} PRIVATE ${ARGN})
  endforeach()
endfunction()

# tartan_calib_script_tests(<folder> [VARIABLE=value...]): every test/<folder>/*_test.py is one case of ctest, run by the
# system's Python 3 with these variables in its environment.
function(tartan_calib_script_tests folder)
  find_program(TARTAN_CALIB_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
  find_program(TARTAN_CALIB_PYTHON NAMES python3)
  file(GLOB tests CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/test/${folder}/*_test.py)
  foreach(test ${tests})
    get_filename_component(name ${test} NAME_WE)
    add_test(NAME ${folder}.${name} COMMAND ${TARTAN_CALIB_PYTHON} -B ${test})
    set_tests_properties(${folder}.${name} PROPERTIES ENVIRONMENT "${ARGN}")
  endforeach()
endfunction()
