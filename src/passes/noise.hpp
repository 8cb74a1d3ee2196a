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
  /// Fills a tile of detail from a tile of noise (shared/erosion.h): of make_detail_tile.
  void record_detail(gpu::Recorder& recorder, const gpu::Image& tile, const gpu::Image& detail) const;

 private:
  gpu::ComputePipeline pipeline_, detail_pipeline_;
  gpu::Sampler repeat_;
};

/// An image that the pass can fill.
gpu::Image make_noise_tile(gpu::Context& context, std::uint32_t size);
/// RG8, shared::kDetailTexels^3 texels, and its mip levels.
gpu::Image make_detail_tile(gpu::Context& context);

}  // namespace brume::passes
