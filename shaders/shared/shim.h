// One header for C++ and GLSL: the names of GLSL in C++, and the words that only one of the two knows.
// Structs in this folder use float, int, uint, vecN, ivecN, uvecN and matN only, `scalar` layout.
#ifndef BRUME_SHIM_H
#define BRUME_SHIM_H

#ifdef __cplusplus
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
namespace brume::shared {
using glm::abs, glm::clamp, glm::cross, glm::dot, glm::floor, glm::fract, glm::length, glm::max, glm::min,
    glm::mix;
using glm::ivec2, glm::ivec3, glm::ivec4, glm::uvec2, glm::uvec3, glm::uvec4, glm::vec2, glm::vec3, glm::vec4;
using glm::mat3, glm::mat4, glm::bvec3;
using glm::cos, glm::exp, glm::log, glm::pow, glm::sqrt, glm::tan;
using glm::normalize, glm::sign, glm::smoothstep, glm::step, glm::unpackUnorm4x8;
using uint = std::uint32_t;
}  // namespace brume::shared
#define SHARED_BEGIN namespace brume::shared {
#define SHARED_END }
#define SHARED_FUNCTION inline
#define SHARED_CONST constexpr
#define SHARED_SIZE(type, bytes) static_assert(sizeof(type) == (bytes))
#else
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_FUNCTION
#define SHARED_CONST const
#define SHARED_SIZE(type, bytes)
#endif

#endif
