#include "planning/smoke_shadow_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/row_packer.hpp"

namespace brume::planning {
namespace {

/// The part of a light's face in which smoke may be visible.
struct FacePart {
  std::uint32_t index = 0;             // into the plan's faces
  glm::vec2 low{1e30f}, high{-1e30f};  // uv
  float metres = 0;                    // what the whole face spans at the far end of the smoke
  float coarseness = 1;                // how much larger its texels may be than the brightest light's
  bool is_soft = false;                // its light is a ball
  bool is_sun = false;
  bool empty() const { return low.x >= high.x || low.y >= high.y; }
};

float least_distance(glm::vec3 p, const Box<float>& box) {
  return glm::length(glm::max(glm::max(box.low - p, p - box.high), glm::vec3(0)));
}

/// Bounds of x / z for x in [low, high] and z in [near, far], near > 0.
glm::vec2 slopes(float low, float high, float near, float far) {
  return {low / (low > 0 ? far : near), high / (high > 0 ? near : far)};
}

/// Adds what a cube face sees of a box.
void add_to_cube_face(FacePart& part, const shared::Light& light, std::uint32_t face, const Box<float>& box) {
  constexpr float kNearest = 1e-3f;
  const glm::vec3 forward = shared::cube_forward(face), right = shared::cube_right(face),
                  up = shared::cube_up(face);
  // The face's axes are the world's up to their signs.
  const glm::vec3 low = box.low - light.position_world, high = box.high - light.position_world;
  const auto along = [&](glm::vec3 axis) {
    const float a = glm::dot(axis, low), b = glm::dot(axis, high);
    return glm::vec2(std::min(a, b), std::max(a, b));
  };
  const glm::vec2 z = along(forward), x = along(right), y = along(up);
  const float near = std::max(z.x, kNearest), far = std::min(z.y, light.range);
  if (far <= near) return;
  const glm::vec2 u = slopes(x.x, x.y, near, far), v = slopes(-y.y, -y.x, near, far);
  if (u.x >= 1 || u.y <= -1 || v.x >= 1 || v.y <= -1) return;
  part.low = glm::min(part.low, glm::clamp(0.5f * glm::vec2(u.x, v.x) + 0.5f, 0.0f, 1.0f));
  part.high = glm::max(part.high, glm::clamp(0.5f * glm::vec2(u.y, v.y) + 0.5f, 0.0f, 1.0f));
  part.metres = std::max(part.metres, 2 * far);
}

void add_to_sun(FacePart& part, const glm::mat4& clip_from_world, const Box<float>& box) {
  for (int corner = 0; corner < 8; ++corner) {
    const glm::bvec3 side(corner & 1, corner & 2, corner & 4);
    const glm::vec3 p = glm::mix(box.low, box.high, side);
    const glm::vec2 uv = glm::clamp(0.5f * glm::vec2(clip_from_world * glm::vec4(p, 1)) + 0.5f, 0.0f, 1.0f);
    part.low = glm::min(part.low, uv);
    part.high = glm::max(part.high, uv);
  }
  const glm::vec3 row(clip_from_world[0].x, clip_from_world[1].x, clip_from_world[2].x);
  part.metres = 2 / glm::length(row);
}

/// Whether a spot shines into a cube face: a corner is 54.74 degrees off the face's axis.
bool shines_into(const shared::Light& light, std::uint32_t face) {
  if (light.kind != shared::kLightSpot) return true;
  const float angle =
      std::acos(std::clamp(glm::dot(light.direction, shared::cube_forward(face)), -1.0f, 1.0f));
  return angle < std::acos(std::clamp(light.cos_outer, -1.0f, 1.0f)) + 0.9554f;
}

/// The parts of all lights, the brightest on smoke first.
FrameVector<FacePart> find_parts(const SmokeShadowScene& scene, std::span<const Box<float>> smoke,
                                 Allocator memory) {
  FrameVector<FacePart> parts(memory);
  FrameVector<float> irradiance(memory);
  const ViewFrustum view(scene.camera);
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const shared::Light& light = scene.lights[i];
    const float intensity = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
    const bool sun = light.kind == shared::kLightDirectional;
    if (light.shadow_layer == shared::kNoShadow || intensity <= 0) continue;
    if (!sun && !view.may_intersect({light.position_world, light.range})) continue;
    std::array<FacePart, shared::kFacesPerLight> faces;
    float nearest = sun ? 1 : light.range;
    for (const Box<float>& box : smoke) {
      const float distance = sun ? 1 : least_distance(light.position_world, box);
      if (!sun && distance >= light.range) continue;
      nearest = std::min(nearest, distance);
      if (sun) add_to_sun(faces[0], scene.sun_clip_from_world, box);
      for (std::uint32_t face = 0; !sun && face < faces.size(); ++face)
        if (shines_into(light, face)) add_to_cube_face(faces[face], light, face, box);
    }
    for (std::uint32_t face = 0; face < faces.size(); ++face) {
      if (faces[face].empty()) continue;
      faces[face].index = shared::kFacesPerLight * i + face;
      faces[face].is_soft = light.radius > 0;
      faces[face].is_sun = sun;
      parts.push_back(faces[face]);
      const float at_nearest = sun ? intensity : intensity / std::max(nearest * nearest, 0.25f);
      irradiance.push_back(light.radius > 0 ? 0 : at_nearest);
    }
  }
  // A light of a sixteenth of the brightest has half the resolution.
  const float brightest = irradiance.empty() ? 1 : *std::max_element(irradiance.begin(), irradiance.end());
  for (std::size_t i = 0; i < parts.size(); ++i)
    parts[i].coarseness = std::clamp(std::pow(brightest / irradiance[i], 0.25f), 1.0f, 4.0f);
  return parts;
}

/// A rectangle of the atlas for a part.
struct FaceRectangle {
  shared::SmokeShadowFace face{};
  const FacePart* part = nullptr;
};

/// Rectangles row by row, the highest first; false where they do not fit.
bool pack(std::span<const FacePart> parts, float texel_metres, glm::uvec2 atlas,
          FrameVector<FaceRectangle>& rectangles, SmokeShadowPlan& plan) {
  // Texels of a whole face. The shadows of a ball have no edges.
  constexpr float kLeastScale = 16, kMostScale = 2048, kSoftScale = 8;
  rectangles.clear();
  for (const FacePart& part : parts) {
    shared::SmokeShadowFace face{};
    face.scale = std::clamp(part.metres / (texel_metres * part.coarseness), kLeastScale, kMostScale);
    if (part.is_soft) face.scale = kSoftScale;
    face.size = glm::uvec2(glm::ceil((part.high - part.low) * face.scale)) + 2u;
    rectangles.push_back({face, &part});
  }
  std::sort(rectangles.begin(), rectangles.end(), [](const FaceRectangle& a, const FaceRectangle& b) {
    return a.face.size.y != b.face.size.y ? a.face.size.y > b.face.size.y : a.part < b.part;
  });
  RowPacker packer(atlas);
  for (auto& [face, part] : rectangles) {
    const auto low = packer.place(face.size);
    if (!low) return false;
    face.first_texel = *low;
    face.offset = glm::vec2(*low) + 1.0f - part->low * face.scale;
    plan.faces[part->index] = face;
  }
  return true;
}

}  // namespace

