# Functions that declare the targets of the project.
include_guard(GLOBAL)

# Options of all targets.
add_library(brume_options INTERFACE)
target_compile_features(brume_options INTERFACE cxx_std_20)
target_compile_options(brume_options INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror)
# Identical rounding on every machine: no fused multiply-add, which g++ emits for a * b + c if the processor has it,
# and which rounds once instead of twice (docs/determinism.md).
target_compile_options(brume_options INTERFACE -ffp-contract=off)
target_include_directories(brume_options INTERFACE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/shaders)
target_compile_definitions(brume_options INTERFACE GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_FORCE_EXPLICIT_CTOR)
if(BRUME_SANITIZE)
  target_compile_options(brume_options INTERFACE -fsanitize=${BRUME_SANITIZE} -fno-omit-frame-pointer
                                                 -fno-sanitize-recover=all)
  target_link_options(brume_options INTERFACE -fsanitize=${BRUME_SANITIZE})
endif()
if(BRUME_PORTABLE)
  target_link_options(brume_options INTERFACE -static-libstdc++ -static-libgcc)
endif()

# Sources that run once per process, such as parsers: optimizing their templates costs more time than it saves.
# Affects release builds only.
function(brume_cold)
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS "$<$<CONFIG:Release>:-O1>")
endfunction()

# Precompiles the external headers that nearly every file includes, once for all targets. Sources still include what
# they use: -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON builds without. Off with ccache, which gets no hits with them, and for the
# fuzzers, whose targets have flags of their own.
if(BRUME_FUZZ OR CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache")
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
set(brume_common_headers <algorithm> <array> <bit> <cmath> <cstdint> <cstdio> <cstring> <filesystem> <functional>
    <limits> <map> <memory> <optional> <span> <string> <utility> <vector> <glm/glm.hpp>)

# brume_precompiled(NAME headers... LINKS libraries...): precompiled headers for brume_precompile.
function(brume_precompiled name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINKS")
  set(source ${PROJECT_BINARY_DIR}/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// CMake attaches the precompiled headers to this source.\n")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE brume_options ${arg_LINKS})
  target_precompile_headers(${name} PRIVATE ${arg_UNPARSED_ARGUMENTS})
  target_compile_options(${name} PRIVATE -fPIC)
endfunction()

# brume_precompile(TARGET NAME): reuses precompiled headers. -fPIC for programs too: with CMake's -fPIE they would need
# a second set of headers.
function(brume_precompile target name)
  target_compile_options(${target} PRIVATE -fPIC)
  target_precompile_headers(${target} REUSE_FROM ${name})
endfunction()

brume_precompiled(brume_headers ${brume_common_headers})

# brume_library(NAME sources... LINKS libraries... PRIVATE_LINKS libraries...): the folder `NAME` as brume::NAME.
function(brume_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINKS;PRIVATE_LINKS")
  add_library(brume_${name} STATIC ${arg_UNPARSED_ARGUMENTS})
  add_library(brume::${name} ALIAS brume_${name})
  target_link_libraries(brume_${name} PUBLIC brume_options ${arg_LINKS} PRIVATE ${arg_PRIVATE_LINKS})
  set_target_properties(brume_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  brume_precompile(brume_${name} brume_headers)
endfunction()

# What the sources of tests have in common: they are optimized little, under the sanitizers not at all, since to
# compile them is the longer part. What is tested keeps its optimization.
set(brume_test_optimization
    "$<$<CONFIG:Release>:-O1;-Wno-maybe-uninitialized>" "$<$<CONFIG:Debug,RelWithDebInfo>:-O0>")
function(brume_test_options target)
  if(NOT TARGET brume_test_headers)
    brume_precompiled(brume_test_headers ${brume_common_headers} <random> <gtest/gtest.h> LINKS GTest::gtest)
    # Headers that were compiled with optimization are not taken without.
    target_compile_options(brume_test_headers PRIVATE ${brume_test_optimization})
  endif()
  brume_precompile(${target} brume_test_headers)
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
  target_compile_options(${target} PRIVATE ${brume_test_optimization})
endfunction()

# brume_test_library(NAME sources... LINKS libraries...): what several test programs use, compiled once.
function(brume_test_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINKS")
  add_library(${name} STATIC ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PUBLIC brume_options ${arg_LINKS} GTest::gtest)
  brume_test_options(${name})
endfunction()

# brume_test(NAME sources... LINKS libraries... LABELS labels...): a GoogleTest program that CTest runs.
# The label one_thread marks programs that use threads only through code that other tests cover; script/test skips them
# under the thread sanitizer. COST is the approximate duration in seconds of slow tests, which start first. TIMEOUT only
# ends tests that hang: a busy machine may take ten times as long as an idle one. A program is one CTest entry, because
# creating a Vulkan device for every case would take longer than the cases.
function(brume_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "TIMEOUT;COST" "LINKS;LABELS")
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 1800)
  endif()
  if(NOT arg_COST)
    set(arg_COST 1)
  endif()
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  brume_test_options(${name})
  target_link_libraries(${name} PRIVATE brume_options ${arg_LINKS} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE BRUME_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT} COST ${arg_COST})
endfunction()
