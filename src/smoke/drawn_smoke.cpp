#include "smoke/drawn_smoke.hpp"

#include <algorithm>
#include <cmath>

#include "shared/erosion.h"
#include "shared/hole_reach.h"
#include "smoke/sight_smoke.hpp"

namespace brume::smoke {

DrawnSmoke::DrawnSmoke(const SmokeInput& input, const std::function<const SmokeNoise&()>& noise,
                       const MaskAtlas* masks)
    : input_(input), masks_(masks) {
  const shared::SmokeLook& look = input.look;
  if (look.erosion > 0 || (!input.holes.empty() && look.hole_rim > 0)) noise_ = &noise();
  if (noise_ && input.state) {
    advection_.emplace(*input.volume, *input.state, look, double{input.time}, input.swirl_period);
    displacements_ = std::make_unique<LazyDisplacement[]>(input.volume->slot_count());
  }
  find_holes();
}

void DrawnSmoke::find_holes() {
  const SmokeVolume& volume = *input_.volume;
  const shared::VolumeLayout& layout = volume.layout();
  // As many as a frame cuts: the last ones.
  const std::size_t count = std::min<std::size_t>(input_.holes.size(), shared::kMaxHoles);
  const std::size_t first = input_.holes.size() - count;
  holes_of_.resize(volume.slot_count());
  for (std::size_t i = first; i < input_.holes.size(); ++i) {
    const shared::HoleReach reach = shared::hole_reach(input_.holes[i], input_.time, input_.look.hole_rim);
    if (reach.length_m < 0) continue;
    for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
      if (!volume.in_use(slot)) continue;
      const glm::vec3 low = layout.origin_world + layout.voxel_size * glm::vec3(8 * volume.brick_of(slot));
      if (shared::hole_reach_within(reach, low, low + 8 * layout.voxel_size).length_m >= 0)
        holes_of_[slot].push_back(static_cast<std::uint32_t>(i));
    }
  }
}

const DrawnSmoke::BrickDisplacement& DrawnSmoke::displacement(std::uint32_t slot) const {
  LazyDisplacement& lazy = displacements_[slot];
  std::call_once(lazy.found, [&] {
    lazy.texels = std::make_unique<BrickDisplacement>();
    advection_->write(slot, *lazy.texels);
  });
  return *lazy.texels;
}

DrawnSmoke::Noise DrawnSmoke::noise_at(const glm::vec3& p_world, const glm::vec3& p_voxel, std::uint32_t slot,
                                       float density) const {
  glm::vec3 p = p_world;
  if (advection_) {
    const glm::vec3 at = p_voxel - glm::vec3(8 * input_.volume->brick_of(slot)) + 0.5f;
    const glm::vec3 low = glm::min(glm::floor(at), glm::vec3(8)), f = at - low;
    const glm::ivec3 t(low);
    const glm::vec3* const texel = displacement(slot).data() + t.x + 10 * (t.y + 10 * t.z);
    const auto row = [&](int offset) { return glm::mix(texel[offset], texel[offset + 1], f.x); };
    p += glm::mix(glm::mix(row(0), row(10), f.y), glm::mix(row(100), row(110), f.y), f.z);
  }
  const shared::SmokeLook& look = input_.look;
  const glm::vec4 tile = smoke::noise_at(noise_->tile, shared::noise_point(look, p, input_.time));
  // The rims of holes have detail wherever they are.
  const float threshold = shared::erosion_threshold(look, density, shared::billows_and_wisps(tile));
  if (holes_of_[slot].empty() && !shared::detail_matters(look, density, threshold, look.detail))
    return {tile, glm::vec2(0)};
  const glm::vec4 texel = smoke::noise_at(noise_->detail, shared::detail_point(look, p, input_.time));
  return {tile, shared::detail_of(glm::vec2(texel))};
}

float DrawnSmoke::density(const glm::vec3& p_world) const {
  const SmokeVolume& volume = *input_.volume;
  const shared::VolumeLayout& layout = volume.layout();
  const glm::vec3 p_voxel = (p_world - layout.origin_world) * layout.voxels_per_metre;
  float density = sample_density(volume, p_voxel);
  if (!(density > 0)) return 0;
  const std::uint32_t slot = volume.slot_at(glm::ivec3(glm::floor(p_voxel * 0.125f)));
  const shared::SmokeLook& look = input_.look;
  const Noise noise = noise_ ? noise_at(p_world, p_voxel, slot, density) : Noise{};
  if (look.erosion > 0) density = shared::erode(look, density, noise.tile, noise.detail, look.detail);
  static const MaskAtlas kNoMasks;
  for (const std::uint32_t i : holes_of_[slot]) {
    if (!(density > 0)) return 0;
    const shared::Hole& hole = input_.holes[i];
    const float rim =
        shared::rim_noise(noise.tile, noise.detail, look.detail) * shared::hole_rim(hole, look.hole_rim);
    density *= 1 - hole_strength_masked(hole, p_world, input_.time, rim, masks_ ? *masks_ : kNoMasks);
  }
  return density;
}

float DrawnSmoke::integral(const glm::dvec3& a_world, const glm::dvec3& b_world, float enough) const {
  const shared::VolumeLayout& layout = input_.volume->layout();
  const glm::dvec3 origin(layout.origin_world);
  const double size = layout.voxel_size;
  const auto ray = clip_to_smoke(layout, (a_world - origin) / size, (b_world - origin) / size);
  if (!ray) return 0;
  const glm::dvec3 direction(double{ray->direction[0]}, double{ray->direction[1]}, double{ray->direction[2]});
  const glm::dvec3 first = a_world + ray->skipped * size * direction;
  const double length = double{ray->length} * size;
  const double texel =
      1 / (double{input_.look.noise_frequency} * double{shared::kDetailRatio} * shared::kDetailTexels);
  const double count = std::ceil(length / (kLineStep * texel)), step = length / count;
  double sum = 0;
  for (double i = 0; i < count && !(sum * step > double{enough}); ++i)
    sum += double{density(glm::vec3(first + (i + 0.5) * step * direction))};
  return static_cast<float>(sum * step);
}

}  // namespace brume::smoke
