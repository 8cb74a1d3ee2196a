#include "smoke/noise_displacement.hpp"

#include <algorithm>

#include "shared/noise_advection.h"
#include "smoke/texel_set.hpp"

namespace brume::smoke {

NoiseDisplacement::NoiseDisplacement(const SmokeVolume& volume, const sim::State& state,
                                     const shared::SmokeLook& look, double seconds, double swirl_period)
    : volume_(volume),
      swirl_(look.swirl),
      swirl_width_(look.swirl_width),
      motion_(noise_motion(state, seconds, swirl_period)) {
  growth_.update(state, volume);
}

void NoiseDisplacement::write(std::uint32_t slot, std::span<glm::vec3, shared::kTexelsPerBrick> out) const {
  std::fill(out.begin(), out.end(), glm::vec3(0));
  const TexelSet wanted = dilated(smoky_texels(volume_.texels(slot)));
  if (wanted.none()) return;
  const shared::VolumeLayout& layout = volume_.layout();
  const glm::ivec3 first = shared::kBrickVoxels * volume_.brick_of(slot);
  for (std::uint32_t i = 0; i < shared::kTexelsPerBrick; ++i) {
    if (!wanted[i]) continue;
    const glm::ivec3 local = texel_at(i);
    const glm::vec3 p_voxel = glm::vec3(first + local) - 0.5f;
    const glm::vec3 p_world = layout.origin_world + p_voxel * layout.voxel_size;
    out[i] = by_clouds(slot, local, p_world) + motion_.by_impulses(p_world);
  }
}

glm::vec4 growth_at(PartDisplacements points, glm::ivec3 local) {
  glm::vec4 sum(0);
  float weight = 0;
  for (int i = 0; i < 8; ++i) {
    const float share = shared::growth_share(local, i);
    if (share <= 0) continue;  // may be beyond the last point
    const glm::uvec2 words = points[shared::growth_point(local, i)];
    const glm::vec2 high = glm::unpackHalf2x16(words.y);
    // Outside of the cloud its growth is extrapolated from inside.
    if (high.y > 0) sum += share * glm::vec4(glm::unpackHalf2x16(words.x), high.x, 1);
    weight += share * high.y;
  }
  return {glm::vec3(sum) / std::max(sum.w, 1e-6f), weight};
}

glm::vec3 NoiseDisplacement::by_clouds(std::uint32_t slot, glm::ivec3 local, glm::vec3 p_world) const {
  const glm::uvec2 range = growth_.parts()[slot];
  if (range.y == 0) return glm::vec3(0);
  const glm::vec3 one = shared::first_swirl(p_world, swirl_width_);
  const glm::vec3 other = shared::second_swirl(p_world, swirl_width_);
  glm::vec4 sum(0);
  for (const glm::uvec2 part : growth_.parts().subspan(volume_.slot_count() + range.x, range.y)) {
    const shared::CloudMotion& motion = motion_.clouds[part.y];
    const glm::vec3 swirl = swirl_ * (motion.swirl_cos * one + motion.swirl_sin * other);
    sum += shared::cloud_displacement(motion, growth_at(growth_.displacements(part.x), local), swirl,
                                      volume_.layout().voxel_size);
  }
  return glm::vec3(sum) / std::max(sum.w, 1e-12f);
}

}  // namespace brume::smoke
