#include "passes/generate_cloud.hpp"

#include <algorithm>
#include <cstring>

#include "brume_shaders.hpp"
#include "gpu/read_back.hpp"

namespace brume::passes {
namespace {

constexpr std::uint32_t kVoxels = 512;  // in a brick

}  // namespace

GenerateCloudPass::GenerateCloudPass(gpu::Context& context)
    : pipeline_(context, shaders::generate_cloud_comp) {}

void GenerateCloudPass::record(gpu::Recorder& recorder, const gpu::Buffer& bricks, const gpu::Buffer& values,
                               const shared::CloudParams& params) const {
  recorder.bind(
      pipeline_,
      {{shared::kBindCloudBricks, gpu::read(bricks)}, {shared::kBindCloudValues, gpu::write(values)}},
      params);
  recorder.dispatch_threads(pipeline_, params.brick_count * kVoxels);
}

CloudGenerator::CloudGenerator(gpu::Context& context)
    : pass_(context),
      copy_(gpu::readback_buffer(context, GenerateCloudPass::kMaxBricks * kVoxels * sizeof(float))) {
  gpu::grow(context, bricks_, GenerateCloudPass::kMaxBricks * sizeof(glm::ivec3));
  gpu::grow(context, values_, copy_.size());
}

void CloudGenerator::evaluate(gpu::CommandStream& stream, shared::CloudParams params,
                              std::span<const glm::ivec3> first_voxels, std::span<float> values) {
  for (std::size_t done = 0; done < first_voxels.size(); done += params.brick_count) {
    const auto bricks = first_voxels.subspan(
        done, std::min<std::size_t>(first_voxels.size() - done, GenerateCloudPass::kMaxBricks));
    params.brick_count = static_cast<std::uint32_t>(bricks.size());
    const std::size_t bytes = bricks.size() * kVoxels * sizeof(float);
    stream.run([&](gpu::Recorder& recorder) {
      recorder.upload(bricks_, 0, std::as_bytes(bricks));
      pass_.record(recorder, bricks_, values_, params);
      recorder.read_back(values_, copy_, bytes);
    });
    std::memcpy(values.data() + done * kVoxels, copy_.mapped(), bytes);
  }
}

}  // namespace brume::passes
