// Carriers: paths with rotations, which volumes, decals and objects follow.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace brume::scene {

/// Where a carrier is at one time.
struct CarrierKey {
  double time = 0;  ///< [s], [0, 3600].
  glm::vec3 position_world{0};
  glm::vec3 rotation{0};  ///< About x, then y, then z [degrees]; may exceed a turn.

  bool operator==(const CarrierKey&) const = default;
};

/// What volumes and decals move with, and objects of the scene: a drone, an engine.
struct Carrier {
  std::string name;
  /// Objects of the scene that move with it: the place and rotation of the first of this name are replaced by
  /// those of the carrier, and the others stay where they are beside it. Empty: none.
  std::string object = {};
  std::vector<CarrierKey> keys;  ///< At least one, sorted by time, no two times equal.
  std::string place = {};        ///< "file:line:column" for error messages.

  bool operator==(const Carrier&) const = default;
};

/// Where a carrier is at a time [s], as a key of that time: passes through all keys with continuous velocity,
/// at rest before the first and after the last.
CarrierKey key_at(const Carrier& carrier, double time);

/// world_from_carrier of key_at.
glm::mat4 pose_at(const Carrier& carrier, double time);

/// Rotation about x, then y, then z [degrees].
glm::mat4 rotation_of(const glm::vec3& degrees);

/// The pose of a carrier by its name at a time; the identity without one.
glm::mat4 pose_of(std::span<const Carrier> carriers, const std::string& name, double time);

}  // namespace brume::scene
