// Takes over the surfaces that a host drew, and draws the media over the host's picture and their shadows.
#pragma once

#include <map>
#include <optional>

#include "gpu/recorder.hpp"
#include "passes/gbuffer.hpp"
#include "passes/smoke_shadow.hpp"
#include "shared/surface_import.h"

namespace brume::passes {

/// How a host's depth follows from the distance along the view axis.
struct HostDepthRange {
  float near_plane = 0.1f;   ///< [m], > 0.
  float far_plane = 1000;    ///< [m], above near_plane; may be infinite.
  bool reversed = false;     ///< 1 at near_plane, 0 at far_plane, instead of the other way around.
  bool parallel = false;     ///< Linear between both planes, which are finite.
  bool has_samples = false;  ///< The image has several samples per pixel; the farthest one counts.
};

/// The part of a host's images that a frame covers.
struct HostPart {
  glm::uvec2 origin_px{0}, size_px{1};
};

class SurfaceImport {
 public:
  explicit SurfaceImport(gpu::Context& context);

  /// Makes the pipeline for depths with samples, outside of a recording.
  void reserve_samples();
  /// Writes the depth of GBuffer::imported, near_z / distance, from a part of a host's depth into the top
  /// left corner; `near_z`: of the frame's camera. There is no surface where the host's depth is far_plane's.
  void record(gpu::Recorder& recorder, const gpu::Image& host_depth, const HostPart& part,
              const HostDepthRange& range, float near_z, const GBuffer& target) const;
  /// Copies the depth of a GBuffer into an image of floats of the same size, to which shaders can write.
  void record_copy(gpu::Recorder& recorder, const gpu::Image& depth, const gpu::Image& copy) const;

 private:
  void record(gpu::Recorder& recorder, const gpu::ComputePipeline& pipeline, const gpu::Image& from,
              const shared::SurfaceImportParams& params, const gpu::Image& to) const;

  gpu::Context& context_;
  gpu::ComputePipeline pipeline_;
  std::optional<gpu::ComputePipeline> samples_pipeline_;
  gpu::Sampler nearest_;
};

/// The normals of a host's surfaces.
struct HostNormals {
  const gpu::Image* image = nullptr;                ///< As the host's depth; null: from the depth.
  std::uint32_t encoding = shared::kNormalsSigned;  ///< One of shared::kNormals....
  bool of_view = false;                             ///< Along right, up and against forward.
  bool alpha_receives = false;                      ///< Surfaces where its alpha is 0 have no decals.
};

class SurfaceNormalPass {
 public:
  explicit SurfaceNormalPass(gpu::Context& context);

  /// Writes the normals of GBuffer::imported, after SurfaceImport::record. Where the host's normal is 0 or
  /// not finite it is the normal of the plane through the depths around, facing the camera.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const HostNormals& normals,
              const HostPart& part, const GBuffer& target) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_;
};

/// The media's shadows on the surfaces of a host.
class SurfaceShadowPass {
 public:
  explicit SurfaceShadowPass(gpu::Context& context);

  struct Inputs {
    const gpu::Buffer& frame;   ///< FrameConstants.
    const gpu::Buffer& lights;  ///< SceneResources::lights.
    const gpu::Buffer& sun;     ///< ShadowMaps::sun.
    const SmokeShadows& shadows;
    const gpu::Image& depth;  ///< Depth of GBuffer::imported.
  };
  /// Writes which fraction of each light arrives through the media at the surface of each pixel, 1 without a
  /// surface or a light. `lights`: numbers in the frame's lights, kNoLight: none. `target`: half floats, at
  /// least as large as the frame.
  void record(gpu::Recorder& recorder, const Inputs& inputs, glm::uvec4 lights, glm::uvec2 size_px,
              const gpu::Image& target) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_, linear_;
};

class MediaLayerPass {
 public:
  explicit MediaLayerPass(gpu::Context& context);

  /// Makes the pipeline for pictures of a format that can be blended, outside of a recording.
  void reserve(VkFormat format);
  /// What lies over the picture, in the top left corner of its images.
  struct Layer {
    const gpu::Image& media;
    const gpu::Image* occlusion;  ///< DecalPass::occlusion; null: 0.
    float exposure;
  };
  /// Replaces a part p of a picture of a reserved format, in the layout for attachments, by exposure *
  /// radiance + transmittance * (1 - occlusion) * p, its alpha by transmittance * (1 - occlusion) * alpha.
  void record(gpu::Recorder& recorder, const Layer& layer, const gpu::Image& picture,
              const HostPart& part) const;

 private:
  gpu::Context& context_;
  std::map<VkFormat, gpu::GraphicsPipeline> pipelines_;
  gpu::Sampler nearest_;
};

}  // namespace brume::passes
