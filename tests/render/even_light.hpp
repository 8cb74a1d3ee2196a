// Ambient light that is the same from all directions.
#pragma once

#include "film/playback.hpp"

namespace brume::render {

/// A level of this layout whose outermost voxels are solid, and nothing else: it hides the sky everywhere.
inline voxel::BitGrid closed_level(const voxel::GridLayout& layout) {
  voxel::BitGrid grid(layout);
  for_each_in(Box<int>{glm::ivec3(0), layout.size}, [&](glm::ivec3 v) {
    if (glm::any(glm::equal(v, glm::ivec3(0))) || glm::any(glm::equal(v, layout.size - 1))) grid.set(v, true);
  });
  return grid;
}

/// Light of radiance `ambient` from everywhere: what hides the sky reflects all of it. `level`: closed_level,
/// which must outlive the input.
inline void light_evenly(FrameInput& input, const voxel::BitGrid& level, float ambient) {
  input.level.voxels = {&level, nullptr, &level};
  input.environment.sky.ambient = glm::vec3(ambient);
  input.environment.sky.bounce = 1;
}

}  // namespace brume::render
