#include "smoke/sight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/tasks.hpp"
#include "shared/dda.h"
#include "smoke/drawn_smoke.hpp"
#include "smoke/sight_packet.hpp"
#include "smoke/sight_smoke.hpp"

namespace brume::smoke {
namespace {

/// For depth(): the whole line counts.
constexpr float kNeverEnough = std::numeric_limits<float>::infinity();
constexpr std::size_t kGrain = 512;     // queries of a task: some 0.2 ms
constexpr std::size_t kDrawnGrain = 8;  // the same of drawn smoke, which is slower
/// Drawn smoke stops this much above a threshold, so that rounding cannot take the result back below it.
constexpr float kMore = 1 + 0x1p-20f;

bool is_point(glm::vec3 p) {
  return std::abs(p.x) <= kMaxSightMetres && std::abs(p.y) <= kMaxSightMetres &&
         std::abs(p.z) <= kMaxSightMetres;  // false for NaN
}

std::string words(glm::vec3 p) {
  std::string text(1, '(');
  text.append(std::to_string(p.x)).append(", ").append(std::to_string(p.y)).append(", ");
  return text.append(std::to_string(p.z)).append(")");
}

Failure bad_point(const std::string& what, glm::vec3 p) {
  return {ErrorCode::bad_input, "line of sight: " + what + " is " + words(p) +
                                    "; expected finite coordinates within 16384 m of the world's origin"};
}

Result<void> check(const Segment& segment, const std::string& which = "") {
  if (!is_point(segment.a_world)) return bad_point("the first point" + which, segment.a_world);
  if (!is_point(segment.b_world)) return bad_point("the second point" + which, segment.b_world);
  return {};
}

Result<void> check_threshold(float threshold) {
  if (threshold >= 0) return {};
  return Failure{ErrorCode::bad_input,
                 "line of sight: threshold " + std::to_string(threshold) + "; expected 0 or more"};
}

Result<void> check(const SensorRay& ray, const std::string& which = "") {
  if (!is_point(ray.origin_world)) return bad_point("the origin" + which, ray.origin_world);
  const glm::vec3 d = ray.direction_world;
  constexpr float kMax = std::numeric_limits<float>::max();
  if (!(std::abs(d.x) <= kMax && std::abs(d.y) <= kMax && std::abs(d.z) <= kMax) || d == glm::vec3(0))
    return Failure{ErrorCode::bad_input, "line of sight: the direction" + which + " is " + words(d) +
                                             "; expected a finite vector that is not 0"};
  if (!(ray.max_distance > 0 && ray.max_distance <= 2 * kMaxSightMetres))
    return Failure{ErrorCode::bad_input, "line of sight: the greatest distance" + which + " is " +
                                             std::to_string(ray.max_distance) +
                                             " m; expected more than 0, at most 32768"};
  return {};
}

struct Line {
  glm::dvec3 a_world, b_world;
};
Line line_of(const Segment& segment) {
  return {glm::dvec3(segment.a_world), glm::dvec3(segment.b_world)};
}
/// The part of a ray up to a distance.
Line line_of(const SensorRay& ray, float distance) {
  const glm::dvec3 a(ray.origin_world), d(ray.direction_world);
  const glm::dvec3 direction = d / std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  return {a, a + double{distance} * direction};
}

/// Checks all queries. The failure names the first bad one.
template <typename Query>
Result<void> check_all(std::span<const Query> queries, std::size_t results) {
  BRUME_ASSERT(queries.size() == results, "as many results as queries");
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (check(queries[i])) continue;
    return check(queries[i], " of query " + std::to_string(i));
  }
  return {};
}

glm::ivec3 voxel_of(glm::dvec3 p_voxel) {
  // Within the range of int, and still far outside of any grid.
  return glm::ivec3(glm::floor(glm::clamp(p_voxel, glm::dvec3(-1e9), glm::dvec3(1e9))));
}

SightWall wall_at(const shared::Dda& d, glm::ivec3 crossed, float metres_per_t) {
  SightWall wall{d.cell, glm::ivec3(0), d.t * metres_per_t};
  for (int axis = 0; axis < 3; ++axis) {
    if (!crossed[axis]) continue;
    wall.normal[axis] = -d.stride[axis];
    break;
  }
  return wall;
}

/// The first solid voxel that the segment from a to b [m, finite] passes, in the sense of shared/dda.h, other
/// than the voxel of a and, unless b_hides, the voxel of b. An empty brick is one step.
std::optional<SightWall> first_solid_between(const voxel::BitGrid& grid, glm::dvec3 a_world,
                                             glm::dvec3 b_world, bool b_hides) {
  const voxel::GridLayout& layout = grid.layout();
  const double size = layout.voxel_size;
  const glm::dvec3 a = (a_world - glm::dvec3(layout.origin_world)) / size;
  const glm::dvec3 b = (b_world - glm::dvec3(layout.origin_world)) / size;
  const glm::dvec3 line = b - a;
  const double length = std::sqrt(line.x * line.x + line.y * line.y + line.z * line.z);
  if (!(length > 0)) return std::nullopt;
  const glm::ivec3 first = voxel_of(a), last = b_hides ? first : voxel_of(b);

  // From where the line enters the grid. Faces of bricks are faces of voxels, and both walks cross them at
  // the same t: the walk through the voxels of a brick begins and ends exactly where the outer walk does.
  const glm::vec3 origin(a), direction(line / length);
  const glm::ivec3 bricks = (grid.size() + (voxel::kBrickSize - 1)) / voxel::kBrickSize;
  shared::Dda outer =
      shared::dda_begin(origin, direction, glm::ivec3(0), grid.size(), 1, 0, static_cast<float>(length));
  if (!(outer.t < outer.t_end)) return std::nullopt;
  const glm::ivec3 entered = outer.crossed;
  outer =
      shared::dda_begin(origin, direction, glm::ivec3(0), bricks, voxel::kBrickSize, outer.t, outer.t_end);
  outer.crossed = entered;

  // Brick by brick, and in those that hold anything voxel by voxel.
  for (; outer.t < outer.t_end; outer = shared::dda_step(outer)) {
    const voxel::BitGrid::Brick* brick = grid.find_brick(outer.cell);
    if (!brick) continue;
    const glm::ivec3 low = outer.cell * voxel::kBrickSize;
    shared::Dda d = shared::dda_begin(origin, direction, low, glm::min(low + voxel::kBrickSize, grid.size()),
                                      1, outer.t, outer.t_end);
    glm::ivec3 crossed = outer.crossed;  // the axes of the faces through which the ray enters the voxel
    while (d.t < d.t_end) {
      const glm::ivec3 in = d.cell & 7;
      const bool solid = (*brick)[static_cast<unsigned>(in.z)] >> (in.x + 8 * in.y) & 1;
      if (solid && d.cell != first && d.cell != last) return wall_at(d, crossed, layout.voxel_size);
      d = shared::dda_step(d);
      crossed = d.crossed;
    }
  }
  return std::nullopt;
}

const MaskAtlas* masks_for(std::span<const shared::Hole> holes, const MaskAtlas* masks) {
  const auto is_mask = [](const shared::Hole& hole) { return hole.shape == shared::kHoleMask; };
  if (!masks && std::any_of(holes.begin(), holes.end(), is_mask))
    throw Error(ErrorCode::bad_input, "line of sight: a hole is a mask; expected the masks in SightSettings");
  return masks;
}

}  // namespace

