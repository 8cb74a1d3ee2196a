// A tile of blue noise, for jitter and dither.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/recorder.hpp"

namespace brume::passes {

constexpr std::uint32_t kBlueNoiseSize = 64;

/// One channel of kBlueNoiseSize^2 values, rows in order: each of 0..255 equally often, tiling without a
/// seam. Void and cluster (Ulichney 1993). Deterministic for a seed on every machine.
std::vector<std::uint8_t> blue_noise_channel(std::uint32_t seed);

/// Four independent channels as an RGBA8 image, ready to sample.
gpu::Image make_blue_noise(gpu::Context& context, gpu::Recorder& recorder);

}  // namespace brume::passes
