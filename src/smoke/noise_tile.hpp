// The tile of noise that erodes smoke, as shaders/noise.comp renders it, on the CPU.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/type_precision.hpp>
#include <vector>

#include "shared/noise.h"

namespace brume::smoke {

/// Parameters of the smoke's noise: the smallest billows are five texels wide.
constexpr shared::NoiseParams kSmokeNoise{64, 4, 7};

struct NoiseTile {
  std::uint32_t size = 0;           ///< Texels per axis.
  std::vector<glm::u8vec4> texels;  ///< x + size (y + size z)
};

/// shared::smoke_noise_texel at every texel, rounded to 8 bits, over all threads.
NoiseTile make_noise_tile(const shared::NoiseParams& params);

/// The tile of its detail (shared/erosion.h), shared::kDetailTexels texels per
/// axis, in the first two channels.
NoiseTile make_detail_tile(const NoiseTile& noise);

/// What smoke is eroded by.
struct SmokeNoise {
  NoiseTile tile, detail;
};

/// The noise of kSmokeNoise: the first call makes and keeps it. The tile alone takes half the time.
const NoiseTile& smoke_noise_tile();
const SmokeNoise& smoke_noise();

/// The tile's channels in [0, 1] at a point, linear between the centres of texels and repeating, as a sampler
/// returns them. The tile's size must be a power of two, |p_tile| size below 2^31.
glm::vec4 noise_at(const NoiseTile& tile, glm::vec3 p_tile);

}  // namespace brume::smoke
