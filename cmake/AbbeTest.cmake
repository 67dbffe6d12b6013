include(GoogleTest)

# The tests labelled unit, and the program that some of them run: what sanitizers need built.
add_custom_target(unit_tests)
add_dependencies(unit_tests abbe)

# abbe_test(<name> SOURCES ... LINKS ... [LABEL unit|scenes|nightly] [TIMEOUT seconds] [NIGHTLY seconds])
#
# One GoogleTest executable, each of its tests registered with CTest under the tier's label; all of them once more for the night where NIGHTLY
# says how long they may then take, with ABBE_NIGHTLY in their environment, by which tests do more (tests/tier.h). Tests whose names begin with
# Nightly are for the night alone.
function(abbe_test name)
  cmake_parse_arguments(TEST "" "LABEL;TIMEOUT;NIGHTLY" "SOURCES;LINKS" ${ARGN})
  if(NOT TEST_LABEL)
    set(TEST_LABEL unit)
  endif()
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  add_executable(test_${name} ${TEST_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${TEST_LINKS} GTest::gtest_main)
  abbe_plain_options(test_${name})
  abbe_common_options(test_${name})  # as of any build, so that those of a release serve its sanitizers too
  if(TEST_LABEL STREQUAL "unit")
    add_dependencies(unit_tests test_${name})
  endif()
  gtest_discover_tests(test_${name}
    TEST_PREFIX ${name}.
    TEST_FILTER -Nightly*
    DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS ${TEST_LABEL} TIMEOUT ${TEST_TIMEOUT} ENVIRONMENT "ABBE_DATA=${PROJECT_SOURCE_DIR}/data")
  if(TEST_NIGHTLY)
    gtest_discover_tests(test_${name}
      TEST_PREFIX ${name}_nightly.
      DISCOVERY_TIMEOUT 60
      PROPERTIES LABELS nightly TIMEOUT ${TEST_NIGHTLY} ENVIRONMENT "ABBE_DATA=${PROJECT_SOURCE_DIR}/data"
        ENVIRONMENT_MODIFICATION ABBE_NIGHTLY=set:1)  # gtest_discover_tests takes no lists
  endif()
endfunction()

# abbe_python_tests(<module> PREFIX name CASES classes... TIMEOUT seconds [PATH folder] [NIGHTLY]): classes of Debian's Python and its unittest
# in the folder's <module>_test.py, which run the program and read what it wrote with numpy and OpenImageIO; none where Python
# has not both.
function(abbe_python_tests module)
  cmake_parse_arguments(TEST "NIGHTLY" "TIMEOUT;PATH;PREFIX" "CASES" ${ARGN})
  set(label scenes)
  set(nightly "")
  if(TEST_NIGHTLY)
    set(label nightly)
    set(nightly ";ABBE_NIGHTLY=1")
  endif()
  if(NOT Python_EXECUTABLE)
    return()
  endif()
  execute_process(COMMAND "${Python_EXECUTABLE}" -c "import numpy, OpenImageIO" RESULT_VARIABLE missing OUTPUT_QUIET ERROR_QUIET)
  if(NOT missing EQUAL 0)
    return()
  endif()
  foreach(case ${TEST_CASES})
    add_test(NAME ${TEST_PREFIX}.${case} COMMAND "${Python_EXECUTABLE}" -B -m unittest -v ${module}_test.${case} WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
    set_tests_properties(${TEST_PREFIX}.${case} PROPERTIES LABELS ${label} TIMEOUT ${TEST_TIMEOUT}
      ENVIRONMENT "ABBE_BINARY=$<TARGET_FILE:abbe>;ABBE_DATA=${PROJECT_SOURCE_DIR}/data;PYTHONPATH=${TEST_PATH}${nightly}")
  endforeach()
endfunction()
