#include "reference/smoke_medium.hpp"

#include <algorithm>
#include <cmath>

#include "planning/noise_displacement.hpp"
#include "shared/erosion.h"
#include "shared/hole_reach.h"

namespace brume::reference {
namespace {

constexpr int kPart = 4;  // Edge of the cells of the bounds [voxels].

glm::mat4 world_from_voxel(const shared::VolumeLayout& layout) {
  glm::mat4 matrix(layout.voxel_size);
  matrix[3] = glm::vec4(layout.origin_world, 1);
  return matrix;
}

std::uint32_t largest_byte(glm::uvec2 set) {
  std::uint32_t largest = 0;
  for (int corner = 0; corner < 8; ++corner)
    largest = std::max(largest, set[corner >> 2] >> (8 * (corner & 3)) & 255u);
  return largest;
}

/// The largest density of a cell of a brick's 9^3, of 255.
std::uint32_t largest_in_cell(const smoke::SmokeVolume& volume, std::uint32_t slot, const glm::ivec3& cell) {
  const std::uint32_t entry =
      volume.cells(slot)[static_cast<std::size_t>(cell.x + 9 * (cell.y + 9 * cell.z))];
  std::uint32_t largest = 0;
  if (entry != 0) {
    const shared::BoundaryCell& boundary = volume.boundary_cells()[entry - 1];
    const int planes = (boundary.plane0 != 0) + (boundary.plane1 != 0) + (boundary.plane2 != 0);
    for (std::uint32_t set = 0; set < 1u << planes; ++set)
      largest = std::max(largest, largest_byte(volume.corner_sets()[boundary.first_set + set]));
  }
  for_each_in(Box<int>{cell, cell + 2}, [&](glm::ivec3 t) {
    largest = std::max<std::uint32_t>(
        largest, volume.texels(slot)[static_cast<std::size_t>(t.x + 10 * (t.y + 10 * t.z))].density);
  });
  return largest;
}

}  // namespace

SmokeMedium::SmokeMedium(const planning::SmokeInput& smoke,
                         const std::function<const smoke::SmokeNoise&()>& noise,
                         const smoke::MaskAtlas* masks)
    : Medium(smoke.look.phase), input_(smoke), masks_(masks) {
  if (smoke.look.erosion > 0 || (!smoke.holes.empty() && smoke.look.hole_rim > 0)) noise_ = &noise();
  if (noise_ && smoke.state)
    displacements_ = planning::noise_displacement(*smoke.volume, *smoke.state, smoke.look, double{smoke.time},
                                                  smoke.swirl_period);
  find_majorants();
  find_holes();
}

void SmokeMedium::find_majorants() {
  const smoke::SmokeVolume& volume = *input_.volume;
  Box<int> all{glm::ivec3(1 << 30), glm::ivec3(-(1 << 30))};
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
    if (volume.volume().in_use(slot))
      all = united(all, {8 * volume.brick_of(slot), 8 * volume.brick_of(slot) + 8});
  if (all.empty()) return;
  majorants_ = Majorants(world_from_voxel(volume.layout()), all, kPart);
  const shared::SmokeLook& look = input_.look;
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
    if (!volume.volume().in_use(slot)) continue;
    for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(8 / kPart)}, [&](glm::ivec3 part) {
      std::uint32_t largest = 0;
      for_each_in(Box<int>{kPart * part, kPart * part + kPart + 1},
                  [&](glm::ivec3 cell) { largest = std::max(largest, largest_in_cell(volume, slot, cell)); });
      float bound = static_cast<float>(largest) / 255;
      // Where noise removes nothing, erosion multiplies low densities by four, or more with detail
      // (shared/erosion.h).
      if (look.erosion > 0) bound = std::min(4 * (1 + look.detail) * bound, 1.0f) * (1 + 0.5f * look.erosion);
      const glm::ivec3 voxel = 8 * volume.brick_of(slot) + kPart * part - all.low;
      float& stored = majorants_.at(voxel / majorants_.cell_voxels());
      stored = std::max(stored, kBoundSlack * look.extinction * bound);
    });
  }
}

void SmokeMedium::find_holes() {
  const smoke::SmokeVolume& volume = *input_.volume;
  const shared::VolumeLayout& layout = volume.layout();
  // As many as a frame cuts: the last ones.
  const std::size_t count = std::min<std::size_t>(input_.holes.size(), shared::kMaxHoles);
  const std::size_t first = input_.holes.size() - count;
  holes_of_.resize(volume.slot_count());
  for (std::size_t i = first; i < input_.holes.size(); ++i) {
    const shared::HoleReach reach = shared::hole_reach(input_.holes[i], input_.time, input_.look.hole_rim);
    if (reach.length_m < 0) continue;
    for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
      if (!volume.volume().in_use(slot)) continue;
      const glm::vec3 low = layout.origin_world + layout.voxel_size * glm::vec3(8 * volume.brick_of(slot));
      if (shared::hole_reach_within(reach, low, low + 8 * layout.voxel_size).length_m >= 0)
        holes_of_[slot].push_back(static_cast<std::uint32_t>(i));
    }
  }
}

SmokeMedium::Noise SmokeMedium::noise_at(const glm::vec3& p_world, const glm::vec3& p_voxel,
                                         std::uint32_t slot, const glm::ivec3& brick, float density) const {
  glm::vec3 p = p_world;
  if (!displacements_.empty()) {
    const glm::vec3 at = p_voxel - glm::vec3(8 * brick) + 0.5f, low = glm::min(glm::floor(at), glm::vec3(8)),
                    f = at - low;
    const glm::ivec3 t(low);
    const glm::vec3* const texel =
        displacements_.data() + std::size_t{slot} * shared::kTexelsPerBrick + t.x + 10 * (t.y + 10 * t.z);
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

float SmokeMedium::density(const glm::vec3& p_world) const {
  const smoke::SmokeVolume& volume = *input_.volume;
  const glm::vec3 p_voxel = majorants_.voxel_from_world(p_world);
  float density = smoke::sample_density(volume, p_voxel);
  if (!(density > 0)) return 0;
  const glm::ivec3 brick(glm::floor(p_voxel * 0.125f));
  const std::uint32_t slot = volume.slot_at(brick);
  const shared::SmokeLook& look = input_.look;
  const Noise noise = noise_ ? noise_at(p_world, p_voxel, slot, brick, density) : Noise{};
  if (look.erosion > 0) density = shared::erode(look, density, noise.tile, noise.detail, look.detail);
  static const smoke::MaskAtlas kNoMasks;
  for (const std::uint32_t i : holes_of_[slot]) {
    if (!(density > 0)) return 0;
    const shared::Hole& hole = input_.holes[i];
    const float rim =
        shared::rim_noise(noise.tile, noise.detail, look.detail) * shared::hole_rim(hole, look.hole_rim);
    density *= 1 - smoke::hole_strength_masked(hole, p_world, input_.time, rim, masks_ ? *masks_ : kNoMasks);
  }
  return density;
}

}  // namespace brume::reference
