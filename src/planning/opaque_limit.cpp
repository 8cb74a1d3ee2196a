#include "planning/opaque_limit.hpp"

#include <algorithm>
#include <numbers>

#include "planning/blackbody.hpp"

namespace brume::planning {
namespace {

constexpr float kPaint = 0.5f;  // albedo

float largest(const glm::vec3& radiance) {
  return std::max({radiance.r, radiance.g, radiance.b});
}

/// What moves may be anywhere.
bool is_in_view(const Emitter& emitter, const LevelState& level, const ViewFrustum& frustum) {
  if (std::ranges::binary_search(level.hidden_objects, emitter.object)) return false;
  const bool moves =
      std::ranges::find(level.moved, emitter.object, &scene::MovedObject::object) != level.moved.end();
  return moves || frustum.may_intersect(emitter.bounds);
}

/// Radiance of an opaque part of a volume, or of a part as thick as the volume's shortest side.
float brightest_in(const VolumeInput& volume, const PlacedVolume& placed) {
  float brightest = largest(placed.instance.look.emission);
  const HeatInput& heat = volume.heat;
  if (heat.volume)
    brightest = std::max(brightest, heat.emission * largest(blackbody_color(heat.kelvin * heat.high)));
  const glm::vec3 size = placed.bounds_world.high - placed.bounds_world.low;
  for (const glm::vec3& per_metre : volume.tints)
    brightest = std::max(brightest, largest(per_metre) * std::min({size.x, size.y, size.z}));
  return brightest;
}

}  // namespace

float brightest_behind(const FrameInput& input, const ViewFrustum& frustum, std::span<const Emitter> emitters,
                       const MediaPlan& media, std::span<const shared::Light> lights) {
  const shared::Sky& sky = input.environment.sky;
  float brightest = std::max(largest(sky.horizon), largest(sky.zenith));
  for (const Emitter& emitter : emitters)
    if (emitter.radiance > brightest && is_in_view(emitter, input.level, frustum))
      brightest = emitter.radiance;
  for (const shared::Light& light : lights)
    if (light.kind == shared::kLightDirectional)
      brightest = std::max(brightest, largest(light.intensity) * kPaint / std::numbers::pi_v<float>);
  for (const PlacedVolume& placed : volumes_in_view(media))
    brightest = std::max(brightest, brightest_in(input.volumes[placed.index], placed));
  return brightest;
}

}  // namespace brume::planning
