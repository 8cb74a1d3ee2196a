#include "reference/near_lights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume::reference {
namespace {

/// As far as densities go, a line is never nearer to a light: smaller angles lose digits [m].
constexpr float kLeastDistance = 1e-3f;

/// From `begin` to `end` along a line.
struct Interval {
  float begin, end;
  bool empty() const { return !(begin < end); }
};
constexpr float kFar = std::numeric_limits<float>::infinity();

Interval common(const Interval& a, const Interval& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

/// Where a line is inside the cone of a spot; `from`: from the light to the line's place 0. All of the line
/// where the cone is wider than a half-space, and not convex.
Interval in_cone(const shared::Light& spot, const glm::vec3& from, const glm::vec3& direction) {
  if (!(spot.cos_outer > 0)) return {-kFar, kFar};
  // a t^2 + 2 b t + c is above 0 inside of the cone and of its mirror image behind the light.
  const float cos2 = spot.cos_outer * spot.cos_outer;
  const float m = glm::dot(from, spot.direction), n = glm::dot(direction, spot.direction);
  const float a = n * n - cos2, b = m * n - cos2 * glm::dot(from, direction),
              c = m * m - cos2 * glm::dot(from, from), root2 = b * b - a * c;
  if (std::abs(a) < 1e-6f) return {-kFar, kFar};
  if (!(root2 > 0)) return a > 0 ? Interval{-kFar, kFar} : Interval{0, 0};
  const float root = std::copysign(std::sqrt(root2), a), low = (-b - root) / a, high = (-b + root) / a;
  // Through one of both, or out of one and into the other.
  if (a < 0) return m + 0.5f * (low + high) * n > 0 ? Interval{low, high} : Interval{0, 0};
  return n > 0 ? Interval{high, kFar} : Interval{-kFar, low};
}

/// The part outside of which the cells of all media are empty.
Interval in_media(const Media& media, const Ray& ray, const Interval& interval) {
  Interval found{interval.end, interval.begin};
  const Ray part{ray.at(interval.begin), ray.direction, interval.end - interval.begin, ray.time};
  for (const auto& medium : media.all())
    medium->majorants().traverse(medium->at_rest(part), [&](float begin, float end, float) {
      found.begin = std::min(found.begin, interval.begin + begin);
      found.end = std::max(found.end, interval.begin + end);
      return false;
    });
  return found;
}

}  // namespace

LightChord::LightChord(float nearest, float distance, float begin, float end)
    : nearest_(nearest),
      distance_(std::max(distance, kLeastDistance)),
      begin_(begin - nearest),
      end_(end - nearest) {
  const float half2 = kConstantWithin * kConstantWithin - distance_ * distance_;
  const float half = half2 > 0 ? std::sqrt(half2) : 0;
  within_begin_ = half > 0 ? std::clamp(-half, begin_, end_) : end_;
  within_end_ = half > 0 ? std::clamp(half, begin_, end_) : end_;
  before_ = integral_between(begin_, within_begin_);
  within_ = (within_end_ - within_begin_) / (kConstantWithin * kConstantWithin);
  after_ = integral_between(within_end_, end_);
}

/// The angle between both places at the light, by the distance.
float LightChord::integral_between(float a, float b) const {
  return std::atan2(distance_ * (b - a), distance_ * distance_ + a * b) / distance_;
}

/// The place at a fraction of that angle.
float LightChord::sample_between(float a, float b, float u) const {
  const float angle = u * integral_between(a, b) * distance_, sine = std::sin(angle),
              cosine = std::cos(angle);
  return std::clamp(distance_ * (a * cosine + distance_ * sine) / (distance_ * cosine - a * sine), a, b);
}

float LightChord::sample(float u) const {
  const float chosen = u * integral(), rest = chosen - before_;
  if (rest < 0) return nearest_ + sample_between(begin_, within_begin_, chosen / before_);
  if (rest < within_) return nearest_ + glm::mix(within_begin_, within_end_, rest / within_);
  if (!(after_ > 0)) return nearest_ + within_end_;
  return nearest_ + sample_between(within_end_, end_, std::min((rest - within_) / after_, 1.0f));
}

float LightChord::density(float t) const {
  const float from_nearest = t - nearest_;
  if (!(from_nearest >= begin_ && from_nearest <= end_)) return 0;
  const float d2 = distance_ * distance_ + from_nearest * from_nearest;
  return 1 / (std::max(d2, kConstantWithin * kConstantWithin) * integral());
}

void NearChords::find(const Scene& scene, const Ray& ray) {
  chords_.clear();
  power_ = 0;
  const float near2 = scene.near * scene.near;
  for (const NearLight& one : scene.near_lights) {
    const shared::Light& light = scene.lights[one.light];
    // In the sphere.
    const glm::vec3 to_light = light.position_world - ray.origin;
    const float nearest = glm::dot(to_light, ray.direction);
    const glm::vec3 from = nearest * ray.direction - to_light;
    const float distance2 = glm::dot(from, from);
    if (!(distance2 < near2)) continue;
    const float half = std::sqrt(near2 - distance2);
    Interval part = common({nearest - half, nearest + half}, {0, ray.end});
    // In the cone, and in media.
    if (light.kind == shared::kLightSpot && !part.empty()) {
      const Interval lit = in_cone(light, from, ray.direction);
      part = common(part, {nearest + lit.begin, nearest + lit.end});
    }
    if (!part.empty()) part = in_media(scene.media, ray, part);
    if (part.empty()) continue;
    const LightChord chord(nearest, std::sqrt(distance2), part.begin, part.end);
    const float power =
        std::max({light.intensity.r, light.intensity.g, light.intensity.b}) * chord.integral();
    if (!(power > 0)) continue;
    chords_.push_back({one.light, chord, power});
    power_ += power;
  }
}

NearChords::Point NearChords::sample(const glm::vec2& u) const {
  float chosen = u.x * power_;
  std::size_t i = 0;
  while (i + 1 < chords_.size() && chosen >= chords_[i].power) chosen -= chords_[i++].power;
  const Chord& one = chords_[i];
  const float t = one.chord.sample(u.y);
  return {one.light, t, one.chord.density(t) * one.power / power_};
}

}  // namespace brume::reference
