// A timeline on the stage of somebody else's engine: in the C interface, with lights and shadows of the
// engine.
#pragma once

#include <brume/brume_textures.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenario/events.hpp"
#include "scenario/scenario.hpp"
#include "scenario/world_triangles.hpp"
#include "scene/camera_path.hpp"
#include "shared/light.h"
#include "tests/api/event_structs.hpp"
#include "tests/textures/gl_engine.hpp"
#include "tests/textures/shadow_maps.hpp"

namespace brume::textures {

constexpr std::uint32_t kTicks = 64;

/// The lights of a scene in the shader of the engine: inverse squares with a window at their range, and
/// cones.
inline const std::string kLights = R"(
uniform highp sampler2DArray distances;
uniform vec4 light_count, ambient, look;  // look: albedo, g
uniform vec4 light_at[15], light_intensity[15], light_forward[15];  // w: kind, range; of a sun the axis across
uniform vec4 light_cone[15];

vec3 brume_light(vec3 position, vec3 texel, vec3 direction) {
  vec2 sky = brume_sky_at(texel);
  vec3 sum = vec3(0.0);
  vec3 on_ground = vec3(0.0);
  for (int i = 0; i < int(light_count.x); ++i) {
    vec3 to = light_at[i].w > 1.5 ? light_at[i].xyz : light_at[i].xyz - position;
    float d2 = dot(to, to);
    vec3 towards = to * inversesqrt(d2);
    float falloff = 1.0;
    if (light_at[i].w < 1.5) {
      float x = d2 / (light_intensity[i].w * light_intensity[i].w);
      float window = clamp(1.0 - x * x, 0.0, 1.0);
      falloff = window * window / max(d2, 0.01);
    }
    if (light_at[i].w > 0.5 && light_at[i].w < 1.5) {
      float cosine = dot(-towards, light_forward[i].xyz);
      float spot = clamp((cosine - light_cone[i].y) / max(light_cone[i].x - light_cone[i].y, 1e-4), 0.0, 1.0);
      falloff *= spot * spot;
    }
    float lit = light_at[i].w > 1.5 ? sun_shadow(i, position, -towards, light_forward[i].xyz)
                                   : light_shadow(i, position - light_at[i].xyz);
    if (lit <= 0.0) continue;
    vec3 arriving = light_intensity[i].rgb * falloff * lit;
    float depth = brume_light_at(texel, i).x;
    sum += arriving * brume_scattered(depth, dot(towards, direction), look.rgb, look.a, sky.x);
    if (light_at[i].w > 1.5) on_ground += arriving * max(towards.y, 0.0);
  }
  vec3 reflected = ambient.a * (ambient.rgb + on_ground / 3.14159265);
  return sum + brume_scattered_sky(sky, ambient.rgb, reflected, look.rgb, look.a);
}
)";

