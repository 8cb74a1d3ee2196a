// Volumes as the quads of particles: moved and sorted on the device, blended over an image of radiance
// (shared/particles.h has the formulas, docs/guides/volume-textures.md the page).
#pragma once

#include <optional>
#include <span>

#include "gpu/recorder.hpp"
#include "shared/particles.h"

namespace brume::passes {

class ParticlePass {
 public:
  /// Creates the pipelines. Throws resource_limit.
  explicit ParticlePass(gpu::Context& context);

  /// Makes room for the systems of a frame, and with `counts_quads` for counts of their quads. Outside of a
  /// recording, when the device is done with the one before. Throws resource_limit.
  void reserve(std::span<const shared::ParticleSystem> systems, glm::uvec2 size_px,
               bool counts_quads = false);

  struct Inputs {
    const gpu::Buffer& frame;  ///< FrameConstants; of the target's size.
    const gpu::Image& slices;  ///< SliceTextures::image.
    const gpu::Image& depth;   ///< Reverse depth of the surfaces: GBuffer::depth.
  };
  /// Draws the systems, which `reserve` saw, over `target`, a storage image of half floats: its radiance
  /// times the transmittance of the quads, plus what they emit. Alpha stays. All quads are in one order from
  /// back to front, so that systems may overlap.
  void record(gpu::Recorder& recorder, const Inputs& inputs, std::span<const shared::ParticleSystem> systems,
              const gpu::Image& target) const;
  /// Adds 1 to all channels of `target`, half floats with
  /// VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, for each quad on a pixel: every run of the fragment shader, behind
  /// surfaces too. `reserve` saw the systems with `counts_quads`. Halves count up to 2,048.
  void record_overdraw(gpu::Recorder& recorder, const Inputs& inputs,
                       std::span<const shared::ParticleSystem> systems, const gpu::Image& target) const;

  /// Premultiplied radiance and transmittance of all quads of the last record. Floats: devices may truncate
  /// what they blend, and hundreds of blends of halves then lose some percent. Halves where a device cannot
  /// blend floats.
  const gpu::Image& layer() const { return layer_; }
  /// A shared::Particle for each particle of the last record.
  const gpu::Buffer& particles() const { return particles_; }
  /// Two words each: a key, and the number of a particle, in the order of the last record.
  const gpu::Buffer& order() const { return order_; }

 private:
  shared::ParticleList record_list(gpu::Recorder& recorder, const Inputs& inputs,
                                   std::span<const shared::ParticleSystem> systems) const;
  void record_sort(gpu::Recorder& recorder, shared::ParticleList list) const;
  void record_layer(gpu::Recorder& recorder, const Inputs& inputs, std::uint32_t particles) const;

  gpu::Context& context_;
  VkFormat layer_format_;
  gpu::ComputePipeline move_, sort_blocks_, sort_step_, compose_;
  gpu::GraphicsPipeline draw_;
  std::optional<gpu::GraphicsPipeline> count_;
  gpu::Buffer systems_, particles_, order_;
  gpu::Image layer_;
  gpu::Sampler linear_, nearest_;
};

}  // namespace brume::passes
