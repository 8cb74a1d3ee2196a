#include "reference/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/box.hpp"
#include "planning/device_lights.hpp"
#include "reference/smoke_medium.hpp"
#include "reference/volume_medium.hpp"
#include "shared/hash.h"
#include "shared/spot.h"

namespace brume::reference {
namespace {

using surfaces::Emitter;

/// The stars of lib/sky.glsl.
float star_light(const glm::vec3& direction) {
  const glm::vec3 a = glm::abs(direction);
  const glm::vec3 on_cube = direction / std::max({a.x, a.y, a.z}) * 64.0f;
  const glm::uvec3 cell(glm::ivec3(glm::floor(on_cube)) + 1024);
  const glm::vec3 random = shared::hash3(cell), more = shared::hash3(cell + 4096u);
  if (more.x > 0.3f) return 0;
  const glm::vec3 star = (glm::floor(on_cube) + 0.1f + 0.8f * random) / 64.0f;
  const float offset = glm::length(glm::normalize(star) - direction);
  return (0.04f + std::pow(more.y, 10.0f)) * (1 - glm::smoothstep(0.0003f, 0.0016f, offset));
}

/// Where volume i is at the steps of the shutter, from where it is at first; empty: it rests.
std::vector<glm::mat4> motion_of(std::size_t i, const planning::FrameInput& frame,
                                 std::span<const planning::FrameInput> later) {
  const glm::mat4& first = frame.volumes[i].world_from_voxel;
  std::vector<glm::mat4> motion{glm::mat4(1)};
  bool moves = false;
  for (const planning::FrameInput& step : later) {
    if (step.volumes.size() != frame.volumes.size()) return {};
    const glm::mat4& then = step.volumes[i].world_from_voxel;
    moves = moves || then != first;
    motion.emplace_back(glm::dmat4(then) * glm::inverse(glm::dmat4(first)));
  }
  return moves ? motion : std::vector<glm::mat4>();
}

/// Whether media are at some of the points of a grid within a distance of another point, at some time.
bool holds_media(const Media& media, const glm::vec3& p_world, float distance) {
  constexpr int kSteps = 4;
  for (int step = 0; step <= kSteps; ++step)
    for (const auto& medium : media.all()) {
      bool found = false;
      for_each_in(Box<int>{glm::ivec3(-3), glm::ivec3(4)}, [&](glm::ivec3 cell) {
        const glm::vec3 from = glm::vec3(cell) / 3.0f;
        if (found || glm::dot(from, from) > 1) return;
        const Ray here{p_world + distance * from, {0, 0, 1}, 0, static_cast<float>(step) / kSteps};
        found = medium->collisions(medium->at_rest(here).origin) > 0;
      });
      if (found) return true;
    }
  return false;
}

}  // namespace

glm::vec3 Environment::seen(const glm::vec3& direction) const {
  const float height = std::max(direction.y, 0.0f);
  const glm::vec3 gradient = glm::mix(sky.horizon, sky.zenith, 1 - std::exp(-4 * height));
  if (sky.stars <= 0) return gradient;
  return gradient + sky.stars * star_light(direction) * glm::smoothstep(0.02f, 0.3f, direction.y);
}

glm::vec3 Environment::lighting(const glm::vec3& direction) const {
  return sky.ambient * (shape.x + shape.y * direction.y);
}

Incident light_at(const shared::Light& light, const glm::vec3& p_world) {
  if (light.kind == shared::kLightDirectional)
    return {light.intensity, -light.direction, std::numeric_limits<float>::infinity()};
  const glm::vec3 to_light = light.position_world - p_world;
  const float d2 = std::max(glm::dot(to_light, to_light), 1e-12f), distance = std::sqrt(d2);
  Incident incident{light.intensity / std::max(d2, kConstantWithin * kConstantWithin), to_light / distance,
                    distance};
  if (light.kind == shared::kLightSpot)
    incident.irradiance *=
        shared::spot_falloff(light.cos_inner, light.cos_outer, glm::dot(-incident.to_light, light.direction));
  return incident;
}

void sum_emitters(Scene& scene) {
  scene.power_up_to.clear();
  scene.emitted_power = 0;
  for (const Emitter& emitter : scene.surfaces.emitters()) {
    scene.emitted_power +=
        std::max({emitter.radiance.r, emitter.radiance.g, emitter.radiance.b}) * emitter.area;
    scene.power_up_to.push_back(scene.emitted_power);
  }
}

void find_near_lights(Scene& scene) {
  scene.near_lights.clear();
  if (!(scene.near > 0)) return;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const shared::Light& light = scene.lights[i];
    if (light.kind == shared::kLightDirectional || light.intensity == glm::vec3(0)) continue;
    const float cosine = light.kind == shared::kLightSpot ? light.cos_outer : -1;
    if (cosine < 1 && holds_media(scene.media, light.position_world, scene.near))
      scene.near_lights.push_back({i, 2 * std::numbers::pi_v<float> * (1 - cosine)});
  }
}

std::unique_ptr<Scene> make_scene(const scene::Scene& scene, const planning::FrameInput& frame,
                                  const smoke::MaskAtlas* masks, bool matte,
                                  std::span<const planning::FrameInput> later) {
  std::vector<std::unique_ptr<Medium>> media;
  if (frame.smoke.volume && frame.smoke.volume->slot_count() > 0 && frame.smoke.look.extinction > 0)
    media.push_back(std::make_unique<SmokeMedium>(frame.smoke, smoke::smoke_noise, masks));
  for (std::size_t i = 0; i < frame.volumes.size(); ++i) {
    media.push_back(std::make_unique<VolumeMedium>(frame.volumes[i], smoke::smoke_noise));
    media.back()->set_motion(motion_of(i, frame, later));
  }
  std::vector<shared::Light> lights = planning::device_lights(scene.lights, 0);
  lights.insert(lights.end(), frame.environment.flashes.begin(), frame.environment.flashes.end());
  std::vector<planning::LevelState> levels{frame.level};
  for (const planning::FrameInput& step : later) levels.push_back(step.level);
  std::unique_ptr<Scene> out(new Scene{
      {scene, levels, matte}, Media(std::move(media)), std::move(lights), {.sky = frame.environment.sky}});
  sum_emitters(*out);
  find_near_lights(*out);
  return out;
}

}  // namespace brume::reference
