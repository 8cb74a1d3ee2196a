# Compiles every entry point under shaders/ to SPIR-V at build time, checks it and embeds it. Structs must lie where
# Vulkan 1.2 allows them without features such as scalarBlockLayout (shaders/shared/shim.h).
include_guard(GLOBAL)
find_program(GLSLC glslc REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)

# brume_shaders(TARGET files...): a library with one constant per shader, named after its file and declared in
# TARGET.hpp. Files of HLSL are compute shaders.
function(brume_shaders target)
  set(sources "")
  foreach(file ${ARGN})
    get_filename_component(name ${file} NAME)
    string(REPLACE "." "_" symbol ${name})
    set(spv ${CMAKE_CURRENT_BINARY_DIR}/${name}.spv)
    set(words ${CMAKE_CURRENT_BINARY_DIR}/${name}.words)
    set(cpp ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
    # SPIR-V 1.5: newer versions would require maintenance4 from the device of a host.
    set(flags -Werror -O --target-env=vulkan1.2 -I ${PROJECT_SOURCE_DIR}/shaders -I ${PROJECT_SOURCE_DIR})
    if(name MATCHES "[.]hlsl$")
      # A texture and its sampler become one binding, as passes bind them. The compiler declares buffers of HLSL in a form
      # that SPIR-V 1.3 is the last to have.
      list(APPEND flags -fshader-stage=compute -fauto-combined-image-sampler --target-spv=spv1.3)
    endif()
    # What is refused is compiled again, with names of structs.
    string(CONCAT check "'${SPIRV_VAL}' --target-env vulkan1.2 '${spv}' || "
                        "{ '${GLSLC}' \"$@\" && '${SPIRV_VAL}' --target-env vulkan1.2 '${spv}.named'; exit 1; }")
    add_custom_command(
      OUTPUT ${spv}
      COMMAND ${GLSLC} ${flags} -MD -MF ${spv}.d -o ${spv} ${CMAKE_CURRENT_SOURCE_DIR}/${file}
      COMMAND sh -c "${check}" check ${flags} -O0 -g -o ${spv}.named ${CMAKE_CURRENT_SOURCE_DIR}/${file}
      DEPENDS ${file} DEPFILE ${spv}.d VERBATIM)
    add_custom_command(
      OUTPUT ${words}
      COMMAND sh -c "od -An -v -tx4 '${spv}' | sed 's/ \\([0-9a-f]*\\)/0x\\1,/g' > '${words}'"
      DEPENDS ${spv} VERBATIM)
    file(CONFIGURE OUTPUT ${cpp} CONTENT
"#include \"@target@.hpp\"
namespace brume::shaders {
static const unsigned @symbol@_words[] = {
#include \"@name@.words\"
};
const gpu::ShaderCode @symbol@{\"@name@\", @symbol@_words};
}
" @ONLY)
    list(APPEND sources ${cpp} ${words})
    set(declarations "${declarations}extern const gpu::ShaderCode ${symbol};\n")
  endforeach()
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/include/${target}.hpp CONTENT
"// The embedded shaders, one constant per file.
#pragma once
#include \"gpu/shader_code.hpp\"
namespace brume::shaders {
@declarations@}
" @ONLY)
  add_library(${target} STATIC ${sources})
  target_include_directories(${target} PUBLIC ${CMAKE_CURRENT_BINARY_DIR}/include PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
  target_link_libraries(${target} PUBLIC brume_options)
endfunction()
