# Files of one folder are compiled together, at most eight at once: most of a file's time goes into the headers that its
# neighbours read too. So within a folder no two files define the same helper in their unnamed namespaces;
# a file with compile options of its own stays alone.
function(madori_read_together target)
  # A unit includes .cpp files, whose types of an unnamed namespace g++ then takes for a header's.
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
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

# madori_room(NAME SOURCES a.cpp ... USES madori::core ... PRIVATE_USES OpenCV ...)
# One static library a room, seen by others as madori::NAME. Headers are included as "room/module/x.hpp".
# Foreign headers are SYSTEM: their warnings are not ours.
function(madori_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;PRIVATE_USES;PRIVATE_INCLUDES" ${ARGN})
  add_library(madori_${name} STATIC ${ROOM_SOURCES})
  add_library(madori::${name} ALIAS madori_${name})
  target_link_libraries(madori_${name} PUBLIC madori_options ${ROOM_USES} PRIVATE ${ROOM_PRIVATE_USES})
  target_include_directories(madori_${name} SYSTEM PRIVATE ${ROOM_PRIVATE_INCLUDES})
  madori_read_together(madori_${name})
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
  madori_read_together(${name})
  # What a test measures is compiled in its room; the tests themselves take a fifth less of the build so.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_compile_definitions(${name} PRIVATE
    MADORI_SOURCE_DIR="${PROJECT_SOURCE_DIR}" MADORI_BINARY_DIR="${PROJECT_BINARY_DIR}"
    MADORI_SHARED_DATA="${PROJECT_SOURCE_DIR}/../shared/data")
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS "${TEST_LABELS}" TIMEOUT ${TEST_TIMEOUT}
    ENVIRONMENT_MODIFICATION "LSAN_OPTIONS=set:suppressions=${PROJECT_SOURCE_DIR}/tests/leaks_elsewhere.txt:print_suppressions=0")
endfunction()
