#include "scene/camera_path.hpp"

#include <cmath>

#include "scene/key_path.hpp"

namespace brume::scene {

glm::dvec3 parabola_speed(const double (&time)[3], const glm::dvec3 (&value)[3]) {
  const double before = time[1] - time[0], after = time[2] - time[1];
  return ((value[1] - value[0]) * (after / before) + (value[2] - value[1]) * (before / after)) /
         (before + after);
}

double monotone_speed(const double (&time)[3], const double (&value)[3]) {
  const double before = time[1] - time[0], after = time[2] - time[1];
  const double slope_before = (value[1] - value[0]) / before, slope_after = (value[2] - value[1]) / after;
  if (slope_before * slope_after <= 0) return 0;
  const double weight_before = 2 * after + before, weight_after = after + 2 * before;
  return (weight_before + weight_after) / (weight_before / slope_before + weight_after / slope_after);
}

namespace {

class Path {
 public:
  explicit Path(const std::vector<CameraKey>& keys) : keys_(keys) {}

  /// The camera between keys[span] and keys[span + 1].
  Camera at(std::size_t span, double time) const {
    const CameraKey &begin = keys_[span], &end = keys_[span + 1];
    const double seconds = end.time - begin.time, s = (time - begin.time) / seconds;
    const auto vector = [&](glm::vec3 Camera::*member) {
      return smooth_at(std::span(keys_), time, [&](const CameraKey& key) { return key.camera.*member; });
    };
    Camera camera;
    camera.position_world = vector(&Camera::position_world);
    camera.target_world = vector(&Camera::target_world);
    const auto number = [&](const auto& member) {
      return static_cast<float>(hermite(double{member(begin)}, double{member(end)}, speed(span, member),
                                        speed(span + 1, member), seconds, s));
    };
    camera.vertical_fov = number([](const CameraKey& key) { return key.camera.vertical_fov; });
    camera.lens.aperture = number([](const CameraKey& key) { return key.camera.lens.aperture; });
    camera.lens.focus = number(focus_of);
    camera.lens.blades = begin.camera.lens.blades;
    camera.lens.opening = begin.camera.lens.opening;
    camera.shutter = number([](const CameraKey& key) { return key.camera.shutter; });
    // Position and target may coincide where their paths cross: keep the direction of the span's start.
    if (glm::distance(camera.position_world, camera.target_world) < 1e-4f)
      camera.target_world = camera.position_world + begin.camera.target_world - begin.camera.position_world;
    return camera;
  }

 private:
  bool is_inner(std::size_t key) const { return key > 0 && key + 1 < keys_.size(); }

  static float focus_of(const CameraKey& key) { return focus_distance(key.camera); }

  /// How fast a number of the keys changes at a key, without overshooting. Zero at both ends of the path, so
  /// that the camera starts and stops smoothly.
  template <typename Member>
  double speed(std::size_t key, const Member& member) const {
    if (!is_inner(key)) return 0;
    const CameraKey &a = keys_[key - 1], &b = keys_[key], &c = keys_[key + 1];
    return monotone_speed({a.time, b.time, c.time}, {member(a), member(b), member(c)});
  }

  const std::vector<CameraKey>& keys_;
};

}  // namespace

Camera camera_at(const std::vector<CameraKey>& keys, const Camera& fallback, double time) {
  if (keys.empty()) return fallback;
  const auto [before, after] = span_at(std::span(keys), time);
  if (before == after) return keys[before].camera;
  return Path(keys).at(before, time);
}

}  // namespace brume::scene
