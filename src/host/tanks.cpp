#include "host/tanks.hpp"

#include <cmath>
#include <string>

#include "api/ranges.hpp"
#include "host/frame.hpp"
#include "scene/level_tank.hpp"
#include "scene/tank_options.hpp"
#include "spheres/file.hpp"

using namespace brume::api;

namespace brume::host {
namespace {

/// Samples of a frame at most; a picture of a file may have more.
constexpr std::uint32_t kMostSamples = 64;

spheres::Tank copied_tank(const brume_tank_params& params) {
  spheres::Tank tank;
  tank.size = {params.size[0], params.size[1], params.size[2]};
  tank.voxel = params.voxel;
  spheres::PackOptions numbers;
  numbers.voxel = params.voxel;
  scene::visit_pack_options(numbers, RangeCheck("`"));
  unwrap(spheres::check_tank_size(tank.size, params.sphere_count));
  if (params.sphere_count == 0) return tank;
  required(params.spheres, "spheres");
  required(params.colors, "colors");
  tank.spheres.resize(params.sphere_count);
  for (std::size_t i = 0; i < tank.spheres.size(); ++i) {
    const float* const sphere = params.spheres + 4 * i;
    tank.spheres[i] = {{sphere[0], sphere[1], sphere[2]}, sphere[3]};
  }
  tank.colors.assign(params.colors, params.colors + params.sphere_count);
  return tank;
}

std::shared_ptr<const scene::TankContent> content_of(const brume_tank_params& params) {
  auto content = std::make_shared<scene::TankContent>();
  if (params.file) {
    require(params.sphere_count == 0, "`sphere_count` must be 0 beside a `file`");
    content->tank = unwrap(spheres::load_tank(params.file), BRUME_ERROR_DATA);
  } else {
    content->tank = copied_tank(params);
    if (const auto valid = spheres::check_tank(content->tank); !valid)
      fail(result_of(valid.failure().code), "the tank: " + valid.failure().message);
  }
  content->bricks = spheres::list_bricks(content->tank);
  return content;
}

scene::OptionInfo light_info(const char* key) {
  return scene::info_of<scene::TankLight>(key,
                                          [](auto& o, auto& v) { scene::visit_tank_light_options(o, v); });
}

scene::TankLight light_of(const brume_tank_light& light, std::size_t number) {
  const std::string name = "light " + std::to_string(number);
  scene::TankLight made;
  made.position_world = position(light.position, (name + ".position").c_str());
  made.radius = light.radius;
  require_range(light_info("radius"), made.radius, name + ".radius");
  made.color = vec3_of(light.intensity);
  made.intensity = 1;
  for (int channel = 0; channel < 3; ++channel)
    require_range(light_info("intensity"), made.color[channel], name + ".intensity");
  return made;
}

void add_glass(const brume_tank_lighting& lighting, scene::TankScene& scene) {
  if (lighting.glass_index == 0) return;
  scene::TankGlass& glass = scene.glass.emplace();
  glass.index = lighting.glass_index;
  glass.position_world = position(lighting.glass_position, "glass_position");
  glass.radii = vec3_of(lighting.glass_radii);
  scene::visit_glass_options(glass, RangeCheck("`glass_"));
}

scene::TankScene to_scene(const brume_tank_lighting& lighting) {
  scene::TankScene scene;
  require(lighting.light_count <= scene::kMostTankLights, "at most 16 lights of a tank");
  if (lighting.light_count > 0) required(lighting.lights, "lights");
  for (std::size_t i = 0; i < lighting.light_count; ++i)
    scene.lights.push_back(light_of(lighting.lights[i], i));
  scene.sky.ambient = vec3_of(lighting.ambient);
  // As in a frame: a host's unit of radiance is its own.
  require(is_within(scene.sky.ambient, 0, 1e6f), "`ambient` must be from 0 to 10^6");
  scene.bounces = lighting.bounces;
  scene.fog.extinction = lighting.fog_extinction;
  scene.fog.color = vec3_of(lighting.fog_color);
  scene::visit_fog_options(scene.fog, RangeCheck("`fog_"));
  add_glass(lighting, scene);
  scene.photons = lighting.photons;
  scene::visit_tank_picture_options(scene, RangeCheck("`"));
  return scene;
}

std::shared_ptr<const scene::TankIllumination> lit(const scene::TankContent& content,
                                                   const brume_tank_lighting& lighting) {
  return std::make_shared<const scene::TankIllumination>(scene::illuminate(content, to_scene(lighting)));
}

planning::TankPlacement placement_of(const brume_shown_tank& shown, const std::string& name) {
  planning::TankPlacement placement;
  placement.position_world = position(shown.position, (name + ".position").c_str());
  const glm::dvec3 x(vec3_of(shown.x_axis)), y(vec3_of(shown.y_axis)), z(vec3_of(shown.z_axis));
  const double scale = glm::length(x);
  constexpr double kTolerance = 1e-3;
  const auto is_alike = [&](double length) { return std::abs(length - scale) <= kTolerance * scale; };
  const auto is_across = [&](double dot) { return std::abs(dot) <= kTolerance * scale * scale; };
  // False for what is not a number.
  const bool fits = scale > 1e-6 && scale < 1e6 && is_alike(glm::length(y)) && is_alike(glm::length(z)) &&
                    is_across(glm::dot(x, y)) && is_across(glm::dot(x, z)) && is_across(glm::dot(y, z)) &&
                    glm::dot(glm::cross(x, y), z) > 0;
  if (!fits) refuse(name + " must have right-handed axes at right angles, of one length");
  // Exactly at right angles.
  const glm::dvec3 right = x / scale, up = glm::normalize(y - glm::dot(y, right) * right);
  placement.axes = {glm::vec3(right), glm::vec3(up), glm::vec3(glm::cross(right, up))};
  placement.scale = static_cast<float>(scale);
  return placement;
}

}  // namespace

void add_tanks(Call& call, const brume_frame_params& params, planning::FrameInput& frame) {
  require(params.tank_count <= scene::kMostTanks, "at most 4 tanks");
  require(params.tank_count == 0 || params.parallel == 0,
          "frames with `tanks` need a perspective camera: `parallel` must be 0");
  if (params.tank_count > 0) required(params.tanks, "tanks");
  for (std::size_t i = 0; i < params.tank_count; ++i) {
    const brume_shown_tank& shown = params.tanks[i];
    const std::string name = "tank " + std::to_string(i);
    const brume_tank& tank = call.handle(shown.tank);
    if (shown.view > BRUME_TANK_VOXELS) refuse(name + ": `view` must be a brume_tank_view");
    if (shown.samples < 1 || shown.samples > kMostSamples)
      refuse(name + ": `samples` must be from 1 to " + std::to_string(kMostSamples));
    planning::TankInput input{tank.content, nullptr, placement_of(shown, name),
                              static_cast<scene::TankView>(shown.view), shown.samples,
                              // What a picture may have is far below the numbers that remain.
                              params.jitter_index % 4096 * kMostSamples, shown.continues_previous != 0};
    call.read(tank, [&] { input.light = tank.light; });
    frame.tanks.push_back(std::move(input));
  }
}

}  // namespace brume::host

extern "C" {

brume_result brume_tank_create(brume_context* context, const brume_tank_params* params,
                               brume_tank** tank) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_context& owner = call.handle(context);
    required(tank, "tank");
    auto content = brume::host::content_of(required_params(params));
    auto light = brume::host::lit(*content, defaults<brume_tank_lighting>());
    create(tank, owner.settings, std::move(content), std::move(light));
  });
}

brume_result brume_tank_destroy(brume_tank* tank) BRUME_NOEXCEPT {
  return destroy(__func__, tank);
}

brume_result brume_tank_set_lighting(brume_tank* tank, const brume_tank_lighting* lighting) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_tank& object = call.handle(tank);
    auto light = brume::host::lit(*object.content, required_params(lighting));
    call.change(object, [&] { object.light = std::move(light); });
  });
}

}  // extern "C"
