#include "tests/textures/shadow_maps.hpp"

#include <limits>
#include <stdexcept>

#include "core/tasks.hpp"
#include "trace/triangle_tree.hpp"

namespace brume::textures {
namespace {

constexpr int kEdge = 256;
/// Half the width of a sun's map, and how far behind the origin its rays begin [m].
constexpr float kSunReach = 20, kSunFar = 100;

glm::vec3 face_direction(int face, float u, float v) {
  const float s = face % 2 == 0 ? 1.0f : -1.0f;
  if (face < 2) return {s, v, u};
  if (face < 4) return {u, s, v};
  return {u, v, s};
}

float distance_along(RTCScene scene, glm::vec3 from, glm::vec3 direction) {
  RTCRayHit hit{};
  hit.ray.org_x = from.x, hit.ray.org_y = from.y, hit.ray.org_z = from.z;
  hit.ray.dir_x = direction.x, hit.ray.dir_y = direction.y, hit.ray.dir_z = direction.z;
  hit.ray.tfar = std::numeric_limits<float>::infinity();
  hit.ray.mask = ~0u;
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  trace::embree().Intersect1(scene, &context, &hit);
  return std::min(hit.ray.tfar, 1e6f);
}

}  // namespace

glm::vec3 sun_right(glm::vec3 direction) {
  return glm::normalize(
      glm::cross(direction, std::abs(direction.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
}

FloatMap shadow_maps(const std::vector<scene::Light>& lights, const std::vector<voxel::Triangle>& triangles) {
  std::vector<glm::vec3> corners;
  std::vector<std::uint32_t> indices;
  for (const voxel::Triangle& t : triangles)
    for (const glm::vec3 corner : {t.a, t.b, t.c}) {
      indices.push_back(static_cast<std::uint32_t>(corners.size()));
      corners.push_back(corner);
    }
  trace::TriangleTree tree;
  const trace::TriangleMesh mesh{corners, indices};
  if (const auto built = tree.build("shadows", {&mesh, 1}); !built)
    throw std::runtime_error(built.failure().message);

  FloatMap maps{"shadows", kEdge, kEdge, static_cast<int>(6 * lights.size()), {}};
  constexpr auto kFace = static_cast<std::size_t>(kEdge * kEdge);
  maps.values.resize(kFace * 6 * lights.size());
  parallel_for(6 * lights.size() * kEdge, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const scene::Light& light = lights[row / (6 * kEdge)];
      const bool sun = light.kind == scene::LightKind::directional;
      const int face = static_cast<int>(row / kEdge % 6);
      if (sun && face > 0) continue;
      const float v = 2 * (static_cast<float>(row % kEdge) + 0.5f) / kEdge - 1;
      for (int x = 0; x < kEdge; ++x) {
        const float u = 2 * (static_cast<float>(x) + 0.5f) / kEdge - 1;
        glm::vec3 from = light.position_world, direction = glm::normalize(face_direction(face, u, v));
        if (sun) {
          direction = light.direction_world;
          const glm::vec3 right = sun_right(direction), up = glm::cross(right, direction);
          from = kSunReach * (u * right + v * up) - kSunFar * direction;
        }
        maps.values[row * kEdge + static_cast<std::size_t>(x)] =
            distance_along(tree.scene(), from, direction);
      }
    }
  });
  return maps;
}

const std::string kShadowLookup = R"(
uniform highp sampler2DArray shadows;
float shadow_tap(ivec2 at, int layer, float distance) {
  return texelFetch(shadows, ivec3(clamp(at, ivec2(0), ivec2(255)), layer), 0).r > distance - 0.06 ? 1.0 : 0.0;
}
float shadow_layer(vec2 uv, int layer, float distance) {
  vec2 texel = (0.5 * uv + 0.5) * 256.0 - 0.5;
  ivec2 low = ivec2(floor(texel));
  vec2 f = texel - vec2(low);
  return mix(mix(shadow_tap(low, layer, distance), shadow_tap(low + ivec2(1, 0), layer, distance), f.x),
             mix(shadow_tap(low + ivec2(0, 1), layer, distance), shadow_tap(low + ivec2(1, 1), layer, distance), f.x),
             f.y);
}
float light_shadow(int light, vec3 from_light) {
  vec3 a = abs(from_light);
  float longest = max(a.x, max(a.y, a.z));
  vec3 d = from_light / longest;
  int face = a.x == longest ? (d.x > 0.0 ? 0 : 1) : a.y == longest ? (d.y > 0.0 ? 2 : 3) : (d.z > 0.0 ? 4 : 5);
  vec2 uv = face < 2 ? d.zy : face < 4 ? d.xz : d.xy;
  return shadow_layer(uv, 6 * light + face, length(from_light));
}
float sun_shadow(int light, vec3 position, vec3 direction, vec3 right) {
  vec3 up = cross(right, direction);
  vec2 uv = vec2(dot(position, right), dot(position, up)) / 20.0;
  return shadow_layer(uv, 6 * light, dot(position, direction) + 100.0);
}
)";

}  // namespace brume::textures
