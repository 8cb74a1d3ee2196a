// Makes one header compile as C++ and as GLSL: the names of GLSL in C++, and macros for what only one of the two has.
// Structs in this folder use float, int, uint, vecN, ivecN, uvecN, matN and mat4x3 only, in `scalar` layout.
//
// SHARED_BINDING(kBindPages, 1u) declares where a resource is bound: `layout(binding = kBindPages)` in GLSL,
// `{shared::kBindPages, gpu::read(pages)}` in C++. What several passes read has one number in all of them:
//
//   0        the frame's constants           frame.h
//   1 - 10   the smoke volume                smoke_volume.h
//   11 - 15  holes                           hole_clusters.h
//   16 - 17  the level                       solid_volume.h, sky_light.h
//   18 - 20  lights and their shadow maps    light.h
//   21 - 22  noise                           noise.h
//   23 - 26  the G-buffer                    gbuffer.h
//   27 - 31  volumes besides the smoke       volume.h
//   53 - 54  their transfer functions and colours
//   55       volumes as slices            slice_texture.h
//   56 - 59  particles                    particles.h
//   80 - 81  light paths of tanks         photons.h
//   82 - 91  indirect light               indirect_light.h
//   94       fine shadows in smoke        light_side.h
//   103 - 105  fine light in smoke        fine_light.h
//   106      detail of the noise          noise.h
//   32 -     resources of one pass, or of a few that never meet in one shader
#ifndef BRUME_SHIM_H
#define BRUME_SHIM_H

#ifdef __cplusplus
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "core/portable_math.hpp"
namespace brume::shared {
using glm::abs, glm::clamp, glm::cross, glm::dot, glm::floor, glm::fract, glm::length, glm::max, glm::min,
    glm::lessThanEqual, glm::mix;
using glm::ivec2, glm::ivec3, glm::ivec4, glm::uvec2, glm::uvec3, glm::uvec4, glm::vec2, glm::vec3, glm::vec4;
using glm::mat3, glm::mat4, glm::mat4x3, glm::bvec3;
using glm::cos, glm::exp, glm::log, glm::log2, glm::pow, glm::sin, glm::sqrt, glm::tan;
using glm::acos, glm::atan;
using glm::normalize, glm::sign, glm::smoothstep, glm::step;
using glm::packSnorm2x16, glm::unpackSnorm2x16, glm::unpackUnorm4x8;
using glm::floatBitsToUint, glm::uintBitsToFloat;
using uint = std::uint32_t;
/// Returns the same bits on every processor. Shaders use the built-in exp.
inline float portable_exp(float x) { return static_cast<float>(portable::exp(double{x})); }

/// Where a shader has a resource, and what the shared header calls it.
struct BindingIndex final {
  uint number;
  const char* name;
};
}  // namespace brume::shared
#define SHARED_BEGIN namespace brume::shared {
#define SHARED_END }
#define SHARED_FUNCTION inline
#define SHARED_CONST constexpr
#define SHARED_SIZE(type, bytes) static_assert(sizeof(type) == (bytes))
#define SHARED_BINDING(name, number) constexpr BindingIndex name{number, #name}
#else
#define portable_exp exp
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_FUNCTION
#define SHARED_CONST const
#define SHARED_SIZE(type, bytes)
#define SHARED_BINDING(name, number) const uint name = number
#endif

#endif
