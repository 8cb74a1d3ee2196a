#include "render/parts/volumes.hpp"

namespace brume::render {

VolumesPart::VolumesPart(gpu::Context& context, gpu::CommandStream& stream)
    : stream_(stream), upload_(context), glow_field_pass_(context), light_pass_(context) {}

void VolumesPart::prepare(const FrameInput& input, planning::VolumeStreaming& streaming) {
  constexpr std::uint64_t kPartBytes = 64u << 20;
  const std::uint64_t budget = input.quality.volume_upload_bytes;
  for (const std::uint64_t missing : upload_.reserve(input.volumes)) streaming.lose(missing);
  while (!streaming.is_ready(input.volumes, budget)) {
    const std::vector<planning::VolumeResidency> part =
        streaming.plan_part(input.volumes, budget, kPartBytes);
    stream_.run([&](gpu::Recorder& recorder) { upload_.record_part(recorder, input.volumes, part); });
    streaming.commit();
  }
}

void VolumesPart::reserve(const FramePlan& plan) {
  if (!plan.volume_light.is_lit) return;
  glow_field_pass_.reserve(planning::volumes_in_view(plan.media), plan.media.casters);
  light_pass_.reserve(plan.volume_light, plan.media.casters);
}

void VolumesPart::upload(gpu::Recorder& recorder, const FramePlan& plan) {
  upload_.record(recorder, plan.input.volumes, plan.residency, plan.media.volumes, plan.lit_media.volumes);
}

planning::VolumeLightRoom VolumesPart::light_room() const {
  planning::VolumeLightRoom room = light_pass_.room();
  room.glowing_volumes = glow_field_pass_.room();
  return room;
}

passes::VolumeLightPass::Inputs VolumesPart::light_inputs(const FrameResources& in) {
  return {in.frame, in.scene, in.shadows, in.level, in.lit_media, in.glow_field};
}

void VolumesPart::record_glow(gpu::Recorder& recorder, const FramePlan& plan) const {
  if (!plan.volume_light.update) return;
  glow_field_pass_.record(recorder,
                          {plan.media.casters, lit_resources(), planning::volumes_in_view(plan.media)});
}

void VolumesPart::record_sweeps(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  light_pass_.record_sweeps(recorder, light_inputs(in), plan.volume_light);
}

void VolumesPart::record_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  light_pass_.record_light(recorder, light_inputs(in), plan.volume_light);
}

}  // namespace brume::render
