#include "passes/noise_advection.hpp"

#include <algorithm>

#include "brume_shaders.hpp"
#include "planning/noise_plan.hpp"
#include "shared/noise.h"
#include "shared/noise_advection.h"

namespace brume::passes {
namespace {

// Slots a dispatch: well below the 65,535 workgroups that every device takes.
constexpr std::uint32_t kSlotsPerDispatch = 4096;

}  // namespace

NoiseAdvectionPass::NoiseAdvectionPass(gpu::Context& context)
    : context_(context),
      pipeline_(context, shaders::noise_advection_comp),
      repeat_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT}) {
  trim();
  gpu::grow(context, impulses_, smoke::kMaxImpulses * sizeof(shared::Impulse));
}

void NoiseAdvectionPass::trim() {
  growth_ = {};
  gpu::shrink(context_, {&parts_, &displacements_, &motions_, &slots_due_});
  stale_.change(context_) = {};
}

void NoiseAdvectionPass::reserve(const sim::State& state, const smoke::SmokeBricks& volume,
                                 const planning::NoisePlan& plan) {
  const bool is_lost = stale_.is_dropped(context_);  // with the list of what is new
  Stale& stale = stale_.change(context_);
  if (is_lost) stale = {};
  stale.parts |= growth_.update(state, volume);
  stale.parts |= gpu::grow(context_, parts_, growth_.parts().size_bytes());
  stale.displacements |= gpu::grow(context_, displacements_, growth_.displacements().size_bytes());
  gpu::grow(context_, motions_, plan.motion.clouds.size() * sizeof(shared::CloudMotion));
  if (plan.slots_due) gpu::grow(context_, slots_due_, plan.slots_due->size() * sizeof(std::uint32_t));
}

void NoiseAdvectionPass::upload(gpu::Recorder& recorder, const planning::NoisePlan& plan) {
  Stale& stale = recorder.change(stale_);
  if (stale.parts) recorder.upload(parts_, 0, std::as_bytes(growth_.parts()));
  if (stale.displacements) {
    recorder.upload(displacements_, 0, std::as_bytes(growth_.displacements()));
  } else if (stale.parts) {
    for (const std::uint32_t part : growth_.new_parts()) {
      const auto entries = growth_.displacements(part);
      recorder.upload(displacements_, std::size_t{part} * entries.size_bytes(), std::as_bytes(entries));
    }
  }
  growth_.clear_new_parts();
  stale = {false, false};
  recorder.upload(motions_, 0, std::as_bytes(std::span(plan.motion.clouds)));
  recorder.upload(impulses_, 0, std::as_bytes(std::span(plan.motion.impulses)));
  if (plan.slots_due && !plan.slots_due->empty())
    recorder.upload(slots_due_, 0, std::as_bytes(std::span(*plan.slots_due)));
}

void NoiseAdvectionPass::record(gpu::Recorder& recorder, const planning::NoisePlan& plan, const Inputs& in) {
  const gpu::Buffer& slots = plan.slots_due ? slots_due_ : in.smoke.slots;
  const auto all =
      plan.slots_due ? static_cast<std::uint32_t>(plan.slots_due->size()) : in.smoke.required_count;
  for (std::uint32_t first = 0; first < all; first += kSlotsPerDispatch) {
    const std::uint32_t count = std::min(kSlotsPerDispatch, all - first);
    recorder.bind(pipeline_, {in.smoke.bindings()},
                  {
                      {shared::kBindFrame, gpu::uniform(in.frame)},
                      {shared::kBindNoiseTile, gpu::sampled(in.noise, repeat_)},
                      {shared::kBindCloudParts, gpu::read(parts_)},
                      {shared::kBindDisplacements, gpu::read(displacements_)},
                      {shared::kBindCloudMotions, gpu::read(motions_)},
                      {shared::kBindImpulses, gpu::read(impulses_)},
                      {shared::kBindDensityDisplacement, gpu::stored(in.smoke.density_displacement)},
                      {shared::kBindFilteredDensity, gpu::stored(in.smoke.filtered_density)},
                      {shared::kBindSlots, gpu::read(slots)},
                  },
                  shared::NoiseAdvectionParams{first, count, in.smoke.slot_count,
                                               static_cast<std::uint32_t>(plan.motion.impulses.size())});
    recorder.dispatch_threads(pipeline_, count * shared::kTexelsPerBrick);
  }
}

}  // namespace brume::passes
