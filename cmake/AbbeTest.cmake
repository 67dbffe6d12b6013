include(GoogleTest)

# The tests labelled unit, and the program that some of them run: what sanitizers need built.
add_custom_target(unit_tests)
add_dependencies(unit_tests abbe)

# abbe_test(<name> SOURCES ... LINKS ... [LABEL unit|scenes|nightly] [TIMEOUT seconds])
#
# One GoogleTest executable, each of its tests registered with CTest under the tier's label.
function(abbe_test name)
  cmake_parse_arguments(TEST "" "LABEL;TIMEOUT" "SOURCES;LINKS" ${ARGN})
  if(NOT TEST_LABEL)
    set(TEST_LABEL unit)
  endif()
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  add_executable(test_${name} ${TEST_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${TEST_LINKS} GTest::gtest_main)
  abbe_compile_options(test_${name})
  if(TEST_LABEL STREQUAL "unit")
    add_dependencies(unit_tests test_${name})
  endif()
  gtest_discover_tests(test_${name}
    TEST_PREFIX ${name}.
    DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS ${TEST_LABEL} TIMEOUT ${TEST_TIMEOUT} ENVIRONMENT "ABBE_DATA=${PROJECT_SOURCE_DIR}/data")
endfunction()
