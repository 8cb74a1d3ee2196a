#include <algorithm>
#include <cmath>

#include "scene/timeline.hpp"

namespace brume::scene {
namespace {

/// The velocity at the middle of three keys: that of the parabola through them (non-uniform Catmull-Rom).
glm::dvec3 parabola_speed(const double (&time)[3], const glm::dvec3 (&value)[3]) {
  const double before = time[1] - time[0], after = time[2] - time[1];
  return ((value[1] - value[0]) * (after / before) + (value[2] - value[1]) * (before / after)) /
         (before + after);
}

/// A velocity without overshoot: the weighted harmonic mean of the slopes on both sides, zero where their
/// signs differ (Fritsch and Butland 1984).
double monotone_speed(const double (&time)[3], const double (&value)[3]) {
  const double before = time[1] - time[0], after = time[2] - time[1];
  const double slope_before = (value[1] - value[0]) / before, slope_after = (value[2] - value[1]) / after;
  if (slope_before * slope_after <= 0) return 0;
  const double weight_before = 2 * after + before, weight_after = after + 2 * before;
  return (weight_before + weight_after) / (weight_before / slope_before + weight_after / slope_after);
}

/// The cubic Hermite polynomial over a span of `seconds`, at `s` in [0, 1].
template <typename T>
T hermite(T begin, T end, T begin_speed, T end_speed, double seconds, double s) {
  const double s2 = s * s, s3 = s2 * s;
  return begin * (2 * s3 - 3 * s2 + 1) + end * (3 * s2 - 2 * s3) +
         begin_speed * (seconds * (s3 - 2 * s2 + s)) + end_speed * (seconds * (s3 - s2));
}

class Path {
 public:
  explicit Path(const std::vector<CameraKey>& keys) : keys_(keys) {}

  /// The camera between keys[span] and keys[span + 1].
  Camera at(std::size_t span, double time) const {
    const CameraKey &begin = keys_[span], &end = keys_[span + 1];
    const double seconds = end.time - begin.time, s = (time - begin.time) / seconds;
    const auto vector = [&](glm::vec3 Camera::*member) {
      return glm::vec3(hermite(glm::dvec3(begin.camera.*member), glm::dvec3(end.camera.*member),
                               speed(span, member), speed(span + 1, member), seconds, s));
    };
    Camera camera;
    camera.position_world = vector(&Camera::position_world);
    camera.target_world = vector(&Camera::target_world);
    camera.vertical_fov =
        static_cast<float>(hermite(double{begin.camera.vertical_fov}, double{end.camera.vertical_fov},
                                   fov_speed(span), fov_speed(span + 1), seconds, s));
    // Position and target may coincide where their paths cross: keep the direction of the span's start.
    if (glm::distance(camera.position_world, camera.target_world) < 1e-4f)
      camera.target_world = camera.position_world + begin.camera.target_world - begin.camera.position_world;
    return camera;
  }

 private:
  bool is_inner(std::size_t key) const { return key > 0 && key + 1 < keys_.size(); }

  /// Zero at both ends of the path, so that the camera starts and stops smoothly.
  glm::dvec3 speed(std::size_t key, glm::vec3 Camera::*member) const {
    if (!is_inner(key)) return glm::dvec3(0);
    const CameraKey &a = keys_[key - 1], &b = keys_[key], &c = keys_[key + 1];
    return parabola_speed(
        {a.time, b.time, c.time},
        {glm::dvec3(a.camera.*member), glm::dvec3(b.camera.*member), glm::dvec3(c.camera.*member)});
  }

  double fov_speed(std::size_t key) const {
    if (!is_inner(key)) return 0;
    const CameraKey &a = keys_[key - 1], &b = keys_[key], &c = keys_[key + 1];
    return monotone_speed({a.time, b.time, c.time},
                          {a.camera.vertical_fov, b.camera.vertical_fov, c.camera.vertical_fov});
  }

  const std::vector<CameraKey>& keys_;
};

}  // namespace

Camera camera_at(const Timeline& timeline, const Camera& fallback, double time) {
  const std::vector<CameraKey>& keys = timeline.camera;
  if (keys.empty()) return fallback;
  if (!(time > keys.front().time)) return keys.front().camera;
  if (time >= keys.back().time) return keys.back().camera;
  const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                      [](double t, const CameraKey& key) { return t < key.time; });
  return Path(keys).at(static_cast<std::size_t>(after - keys.begin()) - 1, time);
}

}  // namespace brume::scene