Sight::Sight(const SmokeVolume& volume, const voxel::BitGrid& level, std::span<const shared::Hole> holes,
             float time, const SightSettings& settings)
    : volume_(volume),
      level_(level),
      holes_(holes, time, masks_for(holes, settings.masks)),
      settings_(settings) {
  if (!(settings.extinction >= 0 && settings.extinction <= 1e6f))
    throw Error(ErrorCode::bad_input, "line of sight: extinction " + std::to_string(settings.extinction) +
                                          " 1/m; expected 0 to 10^6");
  if (!(std::abs(time) <= std::numeric_limits<float>::max()))
    throw Error(ErrorCode::bad_input, "line of sight: the time is not finite");
}

std::optional<SmokeRay> Sight::smoke_ray(glm::dvec3 a_world, glm::dvec3 b_world, HolesOnRay& holes) const {
  const shared::VolumeLayout& layout = volume_.layout();
  const glm::dvec3 origin(layout.origin_world);
  const double size = layout.voxel_size;
  const auto ray = clip_to_smoke(layout, (a_world - origin) / size, (b_world - origin) / size);
  if (!ray || holes_.empty()) return ray;
  const glm::dvec3 step(double{ray->direction[0]} * size, double{ray->direction[1]} * size,
                        double{ray->direction[2]} * size);
  holes_.find(glm::vec3(a_world + ray->skipped * step), glm::vec3(step), ray->length, holes);
  return ray;
}

float Sight::depth(glm::dvec3 a_world, glm::dvec3 b_world, float enough, HolesOnRay& scratch) const {
  const float extinction = settings_.extinction, per_voxel = extinction * volume_.layout().voxel_size;
  if (!(per_voxel > 0)) return 0;
  if (settings_.drawn)
    return extinction * settings_.drawn->integral(a_world, b_world, kMore * enough / extinction);
  const auto ray = smoke_ray(a_world, b_world, scratch);
  if (!ray) return 0;
  return smoke_on_ray(volume_, *ray, holes_.empty() ? nullptr : &scratch, enough / per_voxel) * per_voxel;
}

template <typename LineOf>
void Sight::depths(const LineOf& line_of_number, float enough, std::span<float> out) const {
  const float per_voxel = settings_.extinction * volume_.layout().voxel_size;
  std::fill(out.begin(), out.end(), 0.0f);
  if (settings_.drawn) {
    HolesOnRay none;
    for (std::size_t i = 0; i < out.size(); ++i)
      if (const std::optional<Line> line = line_of_number(i))
        out[i] = depth(line->a_world, line->b_world, enough, none);
    return;
  }
  SmokePacket packet(volume_, !holes_.empty(), enough / per_voxel, out);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::optional<Line> line = line_of_number(i);
    if (!line || !(per_voxel > 0)) continue;
    const std::size_t lane = packet.free_lane();
    const auto ray = smoke_ray(line->a_world, line->b_world, packet.holes(lane));
    if (ray) packet.start(lane, *ray, i);
  }
  packet.finish();
  for (float& depth : out) depth *= per_voxel;
}

