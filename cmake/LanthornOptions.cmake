# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
# Build options, and the one interface target that carries every compiler flag.
set(LANTHORN_ARCH native CACHE STRING "Instruction set, as -march= names it: native is that of this machine, x86-64-v2 runs on all since 2009")
option(LANTHORN_BUILD_TESTS "Build the tests" ON)
option(LANTHORN_BUILD_VIEWER "Build what draws by OpenGL: the methods ispm and voxelcones and the window of lanthorn view" ON)
option(LANTHORN_BUILD_MPI "Build the module that lets several processes share a render under mpirun" ON)
option(LANTHORN_BUILD_BENCH "Build the benchmarks" OFF)
option(LANTHORN_BUILD_FUZZERS "Build the libFuzzer targets (Clang only)" OFF)
option(LANTHORN_UNITY "Compile several sources of a folder at once: a clean build is faster, a rebuild slower" OFF)
option(LANTHORN_FULL_PRECISION_PHOTONS "Store photons in full precision (bounds the quantisation error in tests)" OFF)
option(LANTHORN_WERROR "Treat warnings as errors" OFF)
set(LANTHORN_SANITIZE "" CACHE STRING "Sanitizers to build with, e.g. address,undefined or thread")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

add_library(lanthorn_flags INTERFACE)
target_compile_options(lanthorn_flags INTERFACE
  -Wall -Wextra -Wshadow -Wconversion
  # sqrt and friends inline without errno; neither flag changes a result (no -ffast-math: see docs/design.md).
  -fno-math-errno -fno-trapping-math
  # Functions inline within their file although objects are position-independent: nobody replaces ours at run time.
  -fno-semantic-interposition)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # GCC stops inlining in a source that has grown by two fifths, unless it is small. Sources that are compiled as one
  # (LANTHORN_UNITY) reached that early: their code was 5 % slower than that of the same sources one by one.
  target_compile_options(lanthorn_flags INTERFACE --param=large-unit-insns=1000000)
endif()
target_compile_definitions(lanthorn_flags INTERFACE GLM_FORCE_CXX17 GLM_FORCE_XYZW_ONLY SPDLOG_FMT_EXTERNAL FMT_HEADER_ONLY=0)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
target_compile_options(lanthorn_flags INTERFACE -march=${LANTHORN_ARCH})
if(LANTHORN_WERROR)
  target_compile_options(lanthorn_flags INTERFACE -Werror)
  # What the optimiser of GCC believes of lengths and lifetimes depends on what it inlines, and so on the instruction set:
  # such a warning is shown, but a build must not fail on one machine alone.
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(lanthorn_flags INTERFACE
      -Wno-error=array-bounds -Wno-error=dangling-pointer -Wno-error=free-nonheap-object -Wno-error=maybe-uninitialized
      -Wno-error=nonnull -Wno-error=restrict -Wno-error=stringop-overflow -Wno-error=stringop-overread
      -Wno-error=use-after-free)
  endif()
endif()
if(LANTHORN_FULL_PRECISION_PHOTONS)
  target_compile_definitions(lanthorn_flags INTERFACE LANTHORN_FULL_PRECISION_PHOTONS)
endif()
if(LANTHORN_SANITIZE)
  target_compile_options(lanthorn_flags INTERFACE -fsanitize=${LANTHORN_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(lanthorn_flags INTERFACE -fsanitize=${LANTHORN_SANITIZE})
  if(LANTHORN_SANITIZE MATCHES thread)
    target_include_directories(lanthorn_flags BEFORE INTERFACE ${CMAKE_CURRENT_SOURCE_DIR}/tests/support/tsan)
  endif()
endif()
