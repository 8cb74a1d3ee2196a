// Decals: volumes of baked occlusion that follow their carriers (docs/guides/volume-textures.md).
#pragma once

#include <array>
#include <optional>

#include "passes/gbuffer.hpp"
#include "passes/slice_textures.hpp"
#include "planning/device_camera.hpp"
#include "shared/decal.h"

namespace brume::passes {

class DecalPass {
 public:
  /// For frames up to this size.
  DecalPass(gpu::Context& context, glm::uvec2 size_px);

  /// Uploads the decals of the next record, at most shared::kMaxDecals.
  void upload(gpu::Recorder& recorder, std::span<const shared::Decal> decals);
  /// What fraction of its light each surface loses to the decals of the last upload, in red; exactly
  /// 0 outside of their boxes and on what moves. Where a decal scatters its samples, with `past`, the frame
  /// of the last record, the mean of this frame and those before; else of several samples of this one.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, glm::uvec2 size_px, const GBuffer& gbuffer,
              const gpu::Image& blue_noise, const gpu::Image& slices,
              const std::optional<planning::PastView>& past);
  /// The next frame has no past: one was drawn without decals.
  void invalidate_past(gpu::Recorder& recorder) { recorder.change(stored_).frames = 0; }
  /// Half floats, of the image's size, from the last record.
  const gpu::Image& occlusion() const { return occlusion_[stored_.get(context_).current]; }

 private:
  /// What the last frame left for the next one.
  struct Stored {
    std::size_t current = 0;
    std::uint32_t frames = 0;  ///< In a row, up to the last record.
    bool is_clear = false;     ///< The images hold numbers, also beside frames that are smaller.
  };
  gpu::Context& context_;
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_, linear_;
  gpu::Buffer decals_;
  std::uint32_t decal_count_ = 0;
  /// Occlusion, of how many samples, distance along the view axis [m] (0: no surface), spread of the samples.
  std::array<gpu::Image, 2> occlusion_;
  gpu::Recorded<Stored> stored_;
};

}  // namespace brume::passes
