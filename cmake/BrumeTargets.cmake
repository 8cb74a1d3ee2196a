# One way to declare the targets of the house.
include_guard(GLOBAL)

# Options that every target shares.
add_library(brume_options INTERFACE)
target_compile_features(brume_options INTERFACE cxx_std_20)
target_compile_options(brume_options INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror
                                               # which -Wconversion of clang includes, and that of g++ does not
                                               $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>
                                               # which g++ 12 gives falsely for sums of strings, as inlining falls
                                               # (https://gcc.gnu.org/PR105651): shown, but no error
                                               $<$<CXX_COMPILER_ID:GNU>:-Wno-error=array-bounds -Wno-error=restrict
                                                                           -Wno-error=stringop-overflow>)
# One rounding everywhere: no fused multiply-add, which g++ makes of a * b + c where the processor has one, and
# which rounds once instead of twice (docs/how/simulation.md).
target_compile_options(brume_options INTERFACE -ffp-contract=off)
target_include_directories(brume_options INTERFACE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/shaders)
target_compile_definitions(brume_options INTERFACE GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_FORCE_EXPLICIT_CTOR)
if(EMSCRIPTEN)
  # Exceptions and vectors of WebAssembly itself: smaller and faster than what Emscripten emulates. Sizes have 32 bits;
  # those from files are checked in 64 bits.
  target_compile_options(brume_options INTERFACE -fwasm-exceptions -msimd128 -Wno-shorten-64-to-32
                                                 "$<$<COMPILE_LANGUAGE:CXX>:SHELL:-include ${PROJECT_SOURCE_DIR}/examples/web/cxx_gaps/gaps.hpp>")
  target_include_directories(brume_options SYSTEM INTERFACE ${PROJECT_SOURCE_DIR}/examples/web/cxx_gaps)
  target_link_options(brume_options INTERFACE -fwasm-exceptions -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=67108864)
endif()
# Of the whole folder, which come before the options of single targets: these may take checks away.
if(BRUME_SANITIZE)
  add_compile_options(-fsanitize=${BRUME_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${BRUME_SANITIZE})
  # The checks of every pointer are most of what the undefined behaviour sanitizer adds, and who follows a bad pointer
  # crashes or meets the address sanitizer. The fuzzers keep them; all others those of arithmetic and bounds.
  if(BRUME_SANITIZE MATCHES "undefined" AND NOT BRUME_FUZZ)
    add_compile_options(-fno-sanitize=null,alignment,vptr,object-size,nonnull-attribute,returns-nonnull-attribute)
  endif()
endif()
if(BRUME_PORTABLE)
  target_link_options(brume_options INTERFACE -static-libstdc++ -static-libgcc)
endif()

# A scene file or a command line is read once: the templates of the readers cost more to optimize than they run.
# Release builds only; a build without optimization stays one.
set(brume_cold_options "$<$<CONFIG:Release>:-O1>")
function(brume_cold)
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS "${brume_cold_options}")
endfunction()
# The same for all of a target, whose work is done by the libraries below it.
function(brume_cold_target target)
  target_compile_options(${target} PRIVATE "${brume_cold_options}")
endfunction()

