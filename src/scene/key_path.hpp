// Smooth paths through keys. Internal to this folder.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>

namespace brume::scene {

/// The velocity at the middle of three keys: the slope of the parabola through them (non-uniform
/// Catmull-Rom).
glm::dvec3 parabola_speed(const double (&time)[3], const glm::dvec3 (&value)[3]);

/// A velocity without overshoot: the weighted harmonic mean of the slopes on both sides, zero where their
/// signs differ (Fritsch and Butland 1984).
double monotone_speed(const double (&time)[3], const double (&value)[3]);

/// The cubic Hermite polynomial over a span of `seconds`, at `s` in [0, 1].
template <typename T>
T hermite(T begin, T end, T begin_speed, T end_speed, double seconds, double s) {
  const double s2 = s * s, s3 = s2 * s;
  return begin * (2 * s3 - 3 * s2 + 1) + end * (3 * s2 - 2 * s3) +
         begin_speed * (seconds * (s3 - 2 * s2 + s)) + end_speed * (seconds * (s3 - s2));
}

/// Where a time lies among keys that rise by `time`: of at least one key, the one before and the one behind;
/// the same one twice before the first and after the last.
struct KeySpan {
  std::size_t before = 0, after = 0;
};
template <typename Key>
KeySpan span_at(std::span<const Key> keys, double time) {
  if (!(time > keys.front().time)) return {0, 0};
  if (time >= keys.back().time) return {keys.size() - 1, keys.size() - 1};
  const auto after =
      std::upper_bound(keys.begin(), keys.end(), time, [](double t, const Key& key) { return t < key.time; });
  const auto i = static_cast<std::size_t>(after - keys.begin());
  return {i - 1, i};
}

/// A vector at a time: passes through all keys with continuous velocity, at rest at both ends.
template <typename Key, typename Value>
glm::vec3 smooth_at(std::span<const Key> keys, double time, const Value& value_of) {
  const auto [before, after] = span_at(keys, time);
  if (before == after) return glm::vec3(value_of(keys[before]));
  const auto speed = [&](std::size_t i) {
    if (i == 0 || i + 1 == keys.size()) return glm::dvec3(0);
    return parabola_speed({keys[i - 1].time, keys[i].time, keys[i + 1].time},
                          {glm::dvec3(value_of(keys[i - 1])), glm::dvec3(value_of(keys[i])),
                           glm::dvec3(value_of(keys[i + 1]))});
  };
  const double seconds = keys[after].time - keys[before].time;
  return glm::vec3(hermite(glm::dvec3(value_of(keys[before])), glm::dvec3(value_of(keys[after])),
                           speed(before), speed(after), seconds, (time - keys[before].time) / seconds));
}

}  // namespace brume::scene
