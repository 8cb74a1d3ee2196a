// Evaluates clouds by formula on the device (grids/generate.hpp).
#pragma once

#include "gpu/recorder.hpp"
#include "shared/cloud.h"

namespace brume::passes {

class GenerateCloudPass {
 public:
  /// The most bricks of a record: devices run at least 2^16 - 1 workgroups, of which a brick takes eight.
  static constexpr std::uint32_t kMaxBricks = 8191;

  explicit GenerateCloudPass(gpu::Context& context);
  /// `bricks` holds an ivec3 per brick, the index of its first voxel; 512 floats per brick go to `values`, as
  /// grids::evaluate_cloud writes them. params.brick_count in [1, kMaxBricks].
  void record(gpu::Recorder& recorder, const gpu::Buffer& bricks, const gpu::Buffer& values,
              const shared::CloudParams& params) const;

 private:
  gpu::ComputePipeline pipeline_;
};

/// A GenerateCloudPass with its buffers, for any number of bricks.
class CloudGenerator {
 public:
  explicit CloudGenerator(gpu::Context& context);
  /// A grids::CloudEvaluator. The values differ from the CPU's by rounding. Throws DeviceLost.
  void evaluate(gpu::CommandStream& stream, shared::CloudParams params,
                std::span<const glm::ivec3> first_voxels, std::span<float> values);

 private:
  GenerateCloudPass pass_;
  gpu::Buffer bricks_, values_, copy_;
};

}  // namespace brume::passes