bool SmokeShadowPlan::operator==(const SmokeShadowPlan& other) const {
  return blocks == other.blocks && faces.size() == other.faces.size() &&
         (faces.empty() ||
          std::memcmp(faces.data(), other.faces.data(), faces.size() * sizeof faces[0]) == 0);
}

SmokeShadowPlan SmokeShadowPlan::spread_by(std::uint32_t spread, Allocator memory) const {
  SmokeShadowPlan plan{{faces, memory}, 0};
  for (shared::SmokeShadowFace& face : plan.faces) {
    face.first_block = plan.blocks;
    const glm::uvec2 face_blocks = shared::smoke_shadow_blocks(face.size, spread);
    plan.blocks += face_blocks.x * face_blocks.y;
  }
  return plan;
}

SmokeShadowPlan plan_smoke_shadows(const SmokeShadowScene& scene, std::span<const Box<float>> smoke,
                                   glm::uvec2 atlas_size, Allocator memory) {
  SmokeShadowPlan plan{.faces = FrameVector<shared::SmokeShadowFace>(memory)};
  FrameVector<FacePart> parts = find_parts(scene, smoke, memory);
  FrameVector<FaceRectangle> rectangles(memory);
  rectangles.reserve(parts.size());
  const auto try_size = [&](float texel_metres) {
    plan.faces.assign(scene.lights.size() * shared::kFacesPerLight, {});
    return pack(parts, texel_metres, atlas_size, rectangles, plan);
  };
  // Larger and larger texels until all fit; beyond 2 m fewer lights, but the sun remains, however large they
  // are.
  float texel_metres = kFinestSmokeShadow;
  auto suns_end = parts.begin();
  for (auto part = parts.begin(); part != parts.end(); ++part)
    if (part->is_sun) std::rotate(suns_end++, part, part + 1);
  while (!try_size(texel_metres)) {
    if (texel_metres < 2 || parts.back().is_sun)
      texel_metres *= 1.2f;
    else
      parts.pop_back();
  }
  return plan.spread_by(1, memory);
}

}  // namespace brume::planning
