#include "apps/cli/flipbook.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/cli/flipbook_maps.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/targets.hpp"
#include "core/file.hpp"
#include "core/log.hpp"
#include "core/progress.hpp"
#include "core/tasks.hpp"
#include "image/optical_flow.hpp"
#include "planning/device_camera.hpp"

namespace brume::cli {
namespace {

using image::LightSide;
using image::Texels;

// Irradiance by the light from each side: as bright as flames, so that half floats keep the difference.
constexpr float kSideIrradiance = 256;

/// The frames of the tiles, and when they are.
struct TileTime {
  std::uint32_t frame = 0;
  double seconds = 0;
};
std::vector<TileTime> times_of(const FlipbookJob& job) {
  const std::uint32_t tiles = job.plan.layout.tiles(), count = job.range.last - job.range.first + 1;
  const double first = job.rate.time_of(job.range.first), last = job.rate.time_of(job.range.last);
  std::vector<TileTime> times(tiles);
  for (std::uint32_t tile = 0; tile < tiles; ++tile) {
    // After the last tile of a turn comes the first one again.
    const double part = job.is_turn ? static_cast<double>(tile) * count / (tiles * std::max(count - 1.0, 1.0))
                        : tiles > 1 ? static_cast<double>(tile) / (tiles - 1)
                                    : 0;
    const auto frame = job.range.first + static_cast<std::uint32_t>(std::lround(part * (count - 1)));
    const bool is_between = count < tiles && !job.is_sequence;
    times[tile] = {frame, is_between ? first + part * (last - first) : job.rate.time_of(frame)};
  }
  return times;
}

Texels drawn(FrameSource& frames, const TileTime& at, std::uint32_t gutter) {
  stop_if_interrupted();
  return image::with_gutter(
      image::to_texels(std::get<image::LayeredImage>(frames.draw(at.seconds, at.frame))), gutter);
}

/// Where something is seen of a picture: from the low to the high corner, in parts of it from -1 to 1, x
/// right, y up.
struct SeenBox {
  glm::vec2 low{1}, high{-1};
  void add(const Texels& picture) {
    constexpr float kLeastSeen = 1.5f / 255;
    for (std::uint32_t y = 0; y < picture.height; ++y)
      for (std::uint32_t x = 0; x < picture.width; ++x) {
        const glm::vec4 texel = picture.rgba[std::size_t{y} * picture.width + x];
        if (!(std::max({texel.r, texel.g, texel.b, texel.a}) > kLeastSeen)) continue;
        const glm::vec2 size(picture.width, picture.height);
        const glm::vec2 a = 2.0f * glm::vec2(x, y) / size - 1.0f,
                        b = 2.0f * glm::vec2(x + 1, y + 1) / size - 1.0f;
        low = glm::min(low, glm::vec2(a.x, -b.y));
        high = glm::max(high, glm::vec2(b.x, -a.y));
      }
  }
  bool empty() const { return low.x > high.x; }
};

/// The camera turned to the middle of a box of its picture, with a field of view that the box fills but for a
/// twentieth on each side.
scene::Camera looking_at(const SeenBox& seen, const scene::Camera& camera, glm::uvec2 picture_px) {
  constexpr float kFilled = 0.9f;
  const shared::Camera axes = planning::device_camera(camera, picture_px);
  const glm::vec2 middle = 0.5f * (seen.low + seen.high), half = 0.5f * (seen.high - seen.low);
  const glm::vec3 along = axes.forward + middle.x * axes.right + middle.y * axes.up;
  scene::Camera turned = camera;
  turned.target_world =
      camera.position_world + along * glm::distance(camera.target_world, camera.position_world);
  const float tan_y = std::tan(0.5f * camera.vertical_fov) * std::max(half.x, half.y) / kFilled;
  turned.vertical_fov = 2 * std::atan(std::clamp(tan_y, 1e-4f, 100.0f));
  return turned;
}

/// The camera that what is seen in some of the tiles fills. Of a turned picture it is somewhere else: twice.
scene::Camera fitted_camera(const FlipbookJob& job, const std::vector<TileTime>& times) {
  constexpr std::size_t kMostLooks = 8;
  scene::Camera camera = job.camera;
  for (int round = 0; round < 2; ++round) {
    const auto frames = job.frames_under({});
    frames->set_camera(camera);
    SeenBox seen;
    const std::size_t looks = std::min(times.size(), kMostLooks);
    for (std::size_t i = 0; i < looks; ++i)
      seen.add(drawn(*frames, times[looks > 1 ? i * (times.size() - 1) / (looks - 1) : 0], 0));
    if (seen.empty()) return job.camera;
    camera = looking_at(seen, camera, job.plan.layout.picture_px());
  }
  return camera;
}

Texels motion_between(const Texels& from, const Texels& to) {
  const std::vector<glm::vec2> flow = image::optical_flow(from, to);
  Texels motion = from;
  for (std::size_t i = 0; i < flow.size(); ++i)
    motion.rgba[i] = glm::vec4(flow[i] / glm::vec2(from.width, from.height), 0, from.rgba[i].a);
  return motion;
}

/// From each tile to the next one.
Texels motion_of(const image::FlipbookLayout& layout, const Texels& color) {
  Texels motion = image::empty_sheet(layout);
  parallel_for(layout.tiles() - 1, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto tile = static_cast<std::uint32_t>(i);
      const Texels from = image::tile_of(layout, tile, color), to = image::tile_of(layout, tile + 1, color);
      image::set_tile(layout, tile, motion_between(from, to), motion);
    }
  });
  return motion;
}

