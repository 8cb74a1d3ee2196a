# How tests are declared. A table of them for script/test: which room each belongs to, and which rooms a change of which
# can reach it.
include_guard(GLOBAL)
include(BrumeTargets)

# What the sources of tests have in common: they are optimized little, since to compile them is the longer part. Not at
# all would be too little: under the sanitizers, tests then run four times as long. What is tested is optimized. The
# checks of the address sanitizer are calls: a sixth less time to compile.
set(brume_test_flags "$<$<CONFIG:Release,RelWithDebInfo,Debug>:-Og>"
                     "$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>")
if(BRUME_SANITIZE MATCHES "address" AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  list(APPEND brume_test_flags "SHELL:--param asan-instrumentation-with-call-threshold=0")
endif()
# Programs that render have one more, whose templates take longer than all others to compile.
function(brume_test_options target)
  set(headers brume_test_headers)
  set(rendered "")
  if("brume::film" IN_LIST ARGN OR "render_truth" IN_LIST ARGN)
    set(headers brume_render_test_headers)
    set(rendered brume::film)
  endif()
  if(NOT TARGET ${headers})
    set(sources ${brume_common_headers} <random> <gtest/gtest.h>)
    if(rendered)
      list(APPEND sources ${PROJECT_SOURCE_DIR}/src/render/renderer.hpp)
    endif()
    brume_precompiled(${headers} ${sources} LINKS GTest::gtest ${rendered})
    # The compiler rejects precompiled headers with other sanitizers.
    target_compile_options(${headers} PRIVATE "${brume_test_flags}")
  endif()
  brume_precompile(${target} ${headers})
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
  target_compile_options(${target} PRIVATE "${brume_test_flags}")
endfunction()

# brume_test_library(NAME sources... LINKS libraries...): what several test programs use, compiled once.
function(brume_test_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINKS")
  add_library(${name} STATIC ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PUBLIC brume_options ${arg_LINKS} GTest::gtest)
  brume_test_options(${name} ${arg_LINKS})
endfunction()

# The CPU seconds of each test that takes more than one: "NAME SECONDS" a line. The long ones begin first, and
# tests/house compares what they take with it.
set(budgets ${PROJECT_SOURCE_DIR}/tests/budgets.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${budgets})
file(STRINGS ${budgets} lines REGEX "^[a-z]")
foreach(line IN LISTS lines)
  if(NOT line MATCHES "^([a-z0-9_]+) +([0-9]+)$")
    message(FATAL_ERROR "tests/budgets.txt: expected 'NAME SECONDS', found '${line}'")
  endif()
  set_property(GLOBAL PROPERTY brume_budget_${CMAKE_MATCH_1} ${CMAKE_MATCH_2})
endforeach()

# brume_add_test(NAME TARGET LABELS labels... COMMAND command... [TIMEOUT seconds]): an entry of CTest that TARGET
# builds, and its line in the table. Its room is the folder, unless that sets `brume_room`. The label ci is for tests that
# script/test leaves to --ci, slow for those that --ci leaves to --all.
function(brume_add_test name target)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "TIMEOUT" "LABELS;COMMAND")
  get_property(cost GLOBAL PROPERTY brume_budget_${name})
  if(NOT cost)
    set(cost 1)
  endif()
  # Only ends a hang: a machine may be three times slower, and busy with several times as much.
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 1200)
  endif()
  math(EXPR patience "30 * ${cost}")
  if(arg_TIMEOUT LESS patience)
    set(arg_TIMEOUT ${patience})
  endif()
  if(NOT brume_room)
    get_filename_component(brume_room ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  endif()
  add_test(NAME ${name} COMMAND ${PROJECT_SOURCE_DIR}/tests/timed ${name} ${arg_COMMAND})
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT} COST ${cost})
  list(JOIN arg_LABELS "," labels)
  set_property(GLOBAL APPEND PROPERTY brume_tests "${name} ${target} ${brume_room} ${labels} ${cost}")
endfunction()

# The file of a program under the name of an entry of CTest, by which reports are named.
function(brume_link_test name program result)
  set(link $<TARGET_FILE_DIR:${program}>/${name})
  add_custom_command(TARGET ${program} POST_BUILD COMMAND ${CMAKE_COMMAND} -E create_symlink $<TARGET_FILE_NAME:${program}> ${link})
  set(${result} ${link} PARENT_SCOPE)
endfunction()

