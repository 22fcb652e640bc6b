# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0

# One folder of src/ is one module: a static library lanthorn_NAME whose DEPENDS are the modules it may include. Its
# SOURCES are by default all .cpp files of the folder, so that a new file is listed nowhere; an INTERFACE module has none.
#   lanthorn_module(cache DEPENDS math spectrum LIBRARIES TBB::tbb)
# Third-party LIBRARIES are linked as SYSTEM so that their headers raise no warnings here.
function(lanthorn_module name)
  cmake_parse_arguments(ARG "INTERFACE" "" "SOURCES;DEPENDS;LIBRARIES" ${ARGN})
  set(scope PUBLIC)
  if(ARG_INTERFACE)
    set(scope INTERFACE)
    add_library(lanthorn_${name} INTERFACE)
  else()
    if(NOT ARG_SOURCES)
      file(GLOB_RECURSE ARG_SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
    endif()
    add_library(lanthorn_${name} STATIC ${ARG_SOURCES})
    set_property(GLOBAL APPEND PROPERTY LANTHORN_OBJECTS $<TARGET_OBJECTS:lanthorn_${name}>)
  endif()
  set_property(GLOBAL APPEND PROPERTY LANTHORN_MODULES lanthorn_${name})
  target_include_directories(lanthorn_${name} ${scope} ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  list(TRANSFORM ARG_DEPENDS PREPEND lanthorn_)
  target_link_libraries(lanthorn_${name} ${scope} lanthorn_flags ${ARG_DEPENDS} ${ARG_LIBRARIES})
endfunction()

# What tests that render include, compiled once. (Unit tests name too many things that it would bring along.)
function(lanthorn_test_headers name)
  add_library(${name} OBJECT ${PROJECT_SOURCE_DIR}/tests/support/precompiled.cpp)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_options(${name} PRIVATE -fPIE $<$<CONFIG:Release>:-O1>)  # as test programs are compiled
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_link_libraries(${name} PRIVATE lanthorn_api GTest::gtest)
  target_precompile_headers(${name} PRIVATE <gtest/gtest.h> "${PROJECT_SOURCE_DIR}/tests/support/render_scene.h")
endfunction()

# Tells SOURCE, by a macro, the file of the module TARGET, which it opens. dlopen finds the module by the RUNPATH of the
# program, but not where a sanitizer calls it instead of the program.
function(lanthorn_opens_module source macro target)
  set(module $<TARGET_FILE_NAME:${target}>)
  if(LANTHORN_SANITIZE)
    set(module $<TARGET_FILE:${target}>)
  endif()
  set_source_files_properties(${source} PROPERTIES COMPILE_DEFINITIONS ${macro}="${module}")
endfunction()

# One test program:
#   lanthorn_test(unit_index KIND unit SOURCES kdtree_test.cpp MODULES index [LIBRARIES ...] [SHARDS n] [NIGHTLY])
# Its label is its KIND. ctest runs it whole, or as SHARDS tests of about equal length that can run side by side. Kinds
# that fail fastest are started first. With NIGHTLY, suites whose names begin with Nightly are a test of their own,
# <name>_long, with the label nightly.
function(lanthorn_test name)
  cmake_parse_arguments(ARG "NIGHTLY" "KIND;SHARDS" "SOURCES;MODULES;LIBRARIES" ${ARGN})
  list(TRANSFORM ARG_MODULES PREPEND lanthorn_)
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${name} PRIVATE ${ARG_MODULES} ${ARG_LIBRARIES} GTest::gtest GTest::gtest_main)
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)  # what takes long to run is in the library
  if(NOT ARG_KIND MATCHES "unit|cli" AND lanthorn_api IN_LIST ARG_MODULES)
    # With fewer modules macros differ, which precompiled headers do not forgive.
    target_precompile_headers(${name} REUSE_FROM lanthorn_test_headers)
  endif()
  target_compile_definitions(${name} PRIVATE
    LANTHORN_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    LANTHORN_PROGRAM="${CMAKE_BINARY_DIR}/bin/lanthorn")
  set(kinds conformance transport cli statistical unit)
  list(FIND kinds ${ARG_KIND} priority)
  if(NOT ARG_SHARDS)
    set(ARG_SHARDS 1)
  endif()
  foreach(shard RANGE 1 ${ARG_SHARDS})
    set(test ${name})
    if(ARG_SHARDS GREATER 1)
      set(test ${name}_${shard})
    endif()
    math(EXPR index "${shard} - 1")
    add_test(NAME ${test} COMMAND ${name})
    set_tests_properties(${test} PROPERTIES LABELS ${ARG_KIND} TIMEOUT 2400 COST ${priority}
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${ARG_SHARDS};GTEST_SHARD_INDEX=${index};GTEST_FILTER=-Nightly*")
  endforeach()
  if(ARG_NIGHTLY)
    add_test(NAME ${name}_long COMMAND ${name} --gtest_filter=Nightly*)
    set_tests_properties(${name}_long PROPERTIES LABELS "${ARG_KIND};nightly" TIMEOUT 14400)
  endif()
endfunction()
