// The tile of noise that erodes smoke, generated on the device at start.
#pragma once

#include "gpu/recorder.hpp"
#include "shared/noise.h"

namespace brume::passes {

/// Fills a tile (RGBA8, params.size^3 texels) that tiles without a seam along every axis: Perlin-Worley
/// billows, small Worley billows, threads and broad gradient noise (shaders/noise.comp). Equal for
/// equal parameters on every device, up to the rounding of 8 bits. size in [1, 2048], coarse_cells in [1,
/// 256].
class NoisePass {
 public:
  explicit NoisePass(gpu::Context& context);
  void record(gpu::Recorder& recorder, const gpu::Image& tile, const shared::NoiseParams& params) const;

 private:
  gpu::ComputePipeline pipeline_;
};

/// An image that the pass can fill.
gpu::Image make_noise_tile(gpu::Context& context, std::uint32_t size);

}  // namespace brume::passes
