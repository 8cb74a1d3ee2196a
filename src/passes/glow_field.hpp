// Light of what glows in volumes, in the volumes themselves (shaders/shared/glow_field.h).
#pragma once

#include <map>

#include "passes/volume_upload.hpp"
#include "shared/glow_field.h"

namespace brume::passes {

class GlowFieldPass {
 public:
  struct Inputs {
    std::uint32_t casters = 0;  ///< MediaPlan::casters.
    const VolumeResources& volumes;
    std::span<const planning::PlacedVolume> in_view;
  };

  explicit GlowFieldPass(gpu::Context& context);
  /// How many volumes there is room for; where `reserve` sees more, the light of earlier frames is lost.
  std::uint32_t room() const;
  /// Makes room for these volumes. Outside of a recording, once the device has finished previous ones. Throws
  /// resource_limit.
  void reserve(std::span<const planning::PlacedVolume> in_view, std::uint32_t casters);
  /// Finds the light of all that glow.
  void record(gpu::Recorder& recorder, const Inputs& in) const;
  /// Two cubes along x, per volume in view along z; of volumes that do not glow undefined.
  const gpu::Image& field() const { return field_; }

 private:
  void record_volume(gpu::Recorder& recorder, const Inputs& in, std::uint32_t volume) const;
  void record_cells(gpu::Recorder& recorder, const Inputs& in, const shared::GlowFieldParams& params) const;
  void record_diffusion(gpu::Recorder& recorder, const Inputs& in, std::uint32_t volume) const;
  void record_coarsening(gpu::Recorder& recorder, const shared::GlowFieldParams& params) const;
  void record_refinement(gpu::Recorder& recorder, const shared::GlowFieldParams& params) const;
  void record_level(gpu::Recorder& recorder, const Inputs& in, std::uint32_t volume,
                    std::uint32_t level) const;

  gpu::Context& context_;
  gpu::Sampler linear_;
  std::map<std::uint32_t, gpu::ComputePipeline> cells_pipelines_;  ///< By media.
  gpu::ComputePipeline sweep_pipeline_, gather_pipeline_, coarsen_pipeline_, refine_pipeline_,
      diffuse_pipeline_, store_pipeline_;
  gpu::Image matter_, albedo_, swept_, field_;
  gpu::Buffer cells_, state_;
};

}  // namespace brume::passes
