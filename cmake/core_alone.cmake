# What src/core takes from the catkin package when it is a part of it, for src/core as a project of its own.
include(${CMAKE_CURRENT_LIST_DIR}/settings.cmake)
option(BUILD_SHARED_LIBS "Build the core as a shared library" OFF)
option(TET_TESTS "Build the tests of the core" ON)
add_compile_options(-Wall -Wextra)
if(TET_WARNINGS_AS_ERRORS)
  add_compile_options(-Werror)
endif()
# As catkin does: shared libraries of others can take the static one in.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_package(OpenCV REQUIRED COMPONENTS core imgproc OPTIONAL_COMPONENTS ximgproc)
find_package(Eigen3 REQUIRED)
find_package(yaml-cpp REQUIRED)

# tet_add_test(ROOM NAME LIBRARIES...) as in tet_targets.cmake; CTest counts each case.
enable_testing()
if(TET_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
function(tet_add_test room name)
  if(TET_TESTS)
    add_executable(${name} ${TET_ROOT}/test/${room}/${name}.cpp)
    target_include_directories(${name} PRIVATE ${TET_ROOT}/src/core)
    target_link_libraries(${name} ${ARGN} GTest::GTest GTest::Main)
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60)
  endif()
endfunction()
