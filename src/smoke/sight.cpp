#include "smoke/sight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/tasks.hpp"
#include "smoke/sight_smoke.hpp"
#include "smoke/sight_walls.hpp"

namespace brume::smoke {
namespace {

constexpr float kNeverEnough = std::numeric_limits<float>::infinity();
constexpr std::size_t kGrain = 256;  // queries of a task: some 0.2 ms

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

/// Checks all of them, naming the first that is bad.
template <typename Query>
Result<void> check_all(std::span<const Query> queries, std::size_t results) {
  BRUME_ASSERT(queries.size() == results, "as many results as queries");
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (check(queries[i])) continue;
    return check(queries[i], " of query " + std::to_string(i));
  }
  return {};
}

/// Calls answer(index, scratch) for each query, over all threads.
template <typename Answer>
void answer_all(std::size_t count, const Answer& answer) {
  parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
    HolesOnRay scratch;
    for (std::size_t i = begin; i < end; ++i) answer(i, scratch);
  });
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

float Sight::depth(glm::dvec3 a_world, glm::dvec3 b_world, float enough, HolesOnRay& scratch) const {
  const shared::VolumeLayout& layout = volume_.layout();
  const glm::dvec3 origin(layout.origin_world);
  const double size = layout.voxel_size;
  const auto ray = clip_to_smoke(layout, (a_world - origin) / size, (b_world - origin) / size);
  const float per_voxel = settings_.extinction * layout.voxel_size;
  if (!ray || !(per_voxel > 0)) return 0;
  if (holes_.empty()) return smoke_on_ray(volume_, *ray, nullptr, enough / per_voxel) * per_voxel;
  const glm::dvec3 step(double{ray->direction[0]} * size, double{ray->direction[1]} * size,
                        double{ray->direction[2]} * size);
  holes_.find(glm::vec3(a_world + ray->skipped * step), glm::vec3(step), ray->length, scratch);
  return smoke_on_ray(volume_, *ray, &scratch, enough / per_voxel) * per_voxel;
}

std::optional<SightWall> Sight::wall(glm::dvec3 a_world, glm::dvec3 b_world, bool b_hides) const {
  return first_solid_between(level_, a_world, b_world, b_hides);
}

bool Sight::is_visible(const Segment& segment, float threshold, HolesOnRay& scratch) const {
  const glm::dvec3 a(segment.a_world), b(segment.b_world);
  return !wall(a, b, false) && depth(a, b, threshold, scratch) <= threshold;
}

SensorSample Sight::sample(const SensorRay& ray, const SurfaceAlbedo& albedo, HolesOnRay& scratch) const {
  const glm::dvec3 a(ray.origin_world), d(ray.direction_world);
  const glm::dvec3 direction = d / std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  SensorSample sample;
  sample.surface = wall(a, a + double{ray.max_distance} * direction, true);
  sample.distance = sample.surface ? sample.surface->distance : ray.max_distance;
  sample.optical_depth = depth(a, a + double{sample.distance} * direction, kNeverEnough, scratch);
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
  answer_all(segments.size(), [&](std::size_t i, HolesOnRay& scratch) {
    out[i] = depth(glm::dvec3(segments[i].a_world), glm::dvec3(segments[i].b_world), kNeverEnough, scratch);
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
  answer_all(segments.size(), [&](std::size_t i, HolesOnRay& scratch) {
    out[i] = is_visible(segments[i], threshold, scratch) ? 1 : 0;
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
  return sample(ray, albedo, scratch);
}

Result<void> Sight::sense(std::span<const SensorRay> rays, const SurfaceAlbedo& albedo,
                          std::span<SensorSample> out) const {
  if (auto ok = check_all(rays, out.size()); !ok) return ok;
  answer_all(rays.size(),
             [&](std::size_t i, HolesOnRay& scratch) { out[i] = sample(rays[i], albedo, scratch); });
  return {};
}

}  // namespace brume::smoke
