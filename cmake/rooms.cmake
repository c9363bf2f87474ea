# madori_room(NAME SOURCES a.cpp ... USES madori::core ... PRIVATE_USES OpenCV ...)
# One static library a room, seen by others as madori::NAME. Headers are included as "room/module/x.hpp".
# Foreign headers are SYSTEM: their warnings are not ours.
function(madori_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;PRIVATE_USES;PRIVATE_INCLUDES" ${ARGN})
  add_library(madori_${name} STATIC ${ROOM_SOURCES})
  add_library(madori::${name} ALIAS madori_${name})
  target_link_libraries(madori_${name} PUBLIC madori_options ${ROOM_USES} PRIVATE ${ROOM_PRIVATE_USES})
  target_include_directories(madori_${name} SYSTEM PRIVATE ${ROOM_PRIVATE_INCLUDES})
endfunction()

# madori_test(NAME SOURCES x_test.cpp ... USES madori::mapping ... [LABELS unit])
# One GoogleTest executable, one ctest entry. Tests find real recordings at MADORI_SHARED_DATA and skip without them.
function(madori_test name)
  cmake_parse_arguments(TEST "" "TIMEOUT" "SOURCES;USES;LABELS;INCLUDES" ${ARGN})
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 300)
  endif()
  add_executable(${name} ${TEST_SOURCES})
  target_link_libraries(${name} PRIVATE madori_options ${TEST_USES} GTest::gmock GTest::gtest_main)
  target_include_directories(${name} SYSTEM PRIVATE ${TEST_INCLUDES})
  # What a test measures is compiled in its room; the tests themselves take a fifth less of the build so.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_compile_definitions(${name} PRIVATE
    MADORI_SOURCE_DIR="${PROJECT_SOURCE_DIR}" MADORI_BINARY_DIR="${PROJECT_BINARY_DIR}"
    MADORI_SHARED_DATA="${PROJECT_SOURCE_DIR}/../shared/data")
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS "${TEST_LABELS}" TIMEOUT ${TEST_TIMEOUT}
    ENVIRONMENT_MODIFICATION "LSAN_OPTIONS=set:suppressions=${PROJECT_SOURCE_DIR}/tests/leaks_elsewhere.txt:print_suppressions=0")
endfunction()
