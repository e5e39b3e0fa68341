# Installs the core for find_package(tet_line_tracker_core), target tet_line_tracker::core: where catkin puts libraries and
# headers, as a part of the catkin package; where CMake does, alone.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
if(CATKIN_PACKAGE_LIB_DESTINATION)
  set(library_destination ${CATKIN_PACKAGE_LIB_DESTINATION})
else()
  set(library_destination ${CMAKE_INSTALL_LIBDIR})
endif()
set(config_destination ${library_destination}/cmake/tet_line_tracker_core)

set_target_properties(tet_line_tracker_core PROPERTIES EXPORT_NAME core)
install(TARGETS tet_line_tracker_core EXPORT tet_line_tracker_core
  ARCHIVE DESTINATION ${library_destination}
  LIBRARY DESTINATION ${library_destination}
  RUNTIME DESTINATION bin)
install(DIRECTORY ${TET_ROOT}/include/tet_line_tracker DESTINATION include)
install(EXPORT tet_line_tracker_core
  NAMESPACE tet_line_tracker::
  FILE tet_line_tracker_core-targets.cmake
  DESTINATION ${config_destination})

file(STRINGS ${TET_ROOT}/package.xml version REGEX "<version>")
string(REGEX REPLACE ".*<version>(.*)</version>.*" "\\1" version "${version}")
# A static library needs at link time what it uses inside.
set(private_dependencies "")
if(NOT BUILD_SHARED_LIBS)
  set(private_dependencies "find_dependency(yaml-cpp)")
endif()
configure_package_config_file(${TET_ROOT}/cmake/tet_line_tracker_core-config.cmake.in tet_line_tracker_core-config.cmake
  INSTALL_DESTINATION ${config_destination})
write_basic_package_version_file(tet_line_tracker_core-config-version.cmake
  VERSION ${version}
  COMPATIBILITY SameMajorVersion)
install(
  FILES
    ${CMAKE_CURRENT_BINARY_DIR}/tet_line_tracker_core-config.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/tet_line_tracker_core-config-version.cmake
  DESTINATION ${config_destination})
