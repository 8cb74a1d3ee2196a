#include "smoke/noise_look.hpp"

#include "smoke/noise_tile.hpp"

namespace brume::smoke {

void set_noise(shared::SmokeLook& look, const NoiseLook& noise) {
  look.erosion = noise.erosion;
  look.noise_frequency = 1 / (static_cast<float>(kSmokeNoise.coarse_cells) * noise.noise_size);
  look.detail = noise.detail;
  look.hole_rim = noise.hole_rim;
  look.swirl = noise.swirl;
  look.swirl_width = 2 * noise.noise_size;
  look.rise = noise.rise;
}

}  // namespace brume::smoke
