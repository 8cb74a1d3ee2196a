#include "textures/smoky_brick.hpp"

namespace brume::textures {
namespace {

/// Whether there is smoke on any side of a cell's planes.
bool holds_smoke(const smoke::SmokeVolume& volume, const shared::BoundaryCell& cell) {
  const std::uint32_t planes = cell.plane2 != 0 ? 3 : cell.plane1 != 0 ? 2 : cell.plane0 != 0 ? 1 : 0;
  for (const glm::uvec2 corners : volume.corner_sets().subspan(cell.first_set, std::size_t{1} << planes))
    if (corners != glm::uvec2(0)) return true;
  return false;
}

}  // namespace

smoke::TexelSet find_smoke(const smoke::SmokeVolume& volume, std::uint32_t slot) {
  constexpr std::size_t kAcross = shared::kBrickCells;
  smoke::TexelSet texels = smoke::smoky_texels(volume.texels(slot));
  const std::span<const std::uint32_t> cells = volume.cells(slot);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] == 0 || !holds_smoke(volume, volume.boundary_cells()[cells[i] - 1])) continue;
    const glm::ivec3 low(i % kAcross, i / kAcross % kAcross, i / (kAcross * kAcross));
    for (int corner = 0; corner < 8; ++corner)
      texels.set(smoke::texel_index(low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2)));
  }
  return texels;
}

}  // namespace brume::textures
