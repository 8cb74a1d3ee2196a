#include "reference/smoke_medium.hpp"

#include <algorithm>

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

SmokeMedium::SmokeMedium(const smoke::SmokeInput& smoke,
                         const std::function<const smoke::SmokeNoise&()>& noise,
                         const smoke::MaskAtlas* masks)
    : Medium(smoke.look.phase), smoke_(smoke, noise, masks) {
  find_majorants();
}

void SmokeMedium::find_majorants() {
  const smoke::SmokeVolume& volume = *smoke_.input().volume;
  Box<int> all{glm::ivec3(1 << 30), glm::ivec3(-(1 << 30))};
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
    if (volume.in_use(slot)) all = united(all, {8 * volume.brick_of(slot), 8 * volume.brick_of(slot) + 8});
  if (all.empty()) return;
  majorants_ = Majorants(world_from_voxel(volume.layout()), all, kPart);
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
    if (!volume.in_use(slot)) continue;
    for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(8 / kPart)}, [&](glm::ivec3 part) {
      std::uint32_t largest = 0;
      for_each_in(Box<int>{kPart * part, kPart * part + kPart + 1},
                  [&](glm::ivec3 cell) { largest = std::max(largest, largest_in_cell(volume, slot, cell)); });
      float bound = static_cast<float>(largest) / 255;
      // Where noise removes nothing, erosion multiplies low densities by four, or more with detail
      // (shared/erosion.h).
      if (look().erosion > 0)
        bound = std::min(4 * (1 + look().detail) * bound, 1.0f) * (1 + 0.5f * look().erosion);
      const glm::ivec3 voxel = 8 * volume.brick_of(slot) + kPart * part - all.low;
      float& stored = majorants_.at(voxel / majorants_.cell_voxels());
      stored = std::max(stored, kBoundSlack * look().extinction * bound);
    });
  }
}

}  // namespace brume::reference
