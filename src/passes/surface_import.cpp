#include "passes/surface_import.hpp"

#include <cmath>

#include "brume_shaders.hpp"
#include "shared/frame.h"
#include "shared/gbuffer.h"
#include "shared/smoke_shadow.h"

namespace brume::passes {
namespace {

/// The parameters of a parallel view, with d = (distance - n) / (f - n) or 1 minus this quotient.
shared::SurfaceImportParams params_of_parallel(const HostDepthRange& range, float near_z,
                                               const HostPart& part) {
  const double n = range.near_plane, f = range.far_plane, span = range.reversed ? n - f : f - n;
  return {part.size_px,
          part.origin_px,
          static_cast<float>(-(range.reversed ? f : n) / span),
          static_cast<float>(span / double{near_z}),
          range.reversed ? 0.0f : 1.0f,
          1};
}

shared::SurfaceImportParams params_of(const HostDepthRange& range, float near_z, const HostPart& part) {
  if (range.parallel) return params_of_parallel(range, near_z, part);
  // d = f / (f - n) - f n / (f - n) / distance, 1 minus that where it is reversed.
  const double n = range.near_plane, f = range.far_plane;
  const double offset = std::isinf(f) ? 1 : f / (f - n), scale = std::isinf(f) ? n : f * n / (f - n);
  const double sign = range.reversed ? 1 : -1;
  return {part.size_px,
          part.origin_px,
          static_cast<float>(range.reversed ? 1 - offset : offset),
          static_cast<float>(near_z / (sign * scale)),
          range.reversed ? 0.0f : 1.0f,
          0};
}

}  // namespace

SurfaceImport::SurfaceImport(gpu::Context& context)
    : context_(context),
      pipeline_(context, shaders::surface_import_comp),
      nearest_(context, {VK_FILTER_NEAREST}) {}

void SurfaceImport::reserve_samples() {
  if (!samples_pipeline_) samples_pipeline_.emplace(context_, shaders::surface_import_samples_comp);
}

void SurfaceImport::record(gpu::Recorder& recorder, const gpu::Image& host_depth, const HostPart& part,
                           const HostDepthRange& range, float near_z, const GBuffer& target) const {
  const gpu::ComputePipeline& pipeline = range.has_samples ? *samples_pipeline_ : pipeline_;
  record(recorder, pipeline, host_depth, params_of(range, near_z, part), target.depth);
}

void SurfaceImport::record_copy(gpu::Recorder& recorder, const gpu::Image& depth,
                                const gpu::Image& copy) const {
  record(recorder, pipeline_, depth, {glm::uvec2(copy.info().size), {0, 0}, 0, 1, 0, 0}, copy);
}

void SurfaceImport::record(gpu::Recorder& recorder, const gpu::ComputePipeline& pipeline,
                           const gpu::Image& from, const shared::SurfaceImportParams& params,
                           const gpu::Image& to) const {
  recorder.bind(pipeline,
                {
                    {shared::kBindHostDepth, gpu::sampled(from, nearest_)},
                    {shared::kBindImportedDepth, gpu::stored(to)},
                },
                params);
  recorder.dispatch_threads(pipeline, params.size_px.x, params.size_px.y);
}

SurfaceNormalPass::SurfaceNormalPass(gpu::Context& context)
    : pipeline_(context, shaders::surface_normals_comp), nearest_(context, {VK_FILTER_NEAREST}) {}

void SurfaceNormalPass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const HostNormals& normals,
                               const HostPart& part, const GBuffer& target) const {
  const gpu::Image& given = normals.image ? *normals.image : target.depth;  // not read
  recorder.bind(
      pipeline_,
      {
          {shared::kBindFrame, gpu::uniform(frame)},
          {shared::kBindDepth, gpu::sampled(target.depth, nearest_)},
          {shared::kBindHostNormals, gpu::sampled(given, nearest_)},
          {shared::kBindImportedNormals, gpu::stored(target.normal_metallic)},
      },
      shared::SurfaceNormalParams{part.origin_px, normals.image ? normals.encoding : shared::kNormalsOfDepth,
                                  normals.of_view ? 1u : 0u, normals.alpha_receives ? 1u : 0u});
  recorder.dispatch_threads(pipeline_, part.size_px.x, part.size_px.y);
}

SurfaceShadowPass::SurfaceShadowPass(gpu::Context& context)
    : pipeline_(context, shaders::surface_shadows_comp),
      nearest_(context, {VK_FILTER_NEAREST}),
      linear_(context, {}) {}

void SurfaceShadowPass::record(gpu::Recorder& recorder, const Inputs& in, glm::uvec4 lights,
                               glm::uvec2 size_px, const gpu::Image& target) const {
  recorder.bind(pipeline_,
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindLights, gpu::read(in.lights)},
                    {shared::kBindSun, gpu::uniform(in.sun)},
                    {shared::kBindDepth, gpu::sampled(in.depth, nearest_)},
                    {shared::kBindSmokeShadows, gpu::sampled(in.shadows.atlas, linear_)},
                    {shared::kBindSmokeShadowFaces, gpu::read(in.shadows.faces)},
                    {shared::kBindSurfaceShadows, gpu::stored(target)},
                },
                shared::SurfaceShadowParams{lights});
  recorder.dispatch_threads(pipeline_, size_px.x, size_px.y);
}

MediaLayerPass::MediaLayerPass(gpu::Context& context)
    : context_(context), nearest_(context, {VK_FILTER_NEAREST}) {}

void MediaLayerPass::reserve(VkFormat format) {
  gpu::GraphicsInfo info{
      &shaders::media_layer_vert, &shaders::media_layer_frag, {format}, VK_FORMAT_UNDEFINED};
  info.blend = gpu::Blend::medium;
  pipelines_.try_emplace(format, context_, info);
}

void MediaLayerPass::record(gpu::Recorder& recorder, const Layer& layer, const gpu::Image& picture,
                            const HostPart& part) const {
  const gpu::GraphicsPipeline& pipeline = pipelines_.at(picture.info().format);
  const gpu::Image& occlusion = layer.occlusion ? *layer.occlusion : layer.media;  // not read
  recorder.prepare_for_draws({gpu::sampled(layer.media, nearest_), gpu::sampled(occlusion, nearest_)});
  gpu::Recorder::Attachments attachments;
  attachments.colours = {&picture};
  attachments.keep = 1;
  recorder.begin_rendering(attachments, part.size_px, part.origin_px);
  recorder.bind_for_draws(pipeline, {{shared::kBindMediaLayer, gpu::sampled(layer.media, nearest_)},
                                     {shared::kBindLayerOcclusion, gpu::sampled(occlusion, nearest_)}});
  const shared::MediaLayerParams params{part.origin_px, layer.exposure, layer.occlusion ? 1u : 0u};
  recorder.push(pipeline, std::as_bytes(std::span(&params, 1)));
  recorder.draw(3);
  recorder.end_rendering();
}

}  // namespace brume::passes