/// Its right, up and backward directions in the world.
glm::mat3 camera_axes(const scene::Camera& camera) {
  const shared::Camera axes = planning::device_camera(camera, glm::uvec2(1));
  return {glm::normalize(axes.right), glm::normalize(axes.up), -axes.forward};
}

std::unique_ptr<FrameSource> frames_under(const FlipbookJob& job, const FlipbookLight& light) {
  auto frames = job.frames_under(light);
  if (job.fits_camera) frames->set_camera(job.camera);
  return frames;
}

/// Returns the statistics of its frames.
Json draw_colors(const FlipbookJob& job, const std::vector<TileTime>& times, Progress& progress,
                 FlipbookSheets& sheets) {
  const image::FlipbookLayout& layout = job.plan.layout;
  const auto frames = frames_under(job, {});
  sheets.color = image::empty_sheet(layout);
  for (std::uint32_t tile = 0; tile < layout.tiles(); ++tile) {
    const Texels now = drawn(*frames, times[tile], layout.gutter);
    image::set_tile(layout, tile, now, sheets.color);
    progress.advance();
  }
  if (job.plan.has_motion) sheets.motion = motion_of(layout, sheets.color);
  sheets.display = frames->display();
  return frames->statistics();
}

/// A pass over all tiles under a light; `use` takes each.
void draw_tiles(const FlipbookJob& job, const std::vector<TileTime>& times, const FlipbookLight& light,
                Progress& progress, const std::function<void(std::uint32_t, const Texels&)>& use) {
  const auto frames = frames_under(job, light);
  for (std::uint32_t tile = 0; tile < job.plan.layout.tiles(); ++tile) {
    use(tile, drawn(*frames, times[tile], job.plan.layout.gutter));
    progress.advance();
  }
}

/// What glows, without any light; and, for each side, what its light adds to that.
void draw_light(const FlipbookJob& job, const std::vector<TileTime>& times, Progress& progress,
                FlipbookSheets& sheets) {
  const image::FlipbookLayout& layout = job.plan.layout;
  sheets.emission = image::empty_sheet(layout);
  draw_tiles(job, times, {FlipbookLight::Kind::none}, progress,
             [&](std::uint32_t tile, const Texels& texels) {
               image::set_tile(layout, tile, texels, sheets.emission);
             });
  if (!is_lit_by_sides(job.plan)) return;
  const glm::mat3 world_from_camera = camera_axes(job.camera);
  Texels lit = image::empty_sheet(layout);
  for (std::size_t side = 0; side < image::kLightSides; ++side) {
    const glm::vec3 from = world_from_camera * image::direction_of(static_cast<LightSide>(side));
    draw_tiles(job, times, {FlipbookLight::Kind::one, from, kSideIrradiance}, progress,
               [&](std::uint32_t tile, const Texels& texels) { image::set_tile(layout, tile, texels, lit); });
    std::vector<float>& light = sheets.light[side];
    light.resize(lit.rgba.size());
    // Relative to a white surface that faces the light, whose radiance is irradiance / pi.
    constexpr float kPerWhite = std::numbers::pi_v<float> / kSideIrradiance;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const float added = kPerWhite * luminance(lit.rgba[i] - sheets.emission.rgba[i]);
      // What glows may be infinite.
      light[i] = std::isfinite(added) ? std::max(added, 0.0f) : 0;
    }
  }
}

