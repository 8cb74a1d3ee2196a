// What a frame of a test shows, in one expression.
#pragma once

#include <utility>

#include "planning/frame_input.hpp"
#include "tests/worlds.hpp"

namespace brume::planning {

/// A volume of one brick at the origin, whose values do not matter.
inline volume::SparseVolume one_brick() {
  volume::SparseVolume volume({{}, 1, {{2}}});
  volume.begin_update();
  volume.acquire({0, 0, 0});
  volume.set_bounds(glm::vec3(0), glm::vec3(8));
  volume.end_update();
  return volume;
}

/// What the input refers to must outlive it.
class FrameBuilder {
 public:
  FrameBuilder& eye(const glm::vec3& from_world, const glm::vec3& to_world, float vertical_fov) {
    input_.view.camera = {from_world, to_world, vertical_fov};
    return *this;
  }
  FrameBuilder& light(const shared::Light& light) {
    input_.environment.flashes.push_back(light);
    return *this;
  }
  FrameBuilder& ambient(const glm::vec3& radiance) {
    input_.environment.sky.ambient = radiance;
    return *this;
  }
  /// The smoke of a world, in its level.
  FrameBuilder& smoke(const SmokeWorld& world, float extinction) {
    input_.smoke.volume = &world.volume;
    input_.smoke.state = &world.world.state();
    input_.smoke.look.extinction = extinction;
    input_.level.voxels.grid = &world.grid;
    return *this;
  }
  FrameBuilder& holes(std::span<const shared::Hole> holes) {
    input_.smoke.holes = holes;
    return *this;
  }
  FrameBuilder& time(float seconds) {
    input_.smoke.time = seconds;
    return *this;
  }
  FrameBuilder& volume(VolumeInput volume) {
    input_.volumes.push_back(std::move(volume));
    return *this;
  }
  FrameInput input() const { return input_; }

 private:
  FrameInput input_;
};

}  // namespace brume::planning
