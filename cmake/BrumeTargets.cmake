# One way to declare the targets of the house.
include_guard(GLOBAL)

# Options that every target shares.
add_library(brume_options INTERFACE)
target_compile_features(brume_options INTERFACE cxx_std_20)
target_compile_options(brume_options INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror)
# One rounding everywhere: no fused multiply-add, which g++ makes of a * b + c where the processor has one, and
# which rounds once instead of twice (docs/determinism.md).
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

# brume_library(NAME sources... LINKS libraries... PRIVATE_LINKS libraries...): the folder `NAME` as brume::NAME.
function(brume_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINKS;PRIVATE_LINKS")
  add_library(brume_${name} STATIC ${arg_UNPARSED_ARGUMENTS})
  add_library(brume::${name} ALIAS brume_${name})
  target_link_libraries(brume_${name} PUBLIC brume_options ${arg_LINKS} PRIVATE ${arg_PRIVATE_LINKS})
  set_target_properties(brume_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()

# brume_test(NAME sources... LINKS libraries... LABELS labels...): a GoogleTest program that CTest runs.
# The label one_thread is for programs that use no threads but through what others test: the thread sanitizer leaves
# them out. COST is about how many seconds it takes where that is much: the long ones begin first. TIMEOUT only ends
# what hangs: a busy machine may take ten times as long as an idle one. A program is one CTest entry: starting a Vulkan device for each case would cost more than the cases.
function(brume_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "TIMEOUT;COST" "LINKS;LABELS")
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 1800)
  endif()
  if(NOT arg_COST)
    set(arg_COST 1)
  endif()
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE brume_options ${arg_LINKS} GTest::gtest GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE BRUME_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT} COST ${arg_COST})
endfunction()
