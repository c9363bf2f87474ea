# Files of one folder are compiled together, at most eight at once: most of a file's time goes into the headers that its
# neighbours read too. So within a folder no two files define the same helper in their unnamed namespaces;
# a file with compile options of its own stays alone.
# Of these headers themselves, those that most files read are compiled once (`headers`: for the rooms, or for the tests, whose
# flags differ). A file with code generation options of its own is to have SKIP_PRECOMPILE_HEADERS.
function(madori_read_together target headers)
  # A unit includes .cpp files, whose types of an unnamed namespace g++ then takes for a header's.
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
  if(TARGET ${headers})
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endif()
  get_target_property(sources ${target} SOURCES)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${MADORI_UNITY} UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS sources)
    get_filename_component(folder ${source} DIRECTORY)
    string(MAKE_C_IDENTIFIER "in_${folder}" group)
    math(EXPR count_${group} "${count_${group}}+1")
    math(EXPR batch "(${count_${group}}-1)/8")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group}_${batch})
  endforeach()
endfunction()

# madori_headers(NAME [FLAGS -Og ...] HEADERS <a> ... USES Eigen3::Eigen ...): read before all else by who names it.
function(madori_headers name)
  cmake_parse_arguments(READ "" "" "FLAGS;HEADERS;USES" ${ARGN})
  if(NOT MADORI_UNITY OR NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    return()
  endif()
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp "")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE madori_options ${READ_USES})
  target_compile_options(${name} PRIVATE ${READ_FLAGS})
  target_precompile_headers(${name} PRIVATE ${READ_HEADERS})
endfunction()
set(MADORI_OFTEN_READ <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <cstdio> <filesystem> <fstream> <functional>
  <map> <memory> <mutex> <optional> <random> <set> <span> <sstream> <string> <thread> <unordered_map> <utility> <variant>
  <vector> <Eigen/Cholesky> <Eigen/Core> <Eigen/LU> <nlohmann/json.hpp>)

# madori_room(NAME SOURCES a.cpp ... USES madori::core ... PRIVATE_USES OpenCV ...)
# One static library a room, seen by others as madori::NAME. Headers are included as "room/module/x.hpp".
# Foreign headers are SYSTEM: their warnings are not ours.
function(madori_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;PRIVATE_USES;PRIVATE_INCLUDES" ${ARGN})
  add_library(madori_${name} STATIC ${ROOM_SOURCES})
  add_library(madori::${name} ALIAS madori_${name})
  target_link_libraries(madori_${name} PUBLIC madori_options ${ROOM_USES} PRIVATE ${ROOM_PRIVATE_USES})
  target_include_directories(madori_${name} SYSTEM PRIVATE ${ROOM_PRIVATE_INCLUDES})
  madori_read_together(madori_${name} room_headers)
endfunction()

# What a test measures is compiled in its room; the tests themselves are a quarter faster to build so.
set(MADORI_TEST_FLAGS $<$<CONFIG:Release>:-Og>)

# madori_test(NAME SOURCES x_test.cpp ... USES madori::mapping ... [LABELS unit] [LONG]); the long ones begin first.
# One GoogleTest executable, one ctest entry, which gives way to the tests in real time. Tests find real recordings at
# MADORI_SHARED_DATA and skip without them.
function(madori_test name)
  cmake_parse_arguments(TEST "LONG" "TIMEOUT" "SOURCES;USES;LABELS;INCLUDES" ${ARGN})
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 1200)
  endif()
  add_executable(${name} ${TEST_SOURCES})
  target_link_libraries(${name} PRIVATE madori_options ${TEST_USES} GTest::gmock GTest::gtest_main)
  target_include_directories(${name} SYSTEM PRIVATE ${TEST_INCLUDES})
  madori_read_together(${name} test_headers)
  target_compile_options(${name} PRIVATE ${MADORI_TEST_FLAGS})
  target_compile_definitions(${name} PRIVATE
    MADORI_SOURCE_DIR="${PROJECT_SOURCE_DIR}" MADORI_BINARY_DIR="${PROJECT_BINARY_DIR}"
    MADORI_SHARED_DATA="${PROJECT_SOURCE_DIR}/../shared/data")
  add_test(NAME ${name} COMMAND nice -n 19 $<TARGET_FILE:${name}>)
  if(TEST_LONG)
    set_tests_properties(${name} PROPERTIES COST 500)
  endif()
  set_tests_properties(${name} PROPERTIES LABELS "${TEST_LABELS}" TIMEOUT ${TEST_TIMEOUT}
    ENVIRONMENT_MODIFICATION "LSAN_OPTIONS=set:suppressions=${PROJECT_SOURCE_DIR}/tests/leaks_elsewhere.txt:print_suppressions=0")
endfunction()
