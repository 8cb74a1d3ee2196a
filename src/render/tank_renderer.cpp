#include "render/tank_renderer.hpp"

#include <algorithm>

#include "core/same_bytes.hpp"
#include "passes/blue_noise.hpp"

namespace brume::render {
namespace {

gpu::Image picture_image(gpu::Context& context, glm::uvec2 size_px, VkFormat format) {
  gpu::ImageInfo info;
  info.format = format;
  info.size = {size_px, 1};
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return gpu::Image(context, info);
}

gpu::Buffer constants_buffer(gpu::Context& context, std::size_t bytes, VkBufferUsageFlags usage) {
  return gpu::Buffer(context, bytes, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

}  // namespace

TankRenderer::TankRenderer(gpu::Context& context, gpu::CommandStream& stream, const spheres::Tank& tank,
                           glm::uvec2 size_px, bool with_ids)
    : context_(context),
      stream_(stream),
      volume_([&] {
        const spheres::BrickLists lists = spheres::list_bricks(tank);
        return passes::TankVolume(context, stream, tank, lists);
      }()),
      spheres_pass_(context),
      sphere_voxels_pass_(context),
      display_pass_(context),
      sum_(picture_image(context, size_px, VK_FORMAT_R32G32B32A32_SFLOAT)),
      radiance_(picture_image(context, size_px, VK_FORMAT_R16G16B16A16_SFLOAT)),
      shown_(picture_image(context, size_px, VK_FORMAT_R8G8B8A8_UNORM)),
      constants_(
          constants_buffer(context, sizeof(shared::TankConstants), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)),
      frame_(constants_buffer(context, sizeof(shared::FrameConstants), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT)) {
  gpu::grow(context, lights_, scene::kMostTankLights * sizeof(shared::TankLight));
  set_photons({});
  stream.run([&](gpu::Recorder& recorder) { blue_noise_ = passes::make_blue_noise(context, recorder); });
  if (with_ids) {
    volume_.add_ids(context);
    find_voxels();
  }
}

void TankRenderer::set_kind(scene::TankView kind) {
  samples_ = rows_ = 0;
  kind_ = kind;
  if (kind != scene::TankView::voxels || voxels_) return;
  volume_.add_colors(context_);
  voxels_.emplace(context_, volume_.size);
  find_voxels();
}

void TankRenderer::find_voxels() {
  stream_.run([&](gpu::Recorder& recorder) {
    const gpu::Scope scope(recorder, "sphere_voxels");
    sphere_voxels_pass_.record(recorder, volume_);
  });
}

void TankRenderer::set_lighting(scene::TankLighting lighting) {
  samples_ = rows_ = 0;
  lighting_ = lighting;
  if (voxels_) voxels_->is_lit = false;
}

void TankRenderer::set_view(const planning::TankPlan& plan, const planning::TankDisplay& display) {
  BRUME_ASSERT(plan.lights.size() <= scene::kMostTankLights, "too many lights");
  const bool same_light = plan.constants.air.ambient == plan_.constants.air.ambient &&
                          std::ranges::equal(plan.lights, plan_.lights, same_bytes<shared::TankLight>);
  if (voxels_ && !same_light) voxels_->is_lit = false;
  plan_ = plan;
  display_ = display;
  samples_ = rows_ = 0;
  if (kind_ == scene::TankView::voxels && !voxels_->is_lit)
    voxels_->light_pass.reserve(volume_, plan_.lights, lighting_);
}

void TankRenderer::set_photons(const spheres::LightPaths& paths) {
  samples_ = rows_ = 0;
  replace_photons(paths);
}

void TankRenderer::replace_photons(const spheres::LightPaths& paths) {
  photon_grid_ = paths.photons.empty() ? shared::PhotonGrid{0, 0} : paths.grid;
  passes::upload_list(context_, stream_, photons_, paths.photons);
  passes::upload_list(context_, stream_, photon_cells_, paths.cells);
}

void TankRenderer::record_upload(gpu::Recorder& recorder) {
  shared::TankConstants constants = plan_.constants;
  constants.photons = photon_grid_;
  recorder.upload(constants_, 0, std::as_bytes(std::span(&constants, 1)));
  if (!plan_.lights.empty())
    recorder.upload(lights_, 0, std::as_bytes(std::span<const shared::TankLight>(plan_.lights)));
}

void TankRenderer::record_light(gpu::Recorder& recorder) {
  if (voxels_->is_lit) return;
  voxels_->light_pass.record(recorder, volume_, voxels_->light, plan_.constants.air.ambient);
  voxels_->is_lit = true;
}

void TankRenderer::resize(glm::uvec2 size_px) {
  samples_ = rows_ = 0;
  sum_ = picture_image(context_, size_px, VK_FORMAT_R32G32B32A32_SFLOAT);
  radiance_ = picture_image(context_, size_px, VK_FORMAT_R16G16B16A16_SFLOAT);
  shown_ = picture_image(context_, size_px, VK_FORMAT_R8G8B8A8_UNORM);
}

void TankRenderer::record_dispatch(gpu::Recorder& recorder, std::uint32_t count, std::uint32_t rows) {
  record_upload(recorder);
  if (kind_ == scene::TankView::voxels) record_light(recorder);
  const passes::TankInputs inputs{volume_, constants_, lights_, photons_, photon_cells_, blue_noise_};
  const passes::TankTargets targets{sum_, radiance_};
  const shared::TankSamples samples{samples_, count, rows_};
  const gpu::Scope scope(recorder, "tank");
  if (kind_ == scene::TankView::voxels)
    voxels_->pass.record(recorder, inputs, voxels_->light, targets, samples, rows);
  else
    spheres_pass_.record(recorder, inputs, targets, samples, rows);
}

void TankRenderer::record_samples(gpu::Recorder& recorder, std::uint32_t count) {
  BRUME_ASSERT(rows_ == 0, "a sample is incomplete");
  record_dispatch(recorder, count, shown_.info().size.y);
  samples_ += count;
  record_display(recorder);
}

void TankRenderer::record_rows(gpu::Recorder& recorder, std::uint32_t rows) {
  const std::uint32_t height = shown_.info().size.y;
  BRUME_ASSERT(rows > 0 && rows_ + rows <= height && (rows % kRows == 0 || rows_ + rows == height),
               "rows that are no multiple of a workgroup's");
  record_dispatch(recorder, 1, rows);
  rows_ += rows;
  if (rows_ < height) return;
  rows_ = 0;
  ++samples_;
  record_display(recorder);
}

void TankRenderer::record_display(gpu::Recorder& recorder) {
  recorder.upload(frame_, 0, std::as_bytes(std::span(&display_.frame, 1)));
  const gpu::Scope scope(recorder, "display");
  display_pass_.record(recorder, frame_, blue_noise_, radiance_, shown_, display_.dither);
}

}  // namespace brume::render
