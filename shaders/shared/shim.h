// Makes one header compile as C++ and as GLSL: the names of GLSL in C++, and macros for what only one of the two has.
// Structs in this folder have one layout in both languages: members follow each other without gaps, as `scalar` says in
// GLSL. Devices need not enable the feature scalarBlockLayout, so that members lie only where Vulkan allows it without:
//
// - A vector does not cross a multiple of 16 bytes: a number or padding follows a vec3. A PackedVec3 lies anywhere.
// - A struct with a vector of three or four, or with a matrix, begins at a multiple of 16 bytes, also in arrays, and so
//   does what follows it; with a vec2, at one of 8. In uniform buffers all structs begin at multiples of 16.
// - A matrix is a mat4 or an Affine: columns of three numbers would not do.
// - `float padding SHARED_ZERO;` fills a gap.
//
// The build refuses shaders with other layouts, and says which struct is wrong (cmake/BrumeShaders.cmake). Members are
// float, int, uint, vecN, ivecN, uvecN, the types of this file, and structs of them. A SHARED_SIZE follows each struct
// that lies in buffers, SHARED_LOCAL(type) one that only functions use: its members may lie anyhow.
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
//   77       the sun's shadow map         light.h
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
using glm::mat4, glm::mat4x3, glm::bvec3;
using glm::cos, glm::exp, glm::log, glm::log2, glm::pow, glm::sin, glm::sqrt, glm::tan;
using glm::acos, glm::atan;
using glm::normalize, glm::sign, glm::smoothstep, glm::step;
using glm::packSnorm2x16, glm::unpackSnorm2x16, glm::unpackUnorm4x8;
using glm::floatBitsToUint, glm::uintBitsToFloat;
using uint = std::uint32_t;
/// Returns the same bits on every processor. Shaders use the built-in exp.
inline float portable_exp(float x) { return static_cast<float>(portable::exp(double{x})); }

// Vectors that lie anywhere in a struct.
using PackedVec2 = vec2;
using PackedVec3 = vec3;
using PackedVec4 = vec4;
using PackedIvec3 = ivec3;

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
#define SHARED_ZERO = {}
#define SHARED_SIZE(type, bytes) static_assert(sizeof(type) == (bytes))
#define SHARED_LOCAL(type) struct type
#define SHARED_BINDING(name, number) constexpr BindingIndex name{number, #name}
#else
#define portable_exp exp
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_FUNCTION
#define SHARED_CONST const
#define SHARED_ZERO
#define SHARED_SIZE(type, bytes)
#define SHARED_LOCAL(type)
#define SHARED_BINDING(name, number) const uint name = number
struct PackedVec2 {
  float x, y;
};
struct PackedVec3 {
  float x, y, z;
};
struct PackedVec4 {
  float x, y, z, w;
};
struct PackedIvec3 {
  int x, y, z;
};
vec2 unpacked(PackedVec2 v) { return vec2(v.x, v.y); }
vec3 unpacked(PackedVec3 v) { return vec3(v.x, v.y, v.z); }
vec4 unpacked(PackedVec4 v) { return vec4(v.x, v.y, v.z, v.w); }
ivec3 unpacked(PackedIvec3 v) { return ivec3(v.x, v.y, v.z); }
PackedVec3 packed_of(vec3 v) { return PackedVec3(v.x, v.y, v.z); }
#endif

SHARED_BEGIN

/// A matrix of four columns of three numbers, such as an affine transform, by rows.
struct Affine {
  vec4 row0, row1, row2;
};
SHARED_SIZE(Affine, 48);

SHARED_FUNCTION Affine affine_of(mat4x3 m) {
  Affine rows;
  rows.row0 = vec4(m[0].x, m[1].x, m[2].x, m[3].x);
  rows.row1 = vec4(m[0].y, m[1].y, m[2].y, m[3].y);
  rows.row2 = vec4(m[0].z, m[1].z, m[2].z, m[3].z);
  return rows;
}
SHARED_FUNCTION mat4x3 matrix_of(Affine rows) {
  return mat4x3(rows.row0.x, rows.row1.x, rows.row2.x, rows.row0.y, rows.row1.y, rows.row2.y, rows.row0.z, rows.row1.z,
                rows.row2.z, rows.row0.w, rows.row1.w, rows.row2.w);
}

SHARED_END

#endif
