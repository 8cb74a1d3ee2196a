// Samples of a tank's picture: its spheres by paths of light, or its voxels.
#pragma once

#include <array>
#include <optional>

#include "gpu/recorder.hpp"
#include "passes/sphere_voxels.hpp"
#include "shared/tank.h"

namespace brume::passes {

/// What a sample is taken of.
struct TankInputs {
  const TankVolume& volume;
  const gpu::Buffer& constants;  ///< shared::TankConstants
  const gpu::Buffer& lights;     ///< shared::TankLight each
  const gpu::Buffer& photons;    ///< shared::Photon each
  const gpu::Buffer& photon_cells;
  const gpu::Image& blue_noise;
};

/// Where the samples of a picture are summed, and their mean.
struct TankTargets {
  const gpu::Image& sum;       ///< Floats.
  const gpu::Image& radiance;  ///< Half floats.
  /// Depth of a frame's surfaces, of GBuffer::imported: paths end at them, alpha is what is seen of them, and
  /// the tank becomes one. Null: behind the tank is its air.
  const gpu::Image* surfaces = nullptr;
};

/// Exact spheres by paths of light (docs/how/path-tracer.md).
class TankSpheresPass {
 public:
  explicit TankSpheresPass(gpu::Context& context);
  /// Makes the pipeline for a volume, outside of a recording.
  void reserve(const TankVolume& volume, bool over_surfaces) { pipeline(volume, over_surfaces); }
  /// Adds samples to each pixel of at least `rows` rows; the first of a picture begins it.
  void record(gpu::Recorder& recorder, const TankInputs& inputs, const TankTargets& targets,
              const shared::TankSamples& samples, std::uint32_t rows);

 private:
  const gpu::ComputePipeline& pipeline(const TankVolume& volume, bool over_surfaces);

  gpu::Context& context_;
  gpu::Sampler nearest_;
  /// Made when first needed: over surfaces or not, opaque or not, ids of 32 bits or 16, with ids or without.
  std::array<std::optional<gpu::ComputePipeline>, 16> pipelines_;
};

/// The painted voxels with their light (TankLightPass).
class TankVoxelsPass {
 public:
  explicit TankVoxelsPass(gpu::Context& context);
  void reserve(bool over_surfaces) { pipeline(over_surfaces); }
  /// As TankSpheresPass.
  void record(gpu::Recorder& recorder, const TankInputs& inputs, const gpu::Image& voxel_light,
              const TankTargets& targets, const shared::TankSamples& samples, std::uint32_t rows);

 private:
  const gpu::ComputePipeline& pipeline(bool over_surfaces);

  gpu::Context& context_;
  gpu::Sampler nearest_;
  /// Made when first needed: over surfaces or not.
  std::array<std::optional<gpu::ComputePipeline>, 2> pipelines_;
};

}  // namespace brume::passes