# brume_test(NAME sources... LINKS libraries... LABELS labels... [TIMEOUT seconds] [CI_CASES filters...]
# [SLOW_CASES filters...]): a GoogleTest program. A program is one entry of CTest: starting a Vulkan device for each case
# would cost more than the cases. CI_CASES and SLOW_CASES, filters of GoogleTest, are entries of their own, NAME_ci and
# NAME_slow, with the labels ci and slow; their programs are links with those names, by which reports are named.
function(brume_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "TIMEOUT" "LINKS;LABELS;CI_CASES;SLOW_CASES")
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  brume_test_options(${name} ${arg_LINKS})
  target_link_libraries(${name} PRIVATE brume_options ${arg_LINKS} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE BRUME_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  set(timeout TIMEOUT ${arg_TIMEOUT})
  set(later "")
  foreach(tier IN ITEMS ci slow)
    string(TOUPPER ${tier} key)
    if(arg_${key}_CASES)
      list(JOIN arg_${key}_CASES ":" cases)
      list(APPEND later ${cases})
      brume_link_test(${name}_${tier} ${name} link)
      brume_add_test(${name}_${tier} ${name} LABELS ${arg_LABELS} ${tier} COMMAND ${link} --gtest_filter=${cases}
                     ${timeout})
    endif()
  endforeach()
  if(later)
    list(JOIN later ":" later)
    set(filter --gtest_filter=-${later})
  endif()
  brume_add_test(${name} ${name} LABELS ${arg_LABELS} COMMAND $<TARGET_FILE:${name}> ${filter} ${timeout})
endfunction()

# brume_thorough_test(NAME PROGRAM WHAT LABELS labels... [FILTER cases] [TIMEOUT seconds]): a program of brume_test once
# more, which repeats WHAT as often as it can (tests/thorough.hpp).
function(brume_thorough_test name program what)
  cmake_parse_arguments(PARSE_ARGV 3 arg "" "FILTER;TIMEOUT" "LABELS")
  if(NOT arg_FILTER)
    set(arg_FILTER *)
  endif()
  brume_link_test(${name} ${program} link)
  brume_add_test(${name} ${program} LABELS ${arg_LABELS} TIMEOUT ${arg_TIMEOUT}
                 COMMAND ${CMAKE_COMMAND} -E env BRUME_THOROUGH=${what} ${link} --gtest_filter=${arg_FILTER})
endfunction()

# The two drivers of Debian 12 that draw on any CPU: Mesa's, and the one in chromium-common.
find_file(BRUME_LAVAPIPE lvp_icd.x86_64.json PATHS /usr/share/vulkan/icd.d NO_DEFAULT_PATH)
find_file(BRUME_SWIFTSHADER vk_swiftshader_icd.json PATHS /usr/lib/chromium NO_DEFAULT_PATH)

# brume_devices_test(PROGRAMS...): runs GPU programs of brume_test on two more devices, as tests of their own:
# PROGRAM_swiftshader, and PROGRAM_lavapipe_4 on lavapipe with four threads in a subgroup (docs/reference/devices.md).
function(brume_devices_test)
  foreach(program IN LISTS ARGN)
    if(BRUME_SWIFTSHADER)
      brume_link_test(${program}_swiftshader ${program} link)
      brume_add_test(${program}_swiftshader ${program} LABELS gpu slow TIMEOUT 7200
                     COMMAND ${CMAKE_COMMAND} -E env VK_DRIVER_FILES=${BRUME_SWIFTSHADER} ${link})
    endif()
    if(BRUME_LAVAPIPE)
      # Mesa's cache does not distinguish numbers of threads.
      brume_link_test(${program}_lavapipe_4 ${program} link)
      brume_add_test(${program}_lavapipe_4 ${program} LABELS gpu slow TIMEOUT 7200
                     COMMAND ${CMAKE_COMMAND} -E env VK_DRIVER_FILES=${BRUME_LAVAPIPE} LP_NATIVE_VECTOR_WIDTH=128
                             MESA_SHADER_CACHE_DIR=${PROJECT_BINARY_DIR}/mesa_4 ${link})
    endif()
  endforeach()
endfunction()

# The rooms of a target: its own folder below src or apps, and the folders of everything that it links or runs.
function(brume_rooms_of target result)
  set(aliased "")
  if(TARGET ${target})
    get_target_property(aliased ${target} ALIASED_TARGET)
  endif()
  if(aliased)
    set(target ${aliased})
  endif()
  get_property(known GLOBAL PROPERTY brume_rooms_of_${target} SET)
  if(NOT known)
    # Set before the others are visited, as libraries may form circles.
    set_property(GLOBAL PROPERTY brume_rooms_of_${target} "")
    set(rooms "")
    set(imported ON)
    if(TARGET ${target})
      get_target_property(imported ${target} IMPORTED)
    endif()
    if(NOT imported)
      get_target_property(folder ${target} SOURCE_DIR)
      file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
      string(REGEX REPLACE "^(src|apps)/" "" folder "${folder}")
      if(NOT folder MATCHES "^tests" AND folder MATCHES "^[a-z]+")
        list(APPEND rooms ${CMAKE_MATCH_0})
      endif()
      foreach(property IN ITEMS LINK_LIBRARIES INTERFACE_LINK_LIBRARIES MANUALLY_ADDED_DEPENDENCIES)
        get_target_property(others ${target} ${property})
        foreach(other IN LISTS others)
          string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" other "${other}")
          if(TARGET "${other}")
            brume_rooms_of(${other} of_other)
            list(APPEND rooms ${of_other})
          endif()
        endforeach()
      endforeach()
    endif()
    list(REMOVE_DUPLICATES rooms)
    set_property(GLOBAL PROPERTY brume_rooms_of_${target} "${rooms}")
  endif()
  get_property(rooms GLOBAL PROPERTY brume_rooms_of_${target})
  set(${result} "${rooms}" PARENT_SCOPE)
endfunction()

# tests.txt in the build folder: "NAME TARGET ROOM LABELS SECONDS ROOMS" a line, lists with commas. Comes after all
# targets.
function(brume_write_test_table)
  get_property(tests GLOBAL PROPERTY brume_tests)
  set(table "")
  foreach(test IN LISTS tests)
    string(REGEX MATCH "^[^ ]+ ([^ ]+)" _ "${test}")
    brume_rooms_of(${CMAKE_MATCH_1} rooms)
    list(JOIN rooms "," rooms)
    string(APPEND table "${test} ${rooms}\n")
  endforeach()
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/tests.txt CONTENT "${table}" @ONLY)
endfunction()
