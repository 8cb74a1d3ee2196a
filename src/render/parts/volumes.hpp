// The volumes of a frame: their bricks on the device, and the light in them.
#pragma once

#include <vector>

#include "passes/glow_field.hpp"
#include "passes/volume_light.hpp"
#include "render/parts/frame_part.hpp"

namespace brume::render {

class VolumesPart {
 public:
  /// `context` and `stream` must outlive it. Throws resource_limit.
  VolumesPart(gpu::Context& context, gpu::CommandStream& stream);

  /// Makes room for the volumes of a frame before it is planned, and uploads those that it must find whole.
  /// Throws resource_limit.
  void prepare(const FrameInput& input, planning::VolumeStreaming& streaming);
  void reserve(const FramePlan& plan);
  void upload(gpu::Recorder& recorder, const FramePlan& plan);
  /// The light of what glows in volumes, in the volumes themselves.
  void record_glow(gpu::Recorder& recorder, const FramePlan& plan) const;
  /// The light in the volumes: their sweeps, then the rest.
  void record_sweeps(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);
  void record_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);

  planning::VolumeLightRoom light_room() const;
  passes::VolumeResources resources() const { return upload_.resources(); }
  /// The volumes as light is found in them.
  passes::VolumeResources lit_resources() const { return upload_.lit_resources(); }
  const gpu::Image& glow_field() const { return glow_field_pass_.field(); }
  /// What the light in the volumes is found from.
  const passes::VolumeLightPass& light() const { return light_pass_; }

 private:
  static passes::VolumeLightPass::Inputs light_inputs(const FrameResources& in);

  gpu::CommandStream& stream_;
  passes::VolumeUpload upload_;
  passes::GlowFieldPass glow_field_pass_;
  passes::VolumeLightPass light_pass_;
};

}  // namespace brume::render
