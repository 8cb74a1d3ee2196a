#include "apps/cli/tanks.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "apps/cli/command.hpp"
#include "apps/cli/console.hpp"
#include "apps/cli/stopwatch.hpp"
#include "scene/load.hpp"
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

}  // namespace

TankFacts facts_of(const spheres::Tank& tank) {
  TankFacts facts;
  if (tank.spheres.empty()) return facts;
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

void convert_tank(const std::string& input, const std::string& output, const std::string& json,
                  Outputs& outputs) {
  const Stopwatch watch;
  // Volume files are written from the tank's voxels, by the caller.
  expect_suffix("", output, {".obj", ".ply", ".vdb", ".nvdb", ".brv", ".json"});
  const bool is_mesh = scene::lower_extension(output) == ".obj";
  outputs.reads(std::filesystem::path(input));
  outputs.writes("", output, is_mesh ? FileKind::obj : FileKind::ply);
  outputs.writes("--json", json, FileKind::json);

  const spheres::Tank tank = spheres::load_tank(input).value_or_throw();
  stop_if_interrupted();
  (is_mesh ? spheres::save_tank_obj(output, tank) : spheres::save_tank_ply(output, tank)).value_or_throw();

  const double seconds = watch.seconds();
  if (!json.empty())
    write_json(json, {{"input", input},
                      {"output", output},
                      {"spheres", tank.spheres.size()},
                      {"bytes", std::uint64_t{std::filesystem::file_size(output)}},
                      {"milliseconds", 1000 * seconds}});
  if (json == "-") return;
  print(std::to_string(tank.spheres.size()) + " spheres, in " + number_text("%.3g", seconds) + " s\n");
}

}  // namespace brume::cli
