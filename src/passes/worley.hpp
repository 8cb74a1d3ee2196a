// Tileable Worley noise, made on the device at start.
#pragma once

#include "gpu/recorder.hpp"
#include "shared/worley.h"

namespace brume::passes {

/// Fills a tile (RG8, params.size^3 texels) that repeats without a seam in every axis. The same for the same
/// parameters on every device, up to the rounding of 8 bits. size, coarse_cells >= 1; octaves in [1, 4].
class WorleyPass {
 public:
  explicit WorleyPass(gpu::Context& context);
  void record(gpu::Recorder& recorder, const gpu::Image& tile, const shared::WorleyParams& params) const;

 private:
  gpu::ComputePipeline pipeline_;
};

/// An image that the pass can fill.
gpu::Image make_worley_tile(gpu::Context& context, std::uint32_t size);

/// What the smoke is eroded with.
constexpr shared::WorleyParams kSmokeNoise{64, 4, 2, 7};

}  // namespace brume::passes
