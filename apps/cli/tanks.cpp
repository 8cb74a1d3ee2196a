#include "apps/cli/tanks.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/command.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/command_line/console.hpp"
#include "core/log.hpp"
#include "core/utf8.hpp"
#include "scene/files/load.hpp"
#include "scene/files/tank_reader.hpp"
#include "scene/tank_scene.hpp"
#include "spheres/export.hpp"
#include "spheres/file.hpp"

namespace brume::cli {
namespace {

std::string number_text(const char* pattern, double number) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, number);
  return text;
}

Json corner_json(const glm::dvec3& p) {
  return Json::list({p.x, p.y, p.z});
}

std::string bounds_text(const Box<double>& box) {
  return point_text(glm::vec3(box.low)) + " to " + point_text(glm::vec3(box.high));
}

void add_tank_layout(Summary& summary, const spheres::Tank& tank) {
  const glm::uvec3 n = tank.size;
  summary.add("size", Json::list({n.x, n.y, n.z}),
              std::to_string(n.x) + "x" + std::to_string(n.y) + "x" + std::to_string(n.z) + " voxels");
  summary.add("voxel_size", tank.voxel);
  const glm::vec3 half = 0.5f * glm::vec3(n) * tank.voxel;
  summary.add("origin", point_json(-half), point_text(-half) + " to " + point_text(half) + " m");
}

/// How a tank is packed. It may become fewer spheres.
void add_packing(Summary& summary, const scene::TankScene& scene) {
  const spheres::PackOptions& pack = scene.pack;
  summary.add("spheres", pack.count, "at most " + std::to_string(pack.count));
  summary.add("radius", Json{{"min", pack.radius.x}, {"max", pack.radius.y}},
              number_text("%.4g", double{pack.radius.x}) + " to " +
                  number_text("%.4g", double{pack.radius.y}) + " voxels");
  summary.add("arrangement", scene::arrangement_name(pack.arrangement));
  summary.add("coloring", scene::coloring_name(pack.coloring));
  summary.add("palette", scene.palette, scene.palette.empty() ? "white" : printable(scene.palette));
  summary.add("seed", pack.seed);
}

/// The tank of a scene that has one in a file. If it cannot be loaded: nothing and a warning or, with
/// `check`, an Error.
std::optional<spheres::Tank> load_tank_of(Summary& summary, const std::filesystem::path& file, bool check) {
  auto loaded = spheres::load_tank(file);
  if (!loaded && check) throw Error(loaded.failure());
  if (!loaded) {
    log_warning("cannot be rendered: " + loaded.failure().message);
    summary.add("problem", loaded.failure().message);
    return std::nullopt;
  }
  add_tank_layout(summary, *loaded);
  summary.add("spheres", loaded->spheres.size());
  return std::move(*loaded);
}

void add_tank_lights(Summary& summary, const scene::TankScene& scene) {
  Json list = Json::list({});
  for (const scene::TankLight& light : scene.lights)
    list.push_back({{"position", point_json(light.position_world)},
                    {"color", point_json(light.color)},
                    {"intensity", light.intensity},
                    {"radius", light.radius},
                    {"keys", light.keys.size()}});
  summary.add("lights", list, std::to_string(scene.lights.size()));
  for (const scene::TankLight& light : scene.lights)
    summary.add_line("", "at " + point_text(light.position_world) + ", " +
                             number_text("%.4g W/sr", double{light.intensity}) +
                             (light.keys.empty() ? "" : ", moves"));
}

}  // namespace

TankFacts facts_of(const spheres::Tank& tank) {
  TankFacts facts;
  if (tank.spheres.empty()) return facts;
  // Sizes, and what the spheres cover.
  std::vector<float> radii;
  radii.reserve(tank.spheres.size());
  double cubes = 0;
  facts.bounds = {glm::dvec3(tank.size), glm::dvec3(0)};
  for (const spheres::Sphere& sphere : tank.spheres) {
    const auto radius = double{sphere.radius};
    radii.push_back(sphere.radius);
    cubes += radius * radius * radius;
    facts.bounds.low = glm::min(facts.bounds.low, glm::dvec3(sphere.center) - radius);
    facts.bounds.high = glm::max(facts.bounds.high, glm::dvec3(sphere.center) + radius);
  }
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  facts.median = *middle;
  facts.least = *std::min_element(radii.begin(), radii.end());
  facts.largest = *std::max_element(radii.begin(), radii.end());
  const glm::dvec3 size(tank.size);
  facts.fill = 4.0 / 3 * std::numbers::pi * cubes / (size.x * size.y * size.z);
  // Opacities: the highest byte of a colour.
  facts.least_opacity = 255;
  for (const spheres::Color color : tank.colors) {
    const std::uint32_t opacity = color >> 24;
    facts.opaque += opacity == 255;
    facts.least_opacity = std::min(facts.least_opacity, opacity);
    facts.largest_opacity = std::max(facts.largest_opacity, opacity);
  }
  return facts;
}

