// Takes over the surfaces that a host drew, and draws the media over the host's picture.
#pragma once

#include <map>

#include "gpu/recorder.hpp"
#include "passes/gbuffer.hpp"

namespace brume::passes {

/// How a host's depth follows from the distance along the view axis.
struct HostDepthRange {
  float near_plane = 0.1f;  ///< [m], > 0.
  float far_plane = 1000;   ///< [m], above near_plane; may be infinite.
  bool reversed = false;    ///< 1 at near_plane, 0 at far_plane, instead of the other way around.
};

class SurfaceImport {
 public:
  explicit SurfaceImport(gpu::Context& context);

  /// Writes the depth of GBuffer::imported, near_z / distance, from that of a host, of the same size;
  /// `near_z`: of the frame's camera. Where the host's depth is that of far_plane there is no surface.
  void record(gpu::Recorder& recorder, const gpu::Image& host_depth, const HostDepthRange& range,
              float near_z, const GBuffer& target) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_;
};

class MediaLayerPass {
 public:
  explicit MediaLayerPass(gpu::Context& context);

  /// Makes the pipeline for pictures of a format that can be blended, outside of a recording.
  void reserve(VkFormat format);
  /// Replaces a picture p of a reserved format, in the layout for attachments, by exposure * radiance +
  /// transmittance * p, its alpha by transmittance * alpha. `media` has the same size.
  void record(gpu::Recorder& recorder, const gpu::Image& media, float exposure,
              const gpu::Image& picture) const;

 private:
  gpu::Context& context_;
  std::map<VkFormat, gpu::GraphicsPipeline> pipelines_;
  gpu::Sampler nearest_;
};

}  // namespace brume::passes
