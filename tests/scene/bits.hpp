// The bits of all that a file holds, for exact comparison of what was written and what is read.
#pragma once

#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/options.hpp"

namespace brume::scene {

/// A visitor of options; what is none of them is added by hand.
class Bits {
 public:
  template <typename Member>
  void operator()(const OptionInfo&, const Member& member) {
    add(member);
  }
  void operator()(const ChoiceField&, const auto& choice) { add(static_cast<std::uint32_t>(choice)); }
  void add(float v) { bits.push_back(std::bit_cast<std::uint32_t>(v)); }
  void add(double v) { bits.push_back(std::bit_cast<std::uint64_t>(v)); }
  void add(std::uint32_t v) { bits.push_back(v); }
  void add(std::size_t v) { bits.push_back(v); }
  void add(bool v) { bits.push_back(v); }
  void add(const glm::vec3& v) { add(v.x), add(v.y), add(v.z); }
  void add(const glm::ivec3& v) {
    for (int axis = 0; axis < 3; ++axis) bits.push_back(static_cast<std::uint64_t>(v[axis]));
  }
  void add(const std::string& text) {
    bits.push_back(text.size());
    for (const char c : text) bits.push_back(static_cast<unsigned char>(c));
  }
  template <typename T>
  void add(const std::optional<T>& v) {
    add(v.has_value());
    if (v) add(*v);
  }
  std::vector<std::uint64_t> bits;
};

inline void add_camera(Bits& bits, const std::vector<CameraKey>& keys) {
  bits.add(keys.size());
  for (const CameraKey& key : keys) {
    bits.add(key.time), bits.add(key.camera.position_world), bits.add(key.camera.target_world);
    visit_camera_options(key.camera, bits);
    bits.add(key.camera.lens.opening.string());
  }
}

}  // namespace brume::scene