Json size_json(glm::uvec2 size) {
  return Json::list({size.x, size.y});
}

/// How large the sprite of a tile is where the camera looks [m].
Json make_sprite(const FlipbookJob& job) {
  const image::FlipbookLayout& layout = job.plan.layout;
  const double distance = glm::distance(job.camera.position_world, job.camera.target_world);
  const double metre = 2 * distance * std::tan(0.5 * double{job.camera.vertical_fov}) / layout.picture_px().y;
  return Json::list({metre * layout.tile_px.x, metre * layout.tile_px.y});
}

Json description_of(const FlipbookJob& job, const std::vector<TileTime>& times) {
  const FlipbookPlan& plan = job.plan;
  Json frames = Json::list({}), seconds = Json::list({});
  for (const TileTime& time : times) {
    frames.push_back(time.frame);
    seconds.push_back(time.seconds);
  }
  Json maps = Json::object();
  maps.set("color", plan.output.filename().string());
  for (const std::string& name : map_names(plan))
    maps.set(name.substr(1), map_file(plan, name).filename().string());
  const double last = times.back().seconds - times.front().seconds;
  return {{"format", "brume flipbook"},
          {"columns", plan.layout.columns},
          {"rows", plan.layout.rows},
          {"tile", size_json(plan.layout.tile_px)},
          {"gutter", plan.layout.gutter},
          {"image_size", size_json(plan.layout.sheet_px())},
          {"alpha", plan.is_straight ? "straight" : "premultiplied"},
          {"maps", maps},
          {"frames", frames},
          {"seconds", seconds},
          {"tiles_per_second", last > 0 ? (plan.layout.tiles() - 1) / last : 0.0},
          {"sprite_size", make_sprite(job)}};
}

}  // namespace

void set_light(const FlipbookLight& light, scenario::Scenario& scenario) {
  if (light.kind == FlipbookLight::Kind::own) return;
  scenario.scene.lights.clear();
  scenario.timeline.sky = {glm::vec3(0), glm::vec3(0), glm::vec3(0), 0, 0};
  if (light.kind == FlipbookLight::Kind::none) return;
  scene::Light sun;
  sun.kind = scene::LightKind::directional;
  sun.direction_world = -light.from_world;
  sun.intensity = glm::vec3(light.irradiance);
  scenario.scene.lights.push_back(sun);
}

Json write_flipbook(FlipbookJob job) {
  const FlipbookPlan& plan = job.plan;
  const std::vector<TileTime> times = times_of(job);
  if (job.is_still && plan.layout.tiles() > 1)
    log_warning(plan.output.string() +
                ": all tiles are alike; a flipbook is of a sequence or a timeline, or has --orbit 360");
  if (job.fits_camera) job.camera = fitted_camera(job, times);
  const bool is_dark = is_lit_by_sides(plan) || plan.has_emission;
  const std::uint32_t passes =
      1u + (is_dark ? 1u : 0u) + (is_lit_by_sides(plan) ? std::uint32_t{image::kLightSides} : 0u);
  Progress progress("frames", passes * plan.layout.tiles());
  FlipbookSheets sheets;
  const Json of_frames = draw_colors(job, times, progress, sheets);
  if (is_dark) draw_light(job, times, progress, sheets);
  stop_if_interrupted();

  Json description = description_of(job, times);
  description.update(save_sheets(plan, sheets));
  write_file_atomic(description_file(plan), description.dump() + "\n").value_or_throw();
  Json statistics{{"flipbook", description}};
  statistics.update(of_frames);
  return statistics;
}

}  // namespace brume::cli
