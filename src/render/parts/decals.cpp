#include "render/parts/decals.hpp"

namespace brume::render {

void SlicesPart::prepare(const FrameInput& input) {
  if (input.slices == loaded_ && slices_) return;
  std::vector<std::span<const grids::DenseGrid>> volumes;
  if (input.slices)
    for (const auto& volume : *input.slices) volumes.emplace_back(*volume);
  if (volumes.empty() && !slices_) return;
  slices_.emplace(passes::SliceTextures::create(context_, stream_, volumes).value_or_throw());
  loaded_ = input.slices;
}

void DecalsPart::resize() {
  for (auto& pass : passes_) pass.reset();
  shown_.change(context_).occlusion = nullptr;
}

void DecalsPart::reserve(std::uint32_t view, glm::uvec2 size_px) {
  if (!passes_[view]) passes_[view].emplace(context_, size_px);
}

void DecalsPart::upload(gpu::Recorder& recorder, const FramePlan& plan, const SlicesPart& slices) {
  if (plan.decals.empty()) return;
  FrameVector<shared::Decal> decals(&recorder.memory());
  decals.reserve(plan.decals.size());
  for (const planning::PlacedDecal& placed : plan.decals) {
    decals.push_back(placed.decal);
    decals.back().occlusion = slices.textures()[placed.volume];
  }
  passes_[plan.input.view.index]->upload(recorder, decals);
}

void DecalsPart::begin(gpu::Recorder& recorder, const FramePlan& plan) {
  recorder.change(shown_) = {!plan.input.decals.empty(), nullptr};
  if (plan.decals.empty()) forget(recorder, plan.input.view.index);
}

void DecalsPart::record(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                        const SlicesPart& slices, bool smooths) {
  passes::DecalPass& pass = *passes_[plan.input.view.index];
  if (plan.decals.empty()) pass.upload(recorder, {});
  pass.record(recorder, in.frame, plan.size_px, in.targets.gbuffer, in.blue_noise, slices.image(),
              smooths ? plan.history() : std::nullopt);
  recorder.change(shown_) = {true, &pass.occlusion()};
  if (plan.decals.empty()) forget(recorder, plan.input.view.index);
}

}  // namespace brume::render
