# The catkin side of the package. Sets TARTAN_CALIB_ROS (the parts that need ROS are built) and TARTAN_CALIB_IN_WORKSPACE (a
# catkin workspace runs CMake, not a user). Included before any target is made: catkin_package() chooses the output folders.

set(TARTAN_CALIB_ROS OFF)
set(TARTAN_CALIB_IN_WORKSPACE OFF)
if(NOT TARTAN_CALIB_WITH_ROS)
  return()
endif()

# The CMake code of catkin and of pluginlib (through rosbag) runs Python with modules of the distribution; a python3 that
# stands first on PATH (pyenv, conda) lacks them. The first looks for PYTHON_EXECUTABLE, the second for Python3_EXECUTABLE.
if(NOT PYTHON_EXECUTABLE)
  execute_process(COMMAND python3 -c "import catkin_pkg" RESULT_VARIABLE lacks_catkin OUTPUT_QUIET ERROR_QUIET)
  if(NOT lacks_catkin EQUAL 0 AND EXISTS /usr/bin/python3)
    set(PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python with catkin_pkg")
  endif()
endif()
if(PYTHON_EXECUTABLE AND NOT Python3_EXECUTABLE)
  set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE} CACHE FILEPATH "Python with the distribution's modules")
endif()

set(ros_packages cv_bridge diagnostic_msgs rosbag roscpp sensor_msgs std_msgs std_srvs)
find_package(catkin QUIET COMPONENTS ${ros_packages})
foreach(package ${ros_packages})
  if(NOT (catkin_FOUND AND ${package}_FOUND))
    message(STATUS "tartan_calib: no catkin with ${package}; only the core is built")
    return()
  endif()
endforeach()
set(TARTAN_CALIB_ROS ON)
if(DEFINED CACHE{CATKIN_DEVEL_PREFIX} AND TARGET tests)
  set(TARTAN_CALIB_IN_WORKSPACE ON)
endif()

# Names in the manner catkin_package(DEPENDS) asks for.
set(APRILTAG_INCLUDE_DIRS ${APRILTAG_INCLUDE_DIR})
set(APRILTAG_LIBRARIES ${APRILTAG_LIBRARY})
set(CHOLMOD_INCLUDE_DIRS ${CHOLMOD_INCLUDE_DIR})
set(CHOLMOD_LIBRARIES ${CHOLMOD_LIBRARY})
set(YAML_CPP_INCLUDE_DIRS ${YAML_CPP_INCLUDE_DIR})
set(EIGEN3_INCLUDE_DIRS ${EIGEN3_INCLUDE_DIR})

# Static libraries in the order a linker wants them: a module before those it uses.
set(TARTAN_CALIB_EXPORTED)
foreach(module ros report io guidance simulation pipeline calibration detection solver observation target camera geometry)
  file(GLOB sources ${PROJECT_SOURCE_DIR}/src/${module}/*.cpp)
  if(sources)
    list(APPEND TARTAN_CALIB_EXPORTED tartan_calib_${module})
  endif()
endforeach()

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES ${TARTAN_CALIB_EXPORTED}
  CATKIN_DEPENDS ${ros_packages}
  DEPENDS APRILTAG CHOLMOD EIGEN3 OpenCV YAML_CPP)

# tartan_calib_apps([USES <module>...] [LINK <library>...]): the programs. src/apps/<program>.cpp holds main() and becomes
# the executable <program>; everything in src/apps/<folder>/ goes into one library that all programs and
# test/apps/*_test.cpp link, with src/apps as include path: #include "<folder>/<header>.h".
function(tartan_calib_apps)
  cmake_parse_arguments(ARG "" "" "USES;LINK" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/apps/*/*.cpp)
  file(GLOB programs CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/apps/*.cpp)
  list(REMOVE_ITEM sources ${programs})
  list(TRANSFORM ARG_USES PREPEND tartan_calib_)

  if(sources)
    add_library(tartan_calib_apps STATIC ${sources})
    target_compile_options(tartan_calib_apps PRIVATE ${TARTAN_CALIB_WARNINGS})
    target_include_directories(tartan_calib_apps PUBLIC ${PROJECT_SOURCE_DIR}/src/apps)
    target_link_libraries(tartan_calib_apps PUBLIC ${ARG_USES} ${ARG_LINK})
    if(TARTAN_CALIB_BUILD_TESTS)
      tartan_calib_tests(apps tartan_calib_apps)
    endif()
    set(libraries tartan_calib_apps)
  else()
    set(libraries ${ARG_USES} ${ARG_LINK})
  endif()

  foreach(program_source ${programs})
    get_filename_component(program ${program_source} NAME_WE)
    add_executable(${program} ${program_source})
    target_compile_options(${program} PRIVATE ${TARTAN_CALIB_WARNINGS})
    target_link_libraries(${program} PRIVATE ${libraries})
    install(TARGETS ${program} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  endforeach()

  if(TARGET calibrate_cameras)
    tartan_calib_alias(calibrate_cameras kalibr_calibrate_cameras)
  endif()
endfunction()

# tartan_calib_alias(<program> <name>): the same program under a second name, in the devel and in the install space.
# A copy, since rosrun takes a link to a file that it also finds under its own name for a second candidate.
function(tartan_calib_alias program name)
  set(copy ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION}/${name})
  add_custom_command(TARGET ${program} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -E copy_if_different $<TARGET_FILE:${program}> ${copy} VERBATIM)
  install(PROGRAMS ${copy} DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endfunction()

# tartan_calib_install(): headers, libraries, launch and config files. Programs install themselves.
# From the repository itself: CMake installs a link, such as scripts/build makes to these folders, as a link.
function(tartan_calib_install)
  foreach(library ${TARTAN_CALIB_EXPORTED})
    install(TARGETS ${library}
      ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION} LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
  endforeach()
  install(DIRECTORY ${TARTAN_CALIB_SOURCE_DIR}/include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
  foreach(folder launch config)
    install(DIRECTORY ${TARTAN_CALIB_SOURCE_DIR}/${folder}/ DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/${folder})
  endforeach()
endfunction()

# tartan_calib_report_script(): what draws the report, in the devel space (copied whenever it changes) and in the install
# space. Programs look for it at the same place beside them in both.
function(tartan_calib_report_script)
  file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scripts/report/*)
  foreach(file ${files})
    if(NOT IS_DIRECTORY ${file})
      get_filename_component(name ${file} NAME)
      configure_file(${file} ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_SHARE_DESTINATION}/report/${name} COPYONLY)
      install(FILES ${file} DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/report)
    endif()
  endforeach()
endfunction()