# Headers of others that nearly every file reads, compiled once for all targets. A source still includes what it uses:
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON builds without. Not with ccache, which would find nothing of such a file again,
# and not where single targets have flags of their own, as the fuzzers do.
if(BRUME_FUZZ OR CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache")
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
set(brume_common_headers <algorithm> <array> <bit> <cmath> <cstdint> <cstdio> <cstring> <filesystem> <functional>
    <limits> <map> <memory> <optional> <span> <string> <utility> <vector> <glm/glm.hpp>)

# brume_precompiled(NAME headers... LINKS libraries...): what brume_precompile then gives to other targets.
function(brume_precompiled name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINKS")
  set(source ${PROJECT_BINARY_DIR}/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// What CMake compiles the headers for.\n")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE brume_options ${arg_LINKS})
  target_precompile_headers(${name} PRIVATE ${arg_UNPARSED_ARGUMENTS})
  target_compile_options(${name} PRIVATE -fPIC)
endfunction()

# The property would compile programs with -fPIE, for which there would have to be a second set of headers.
function(brume_precompile target name)
  target_compile_options(${target} PRIVATE -fPIC)
  target_precompile_headers(${target} REUSE_FROM ${name})
endfunction()

brume_precompiled(brume_headers ${brume_common_headers})

# The libraries in which the tests of the debug preset spend their time, and which its -O1 is for. The sanitizers multiply
# the code of the others, which compile for longer than they then run: -Og for them, with all checks. Of those that take
# longest to compile they are calls, which takes a fifth less.
set(brume_busy_libraries voxel volume trace sim smoke surfaces reference)
set(brume_large_libraries image scene_files scenario planning)

# brume_library(NAME sources... LINKS libraries... PRIVATE_LINKS libraries...): this folder as brume::NAME.
function(brume_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINKS;PRIVATE_LINKS")
  add_library(brume_${name} STATIC ${arg_UNPARSED_ARGUMENTS})
  add_library(brume::${name} ALIAS brume_${name})
  target_link_libraries(brume_${name} PUBLIC brume_options ${arg_LINKS} PRIVATE ${arg_PRIVATE_LINKS})
  set_target_properties(brume_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  if(BRUME_SANITIZE AND NOT name IN_LIST brume_busy_libraries)
    target_compile_options(brume_${name} PRIVATE $<$<CONFIG:Debug>:-Og>)
  endif()
  if(BRUME_SANITIZE MATCHES "address" AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND name IN_LIST brume_large_libraries)
    target_compile_options(brume_${name} PRIVATE "SHELL:--param asan-instrumentation-with-call-threshold=0")
  endif()
  brume_precompile(brume_${name} brume_headers)
endfunction()

# brume_alone(sources...): with names that other sources of their folder also use, and which therefore do not share a
# translation unit with them. The presets join up to 24 sources of a target, script/determinism all: most of the time
# to compile goes to headers and templates that many sources use.
function(brume_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# brume_exports(LIBRARY SYMBOLS): a shared library that exports the functions of include/brume alone: no symbol of the
# static libraries or of the C++ runtime's templates. SYMBOLS is a version script of GNU ld; on Windows the headers say
# what is exported.
function(brume_exports library symbols)
  set_target_properties(${library} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_link_options(${library} PRIVATE -Wl,--gc-sections)
  if(WIN32)
    set_target_properties(${library} PROPERTIES PREFIX "")
    return()
  endif()
  set_target_properties(${library} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION 0 LINK_DEPENDS ${symbols})
  target_link_options(${library} PRIVATE -Wl,--version-script=${symbols} -Wl,-Bsymbolic-functions)
  if(NOT BRUME_SANITIZE)
    target_link_options(${library} PRIVATE -Wl,--no-undefined)
  endif()
endfunction()

# The archives that a target links, its own and those below it.
function(brume_archives_of target result)
  set(found "")
  foreach(property IN ITEMS LINK_LIBRARIES INTERFACE_LINK_LIBRARIES)
    get_target_property(others ${target} ${property})
    foreach(other IN LISTS others)
      string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" other "${other}")
      if(TARGET "${other}")
        get_target_property(aliased ${other} ALIASED_TARGET)
        if(aliased)
          set(other ${aliased})
        endif()
        get_property(visited GLOBAL PROPERTY brume_archive_visits)
        if(other IN_LIST visited)
          continue()
        endif()
        set_property(GLOBAL APPEND PROPERTY brume_archive_visits ${other})
        get_target_property(type ${other} TYPE)
        if(type STREQUAL "STATIC_LIBRARY")
          list(APPEND found $<TARGET_FILE:${other}>)
        endif()
        brume_archives_of(${other} below)
        list(APPEND found ${below})
      elseif(other MATCHES "[.]a$")
        list(APPEND found ${other})
      endif()
    endforeach()
  endforeach()
  set(${result} "${found}" PARENT_SCOPE)
endfunction()

# brume_static(NAME LIBRARY objects...): libNAME.a, one archive of the objects and of all archives that LIBRARY links.
function(brume_static name library)
  add_library(${name} STATIC ${ARGN})
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  set_property(GLOBAL PROPERTY brume_archive_visits "")
  brume_archives_of(${library} archives)
  list(REMOVE_DUPLICATES archives)
  list(TRANSFORM archives PREPEND "addlib " OUTPUT_VARIABLE lines)
  list(JOIN lines "\n" lines)
  set(archive $<TARGET_FILE:${name}>)
  file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.mri
       CONTENT "create ${archive}.all\naddlib ${archive}\n${lines}\nsave\nend\n")
  add_custom_command(TARGET ${name} POST_BUILD VERBATIM
                     COMMAND sh -c "'${CMAKE_AR}' -M < '${CMAKE_CURRENT_BINARY_DIR}/${name}.mri'"
                     COMMAND ${CMAKE_COMMAND} -E rename ${archive}.all ${archive})
  add_dependencies(${name} ${library})
endfunction()