std::size_t Sight::grain() const {
  return settings_.drawn ? kDrawnGrain : kGrain;
}

std::optional<SightWall> Sight::wall(glm::dvec3 a_world, glm::dvec3 b_world, bool b_hides) const {
  return first_solid_between(level_, a_world, b_world, b_hides);
}

bool Sight::is_visible(const Segment& segment, float threshold, HolesOnRay& scratch) const {
  const auto [a, b] = line_of(segment);
  return !wall(a, b, false) && depth(a, b, threshold, scratch) <= threshold;
}

SensorSample Sight::surface_sample(const SensorRay& ray, const SurfaceAlbedo& albedo) const {
  const auto [a, b] = line_of(ray, ray.max_distance);
  SensorSample sample;
  sample.surface = wall(a, b, true);
  sample.distance = sample.surface ? sample.surface->distance : ray.max_distance;
  sample.smoke_albedo = settings_.smoke_albedo;
  if (sample.surface && albedo) sample.surface_albedo = albedo(*sample.surface);
  return sample;
}

Result<float> Sight::optical_depth(glm::vec3 a_world, glm::vec3 b_world) const {
  if (auto ok = check(Segment{a_world, b_world}); !ok) return ok.failure();
  HolesOnRay scratch;
  return depth(glm::dvec3(a_world), glm::dvec3(b_world), kNeverEnough, scratch);
}

Result<void> Sight::optical_depths(std::span<const Segment> segments, std::span<float> out) const {
  if (auto ok = check_all(segments, out.size()); !ok) return ok;
  parallel_for(segments.size(), grain(), [&](std::size_t begin, std::size_t end) {
    depths([&](std::size_t i) { return std::optional(line_of(segments[begin + i])); }, kNeverEnough,
           out.subspan(begin, end - begin));
  });
  return {};
}

Result<bool> Sight::visible(glm::vec3 a_world, glm::vec3 b_world, float threshold) const {
  if (auto ok = check_threshold(threshold); !ok) return ok.failure();
  if (auto ok = check(Segment{a_world, b_world}); !ok) return ok.failure();
  HolesOnRay scratch;
  return is_visible({a_world, b_world}, threshold, scratch);
}

Result<void> Sight::visible(std::span<const Segment> segments, float threshold,
                            std::span<std::uint8_t> out) const {
  if (auto ok = check_threshold(threshold); !ok) return ok;
  if (auto ok = check_all(segments, out.size()); !ok) return ok;
  parallel_for(segments.size(), grain(), [&](std::size_t begin, std::size_t end) {
    std::array<float, kGrain> depth;
    // Lines that meet a wall are hidden already: their depth is not needed.
    const auto line = [&](std::size_t i) -> std::optional<Line> {
      const Line between = line_of(segments[begin + i]);
      out[begin + i] = wall(between.a_world, between.b_world, false) ? 0 : 1;
      return out[begin + i] != 0 ? std::optional(between) : std::nullopt;
    };
    depths(line, threshold, std::span(depth).first(end - begin));
    for (std::size_t i = begin; i < end; ++i)
      if (!(depth[i - begin] <= threshold)) out[i] = 0;
  });
  return {};
}

Result<std::optional<SightWall>> Sight::first_wall(glm::vec3 a_world, glm::vec3 b_world) const {
  if (auto ok = check(Segment{a_world, b_world}); !ok) return ok.failure();
  return wall(glm::dvec3(a_world), glm::dvec3(b_world), false);
}

Result<SensorSample> Sight::sense(const SensorRay& ray, const SurfaceAlbedo& albedo) const {
  if (auto ok = check(ray); !ok) return ok.failure();
  HolesOnRay scratch;
  SensorSample sample = surface_sample(ray, albedo);
  const auto [a, b] = line_of(ray, sample.distance);
  sample.optical_depth = depth(a, b, kNeverEnough, scratch);
  return sample;
}

Result<void> Sight::sense(std::span<const SensorRay> rays, const SurfaceAlbedo& albedo,
                          std::span<SensorSample> out) const {
  if (auto ok = check_all(rays, out.size()); !ok) return ok;
  parallel_for(rays.size(), grain(), [&](std::size_t begin, std::size_t end) {
    std::array<float, kGrain> depth;
    const auto line = [&](std::size_t i) {
      out[begin + i] = surface_sample(rays[begin + i], albedo);
      return std::optional(line_of(rays[begin + i], out[begin + i].distance));
    };
    depths(line, kNeverEnough, std::span(depth).first(end - begin));
    for (std::size_t i = begin; i < end; ++i) out[i].optical_depth = depth[i - begin];
  });
  return {};
}

}  // namespace brume::smoke