/// A scene in the C interface.
class Stage {
 public:
  explicit Stage(scenario::Scenario loaded) : scenario_(std::move(loaded)) {
    for (const voxel::Triangle& t : scenario::world_triangles(scenario_.scene))
      for (const glm::vec3 corner : {t.a, t.b, t.c}) {
        indices_.push_back(static_cast<std::uint32_t>(points_.size()));
        points_.push_back({corner.x, corner.y, corner.z});
      }
    const voxel::GridLayout& layout = scenario_.voxels.grid.layout();
    brume_triangles_params mesh = brume_triangles_defaults();
    mesh.layout = {{layout.size.x, layout.size.y, layout.size.z},
                   layout.voxel_size,
                   {layout.origin_world.x, layout.origin_world.y, layout.origin_world.z}};
    mesh.points = points_.data();
    mesh.point_count = points_.size();
    mesh.indices = indices_.data();
    mesh.index_count = indices_.size();
    level_.emplace(context_, mesh);
    make_world();
  }
  void show(GlEngine& engine, double seconds) {
    const auto tick = static_cast<std::uint32_t>(seconds * kTicks);
    world_->advance_to(tick);
    field_->update(world_->state());
    const brume_drawn_params look = drawn();
    brume_textures_params params = brume_textures_defaults();
    params.look = &look;
    params.swirl_seconds = static_cast<float>(scenario_.timeline.smoke.swirl_period);
    params.light_count = static_cast<std::uint32_t>(scenario_.scene.lights.size());
    params.sky = 1;
    textures_.emplace(*field_, params);
    std::vector<brume_texture_light> lights;
    for (const scene::Light& light : scenario_.scene.lights) {
      const bool sun = light.kind == scene::LightKind::directional;
      const glm::vec3 at = sun ? -light.direction_world : light.position_world;
      lights.push_back({sun ? 1u : 0u, {at.x, at.y, at.z}});
    }
    brume_textures_frame frame = brume_textures_frame_defaults();
    frame.seconds = seconds;
    frame.lights = lights.data();
    textures_->update(*field_, frame);
    engine.follow(textures_->get());
  }
  Eye eye(double seconds) const {
    const scene::Camera camera = scene::camera_at(scenario_.timeline, scenario_.camera, seconds);
    return Eye::looking(camera.position_world, camera.target_world, glm::degrees(camera.vertical_fov));
  }
  std::vector<std::pair<std::string, glm::vec4>> uniforms() const {
    const scene::SmokeOptions& smoke = scenario_.timeline.smoke;
    const auto& sky = scenario_.timeline.sky;
    std::vector<std::pair<std::string, glm::vec4>> values{
        {"light_count", glm::vec4(static_cast<float>(scenario_.scene.lights.size()))},
        {"ambient", glm::vec4(sky.ambient, sky.bounce)},
        {"look", glm::vec4(smoke.albedo, smoke.anisotropy)}};
    for (std::size_t i = 0; i < scenario_.scene.lights.size(); ++i) {
      const scene::Light& light = scenario_.scene.lights[i];
      const bool sun = light.kind == scene::LightKind::directional;
      const float brightest = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
      const std::string number = "[" + std::to_string(i) + "]";
      values.push_back({"light_at" + number, glm::vec4(sun ? -light.direction_world : light.position_world,
                                                       static_cast<float>(light.kind))});
      values.push_back(
          {"light_intensity" + number,
           glm::vec4(light.intensity, shared::light_range(brightest) * std::sqrt(0.01f / light.least))});
      values.push_back({"light_forward" + number,
                        glm::vec4(sun ? sun_right(light.direction_world) : light.direction_world, 0)});
      values.push_back({"light_cone" + number, glm::vec4(light.cos_inner, light.cos_outer, 0, 0)});
    }
    return values;
  }
  FloatMap shadows() const {
    return shadow_maps(scenario_.scene.lights,
                       scenario::world_triangles(scenario_.scene, [](Role) { return true; }));
  }
  float exposure() const { return std::exp2(scenario_.timeline.exposure); }

 private:
  void make_world() {
    const smoke::MaskAtlas& atlas = scenario_.masks;
    // The masks of letters, cut out of their atlas again.
    std::vector<std::vector<std::uint8_t>> texels;
    std::vector<brume_mask_image> images;
    for (std::uint32_t i = 0; i < atlas.count(); ++i) {
      const glm::vec2 size(atlas.width(), atlas.height());
      const glm::uvec2 low(glm::round(atlas.rectangle(i).uv_min * size)),
          high(glm::round(atlas.rectangle(i).uv_max * size));
      texels.emplace_back();
      for (std::uint32_t y = low.y; y < high.y; ++y)
        for (std::uint32_t x = low.x; x < high.x; ++x)
          texels.back().push_back(atlas.texels()[y * atlas.width() + x]);
      images.push_back({high.x - low.x, high.y - low.y, nullptr});
    }
    for (std::size_t i = 0; i < images.size(); ++i) images[i].texels = texels[i].data();
    masks_.emplace(context_, images);
    brume_world_params of_world = brume_world_defaults();
    of_world.masks = masks_->get();
    world_.emplace(*level_, of_world);
    std::vector<brume_event> events;
    const auto timeline_events = scenario::events_of(scenario_);
    for (const sim::Event& event : *timeline_events) events.push_back(api::c_event(event));
    world_->append(events);
    brume_field_params of_field = brume_field_defaults();
    of_field.extinction = scenario_.timeline.smoke.extinction;
    of_field.masks = masks_->get();
    field_.emplace(*level_, of_field);
  }
  brume_drawn_params drawn() const {
    const scene::SmokeOptions& smoke = scenario_.timeline.smoke;
    brume_drawn_params look = brume_drawn_defaults();
    look.erosion = smoke.erosion;
    look.noise_size = smoke.noise_size;
    look.detail = smoke.detail;
    look.hole_rim = smoke.hole_rim;
    look.swirl = smoke.swirl;
    look.rise = smoke.rise;
    return look;
  }

  scenario::Scenario scenario_;
  std::vector<brume_point> points_;
  std::vector<std::uint32_t> indices_;
  api::Context context_;
  std::optional<api::Level> level_;
  std::optional<api::Masks> masks_;
  std::optional<api::World> world_;
  std::optional<api::Field> field_;
  std::optional<api::Textures> textures_;
};

}  // namespace brume::textures
