#include "passes/fine_light.hpp"

#include <algorithm>
#include <bit>

#include "brume_shaders.hpp"
#include "core/error.hpp"
#include "shared/light_side.h"
#include "shared/noise.h"

namespace brume::passes {
namespace {

/// Rows of kFinePagesAcross pages.
gpu::Image make_pages(gpu::Context& context, std::uint32_t rows) {
  constexpr std::uint32_t kEdge{shared::kFinePageTexels};
  const glm::uvec3 size =
      rows == 0 ? glm::uvec3(1) : glm::uvec3(shared::kFinePagesAcross * kEdge, rows * kEdge, kEdge);
  return gpu::Image(context, gpu::storage_image_3d(size, VK_FORMAT_R16G16B16A16_SFLOAT));
}

}  // namespace

FineLightPass::FineLightPass(gpu::Context& context)
    : context_(context),
      pipeline_(context, shaders::fine_light_comp),
      repeat_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT}) {
  trim();
}

void FineLightPass::trim() {
  light_ = make_pages(context_, 0);
  gpu::shrink(context_, {&pages_, &slots_});
}

void FineLightPass::reserve(const planning::FineLightPlan& plan) {
  page_count_ = static_cast<std::uint32_t>(plan.slots.size());
  const std::uint32_t rows = (page_count_ + shared::kFinePagesAcross - 1) / shared::kFinePagesAcross;
  const std::uint32_t held = light_.info().size.y / std::uint32_t{shared::kFinePageTexels};
  if (rows > held) {
    // As it grows with the smoke, in powers of two.
    constexpr std::uint32_t kMostRows = planning::kMostFinePages / shared::kFinePagesAcross;
    try {
      light_ = make_pages(context_, std::min(std::bit_ceil(rows), kMostRows));
    } catch (const Error& error) {
      // Better smoke as it is without fine light than coarser smoke.
      if (error.code() != ErrorCode::resource_limit) throw;
      page_count_ = held * shared::kFinePagesAcross;
    }
  }
  gpu::grow(context_, pages_, plan.pages.size() * sizeof(std::uint32_t));
  gpu::grow(context_, slots_, plan.slots.size() * sizeof(std::uint32_t));
}

void FineLightPass::upload(gpu::Recorder& recorder, const planning::FineLightPlan& plan) const {
  if (plan.pages.empty()) return;
  if (page_count_ < plan.slots.size()) {
    planning::FineLightPlan first = plan;
    planning::keep_pages(first, page_count_);
    recorder.upload(pages_, 0, std::as_bytes(std::span(first.pages)));
  } else {
    recorder.upload(pages_, 0, std::as_bytes(std::span(plan.pages)));
  }
  recorder.upload(slots_, 0, std::as_bytes(std::span(plan.slots).first(page_count_)));
}

void FineLightPass::record(gpu::Recorder& recorder, const planning::FineLightPlan& plan,
                           const Inputs& in) const {
  if (plan.slots.empty() || page_count_ == 0) return;
  recorder.bind(pipeline_, {in.smoke.bindings()},
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindNoiseTile, gpu::sampled(in.noise, repeat_)},
                    {shared::kBindFineSlots, gpu::read(slots_)},
                    {shared::kBindFineLight, gpu::stored(light_)},
                });
  constexpr std::uint32_t kEdge{shared::kFinePageTexels};
  constexpr std::uint32_t kGroups = (kEdge + 3) / 4;
  recorder.dispatch_threads(pipeline_, 4 * kGroups * kGroups, 4 * kGroups, 4 * page_count_);
}

}  // namespace brume::passes
