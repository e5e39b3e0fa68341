# Functions for the tables of targets in src/*/CMakeLists.txt.

# Links a target to the core, to ROS, to all of OpenCV, and to what else is named.
function(tet_link_ros target)
  target_include_directories(${target} SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
  target_link_libraries(${target} tet_line_tracker_core ${catkin_LIBRARIES} ${OpenCV_LIBRARIES} ${ARGN})
  add_dependencies(${target} ${${PROJECT_NAME}_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})
endfunction()

# What tests may want to know of the source and build folders.
function(tet_tell_folders target)
  target_compile_definitions(${target} PRIVATE
    TET_SOURCE_DIRECTORY="${PROJECT_SOURCE_DIR}"
    TET_TOOL_DIRECTORY="${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION}")
endfunction()

# A test of a part that knows no ROS: tet_add_test(ROOM NAME LIBRARIES...) builds test/ROOM/NAME.cpp.
function(tet_add_test room name)
  if(CATKIN_ENABLE_TESTING)
    catkin_add_gtest(${name} ${PROJECT_SOURCE_DIR}/test/${room}/${name}.cpp)
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/src/core)
    target_link_libraries(${name} ${ARGN} gtest_main)
  endif()
endfunction()

# A test of ROS parts that needs no master.
function(tet_add_ros_test name)
  if(CATKIN_ENABLE_TESTING)
    catkin_add_gtest(${name} ${PROJECT_SOURCE_DIR}/test/ros/${name}.cpp)
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src/ros)
    tet_tell_folders(${name})
    tet_link_ros(${name} tet_line_tracker_nodelets tet_line_tracker_ros gtest_main)
  endif()
endfunction()

# A test with a master and nodes.
function(tet_add_rostest name)
  if(CATKIN_ENABLE_TESTING)
    set(folder ${PROJECT_SOURCE_DIR}/test/ros)
    add_rostest_gtest(${name} ${folder}/${name}.test ${folder}/${name}.cpp)
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src/ros)
    tet_tell_folders(${name})
    tet_link_ros(${name} tet_line_tracker_ros gtest)
    add_dependencies(${name} line_tracker line_subscriber tet_line_tracker_nodelets)
    # Nodes share the processors with the test that judges them, and with no other one.
    get_directory_property(tests TESTS)
    list(FILTER tests INCLUDE REGEX "_${name}\\.test$")
    if(tests)
      set_tests_properties(${tests} PROPERTIES RUN_SERIAL TRUE)
    endif()
  endif()
endfunction()

# A command-line tool.
function(tet_add_tool name)
  add_executable(${name} ${ARGN})
  tet_link_ros(${name} tet_line_tracker_tools)
  install(TARGETS ${name} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  set_property(GLOBAL APPEND PROPERTY TET_TOOLS ${name})
endfunction()

# A test that runs tools as programs.
function(tet_add_tool_test name)
  if(CATKIN_ENABLE_TESTING)
    set(folder ${PROJECT_SOURCE_DIR}/test/tools)
    catkin_add_gtest(${name} ${folder}/${name}.cpp)
    target_include_directories(${name} PRIVATE ${folder} ${PROJECT_SOURCE_DIR}/src/tools)
    tet_tell_folders(${name})
    tet_link_ros(${name} tet_tool_testing tet_line_tracker_tools gtest_main)
    get_property(tools GLOBAL PROPERTY TET_TOOLS)
    add_dependencies(${name} ${tools})
  endif()
endfunction()
