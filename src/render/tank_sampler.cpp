#include "render/tank_sampler.hpp"

#include <algorithm>

#include "core/same_bytes.hpp"

namespace brume::render {
namespace {

gpu::Image picture_image(gpu::Context& context, glm::uvec2 size_px, VkFormat format) {
  return gpu::Image(context, gpu::storage_image(size_px, format));
}

}  // namespace

TankSampler::TankSampler(gpu::Context& context, gpu::CommandStream& stream, const spheres::Tank& tank,
                         const spheres::BrickLists& lists, bool with_ids)
    : context_(context),
      stream_(stream),
      volume_(context, stream, tank, lists),
      spheres_pass_(context),
      constants_(context, sizeof(shared::TankConstants),
                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  gpu::grow(context, lights_, scene::kMostTankLights * sizeof(shared::TankLight));
  set_photons({});
  if (with_ids) {
    volume_.add_ids(context);
    find_voxels();
  }
}

void TankSampler::resize(glm::uvec2 size_px) {
  restart();
  sum_ = picture_image(context_, size_px, VK_FORMAT_R32G32B32A32_SFLOAT);
  radiance_ = picture_image(context_, size_px, VK_FORMAT_R16G16B16A16_SFLOAT);
}

void TankSampler::find_voxels() {
  if (!sphere_voxels_pass_) sphere_voxels_pass_.emplace(context_);
  stream_.run([&](gpu::Recorder& recorder) {
    const gpu::Scope scope(recorder, "sphere_voxels");
    sphere_voxels_pass_->record(recorder, volume_);
  });
}

void TankSampler::set_view(const planning::TankPlan& plan, std::uint32_t index) {
  BRUME_ASSERT(plan.lights.size() <= scene::kMostTankLights, "too many lights");
  restart();  // before anything that may throw
  if (plan.view == scene::TankView::voxels && !voxels_) {
    volume_.add_colors(context_);
    find_voxels();
    voxels_.emplace(context_, volume_.size);
  }
  const bool same_light = plan.lighting == plan_.lighting &&
                          plan.constants.air.ambient == plan_.constants.air.ambient &&
                          std::ranges::equal(plan.lights, plan_.lights, same_bytes<shared::TankLight>);
  if (voxels_ && !same_light) voxels_->is_lit.change(context_) = false;
  plan_ = plan;
  index_ = index;
  if (plan_.view == scene::TankView::voxels && !voxels_->is_lit.get(context_))
    voxels_->light_pass.reserve(volume_, plan_.lights, plan_.lighting);
}

void TankSampler::reserve(bool over_surfaces) {
  if (plan_.view == scene::TankView::voxels)
    voxels_->pass.reserve(over_surfaces);
  else
    spheres_pass_.reserve(volume_, over_surfaces);
}

void TankSampler::set_photons(const spheres::LightPaths& paths) {
  restart();
  replace_photons(paths);
}

void TankSampler::replace_photons(const spheres::LightPaths& paths) {
  photon_grid_ = paths.photons.empty() ? shared::PhotonGrid{0, 0} : paths.grid;
  passes::upload_list(context_, stream_, photons_, paths.photons);
  passes::upload_list(context_, stream_, photon_cells_, paths.cells);
}

void TankSampler::record_upload(gpu::Recorder& recorder) {
  shared::TankConstants constants = plan_.constants;
  constants.photons = photon_grid_;
  recorder.upload(constants_, 0, std::as_bytes(std::span(&constants, 1)));
  if (!plan_.lights.empty())
    recorder.upload(lights_, 0, std::as_bytes(std::span<const shared::TankLight>(plan_.lights)));
}

void TankSampler::record_light(gpu::Recorder& recorder) {
  bool& is_lit = recorder.change(voxels_->is_lit);
  if (is_lit) return;
  voxels_->light_pass.record(recorder, volume_, voxels_->light, plan_.constants.air.ambient);
  is_lit = true;
}

void TankSampler::record_dispatch(gpu::Recorder& recorder, const gpu::Image& blue_noise, std::uint32_t count,
                                  std::uint32_t rows, const gpu::Image* surfaces) {
  record_upload(recorder);
  if (plan_.view == scene::TankView::voxels) record_light(recorder);
  const passes::TankInputs inputs{volume_, constants_, lights_, photons_, photon_cells_, blue_noise};
  const passes::TankTargets targets{sum_, radiance_, surfaces};
  const Done& done = done_.get(context_);
  const shared::TankSamples samples{done.samples, count, done.rows, index_};
  const gpu::Scope scope(recorder, "tank");
  if (plan_.view == scene::TankView::voxels)
    voxels_->pass.record(recorder, inputs, voxels_->light, targets, samples, rows);
  else
    spheres_pass_.record(recorder, inputs, targets, samples, rows);
}

void TankSampler::record_samples(gpu::Recorder& recorder, const gpu::Image& blue_noise, std::uint32_t count,
                                 const gpu::Image* surfaces) {
  BRUME_ASSERT(rows() == 0, "a sample is incomplete");
  record_dispatch(recorder, blue_noise, count, sum_.info().size.y, surfaces);
  recorder.change(done_).samples += count;
}

void TankSampler::record_rows(gpu::Recorder& recorder, const gpu::Image& blue_noise, std::uint32_t rows) {
  const std::uint32_t height = sum_.info().size.y;
  const std::uint32_t end = this->rows() + rows;
  BRUME_ASSERT(rows > 0 && end <= height && (rows % kRows == 0 || end == height),
               "rows that are no multiple of a workgroup's");
  record_dispatch(recorder, blue_noise, 1, rows, nullptr);
  Done& done = recorder.change(done_);
  done.rows = end < height ? end : 0;
  if (end == height) ++done.samples;
}

}  // namespace brume::render