Summary tank_summary(const std::filesystem::path& path) {
  const spheres::Tank tank = spheres::load_tank(path).value_or_throw();
  const TankFacts facts = facts_of(tank);
  Summary summary("tank");
  add_tank_layout(summary, tank);
  summary.add("spheres", tank.spheres.size());
  if (tank.spheres.empty()) return summary;
  summary.add("radius", Json{{"min", facts.least}, {"median", facts.median}, {"max", facts.largest}},
              number_text("%.4g", double{facts.least}) + " to " + number_text("%.4g", double{facts.largest}) +
                  " voxels, median " + number_text("%.4g", double{facts.median}));
  summary.add("fill", facts.fill, number_text("%.1f %%", 100 * facts.fill));
  summary.add("opaque", facts.opaque, std::to_string(facts.opaque) + " spheres");
  const auto opacity = [](std::uint32_t byte) { return static_cast<float>(byte) / 255; };
  const float low = opacity(facts.least_opacity), high = opacity(facts.largest_opacity);
  summary.add("opacity", Json{{"min", low}, {"max", high}},
              number_text("%.3g", double{low}) + " to " + number_text("%.3g", double{high}));
  const glm::dvec3 middle = 0.5 * glm::dvec3(tank.size);
  const auto voxel = double{tank.voxel};
  const Box<double> world{(facts.bounds.low - middle) * voxel, (facts.bounds.high - middle) * voxel};
  summary.add("bounds", Json{{"min", corner_json(facts.bounds.low)}, {"max", corner_json(facts.bounds.high)}},
              bounds_text(facts.bounds) + " voxels");
  summary.add("world_bounds", Json{{"min", corner_json(world.low)}, {"max", corner_json(world.high)}},
              bounds_text(world) + " m");
  return summary;
}

Summary tank_scene_summary(const std::filesystem::path& path, bool check) {
  const scene::TankScene scene = scene::load_tank_scene(path).value_or_throw();
  Summary summary("tank scene");
  std::optional<spheres::Tank> tank;
  if (scene.file.empty()) {
    tank = spheres::Tank{scene.pack.size, scene.pack.voxel, {}, {}};
    add_tank_layout(summary, *tank);
    add_packing(summary, scene);
  } else {
    summary.add("tank", scene.file.string());
    tank = load_tank_of(summary, scene.file, check);
  }
  summary.add("view", scene::view_name(scene.view));
  summary.add("samples", scene.samples);
  summary.add("bounces", scene.bounces);
  summary.add("photons", scene.photons);
  summary.add("seconds", scene.duration);
  add_tank_lights(summary, scene);
  summary.add("glass", scene.glass.has_value());
  summary.add("camera_keys", scene.camera.size());
  if (!tank) return summary;
  const glm::vec3 size = glm::vec3(tank->size) * tank->voxel;
  add_camera(summary, scene::camera_at(scene, size, 0), !scene.camera.empty());
  return summary;
}

void convert_tank(const std::string& input, const std::string& output, const std::string& json,
                  Outputs& outputs) {
  const Stopwatch watch;
  // Volume files are written from the tank's voxels, by the caller.
  expect_suffix("", output, {".obj", ".ply", ".vdb", ".nvdb", ".brv", ".json"});
  const bool is_mesh = scene::lower_extension(to_path(output)) == ".obj";
  outputs.reads(to_path(input));
  outputs.writes("", to_path(output), is_mesh ? FileKind::obj : FileKind::ply);
  outputs.writes("--json", to_path(json), FileKind::json);

  const spheres::Tank tank = spheres::load_tank(to_path(input)).value_or_throw();
  stop_if_interrupted();
  (is_mesh ? spheres::save_tank_obj(to_path(output), tank) : spheres::save_tank_ply(to_path(output), tank))
      .value_or_throw();

  const double seconds = watch.seconds();
  if (!json.empty())
    write_json(json, {{"input", input},
                      {"output", output},
                      {"spheres", tank.spheres.size()},
                      {"bytes", std::uint64_t{std::filesystem::file_size(to_path(output))}},
                      {"milliseconds", 1000 * seconds}});
  if (json == "-") return;
  print(std::to_string(tank.spheres.size()) + " spheres, in " + number_text("%.3g", seconds) + " s\n");
}

}  // namespace brume::cli
