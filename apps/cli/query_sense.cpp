#include "apps/cli/query_sense.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "apps/cli/command.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/cli/summary.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "apps/command_line/parse.hpp"
#include "core/error.hpp"
#include "core/utf8.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"
#include "scenario/tank.hpp"
#include "scene/files/load.hpp"
#include "shared/tone.h"
#include "spheres/sense.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;
using spheres::Sensed;

/// A JSON document lists each ray; a picture may have more.
constexpr std::uint64_t kMostListedRays = 1u << 20, kMostRays = 1u << 26;

FileKind picture_kind(const fs::path& path) {
  return scene::lower_extension(path) == ".exr" ? FileKind::exr : FileKind::png;
}

spheres::Eye parse_eye(const SenseOptions& options) {
  const scene::Camera camera = parse_camera("--sense", options.eye);
  spheres::Eye eye{camera.position_world, camera.target_world, camera.vertical_fov, {16, 9}};
  if (!options.size.empty()) eye.size = parse_size("--size", options.size);
  const std::uint64_t rays = std::uint64_t{eye.size.x} * eye.size.y;
  if (rays > (options.output.empty() ? kMostListedRays : kMostRays))
    throw Error(ErrorCode::usage, "--size " + options.size + ": at most " +
                                      (options.output.empty() ? "1048576 rays without a picture, -o FILE.exr"
                                                              : "67108864 rays"));
  return eye;
}

/// Where rays have float coordinates that are exact enough.
void check_place(const spheres::Eye& eye, const spheres::Tank& tank) {
  const float most = 0x1p19f * tank.voxel;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(eye.position_world[axis]) <= most) continue;
    char text[128];
    std::snprintf(text, sizeof text, "--sense: expected an eye within %g m of the tank's middle, 2^19 voxels",
                  double{most});
    throw Error(ErrorCode::usage, text);
  }
}

void save_picture(const fs::path& path, const glm::uvec2& size, const std::vector<Sensed>& seen) {
  // Numbers in layers, as compositors read them.
  if (picture_kind(path) == FileKind::exr) {
    image::LayeredImage picture{size.x, size.y, {}};
    const auto add = [&](const char* name, const auto& value_of) {
      std::vector<float> values;
      values.reserve(seen.size());
      for (const Sensed& one : seen) values.push_back(value_of(one));
      picture.layers.push_back({name, std::move(values)});
    };
    add("R", [](const Sensed& one) { return one.color.r; });
    add("G", [](const Sensed& one) { return one.color.g; });
    add("B", [](const Sensed& one) { return one.color.b; });
    add("A", [](const Sensed& one) { return one.opacity; });
    add("Z", [](const Sensed& one) { return one.depth; });
    image::save_exr(path, picture).value_or_throw();
    return;
  }
  // Colours with straight alpha.
  image::Image8 picture{size.x, size.y, {}};
  for (const Sensed& one : seen) {
    const glm::vec3 straight = one.opacity > 0 ? one.color / one.opacity : glm::vec3(0);
    const glm::vec4 encoded(shared::srgb_from_linear(straight), one.opacity);
    for (int i = 0; i < 4; ++i)
      picture.rgba.push_back(
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(encoded[i], 0.0f, 1.0f))));
  }
  image::save_png(path, picture).value_or_throw();
}

/// Lists every ray, rows from the top.
void list_rays(Json& report, const std::vector<Sensed>& seen) {
  Json colors = Json::list({}), opacities = Json::list({}), depths = Json::list({});
  for (const Sensed& one : seen) {
    colors.push_back(point_json(one.color));
    opacities.push_back(one.opacity);
    depths.push_back(std::isfinite(one.depth) ? Json(one.depth) : Json(nullptr));
  }
  report.set("color", colors);
  report.set("opacity", opacities);
  report.set("depth", depths);
}

void print_summary(const std::vector<Sensed>& seen, double seconds) {
  float nearest = std::numeric_limits<float>::infinity();
  std::size_t meet = 0;
  for (const Sensed& one : seen) {
    meet += one.opacity > 0;
    nearest = std::min(nearest, one.depth);
  }
  char text[160];
  std::snprintf(text, sizeof text, "%zu of %zu rays meet a sphere", meet, seen.size());
  std::string line = text;
  if (std::isfinite(nearest)) {
    std::snprintf(text, sizeof text, ", the nearest after %.4g m", double{nearest});
    line += text;
  }
  std::snprintf(text, sizeof text, "; %.3g rays/s\n", static_cast<double>(seen.size()) / seconds);
  print(line + text);
}

}  // namespace

void declare_sense(const Arguments& arguments, SenseOptions& options) {
  arguments
      .add_option("--sense", options.eye,
                  "Colours and distances along rays of an eye in a tank: its position, a target [m] and "
                  "vertical field of view [degrees]")
      .type_name("\"X,Y,Z X,Y,Z FOV\"");
  arguments.add_option("--size", options.size, "Rays of --sense across and down; default 16x9")
      .type_name("WxH");
  arguments
      .add_option("-o,--output", options.output,
                  "Picture of what --sense sees: .exr with R, G, B, A and distance Z, or .png of colours")
      .type_name("FILE");
}

void sense_tank(const SenseOptions& options, Outputs& outputs) {
  if (!scenario::is_tank_input(to_path(options.input)))
    throw Error(ErrorCode::usage,
                "--sense: " + options.input + " is no tank; expected a .spheres file or a scene of a tank");
  const spheres::Eye eye = parse_eye(options);
  outputs.reads(scenario::files_of_tank_input(to_path(options.input)));
  if (!options.output.empty()) {
    expect_suffix("-o", options.output, {".exr", ".png"});
    outputs.writes("-o", to_path(options.output), picture_kind(to_path(options.output)));
  }
  outputs.writes("--json", to_path(options.json), FileKind::json);

  // The tank, and where its spheres are.
  const scenario::TankScenario scenario =
      scenario::load_tank_scenario(to_path(options.input), is_interrupted).value_or_throw();
  stop_if_interrupted();
  check_place(eye, scenario.tank);
  const spheres::BrickLists bricks = spheres::list_bricks(scenario.tank);
  const spheres::VoxelIds ids = spheres::make_ids(scenario.tank, bricks);
  stop_if_interrupted();

  const Stopwatch watch;
  const std::vector<Sensed> seen = spheres::sense({scenario.tank, bricks, ids}, eye);
  const double seconds = std::max(watch.seconds(), 1e-9);
  stop_if_interrupted();
  if (!options.output.empty()) save_picture(to_path(options.output), eye.size, seen);
  if (!options.json.empty()) {
    Json report{{"tank", options.input},
                {"from", point_json(eye.position_world)},
                {"to", point_json(eye.target_world)},
                {"size", Json::list({eye.size.x, eye.size.y})},
                {"rays_per_second", static_cast<double>(seen.size()) / seconds}};
    if (!options.output.empty()) report.set("output", options.output);
    if (options.output.empty()) list_rays(report, seen);
    write_json(options.json, report);
  }
  if (options.json != "-") print_summary(seen, seconds);
}

}  // namespace brume::cli
