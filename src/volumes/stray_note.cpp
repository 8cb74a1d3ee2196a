#include "volumes/stray_note.hpp"

#include <cstdio>

#include "grids/brick_volume.hpp"
#include "grids/density_extent.hpp"

namespace brume::volumes {

std::string stray_note(double stray_part, double stray_reach) {
  if (!(stray_part > 0)) return "";
  char text[160];
  std::snprintf(
      text, sizeof text,
      "%.2g %% of its voxels lie far from the rest, up to %.4g units, outside of the first picture: "
      "--camera shows them",
      100 * stray_part, stray_reach);
  return text;
}

Result<std::string> stray_note(const grids::Grid& density) {
  // At a lower resolution a large grid takes little memory, and strays as far.
  constexpr std::uint32_t kMostBricks = 1u << 15;
  const auto volume = grids::make_brick_volume(density, {.max_bricks = kMostBricks});
  if (!volume) return volume.failure();
  const grids::DensityExtent extent = grids::measure_extent(*volume, kSeen);
  return stray_note(extent.stray_part, extent.stray_reach);
}

}  // namespace brume::volumes
