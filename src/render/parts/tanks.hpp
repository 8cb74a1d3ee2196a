// Tanks in a frame, over its surfaces: they become surfaces themselves, and a layer between those and the
// media.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <span>

#include "passes/layers.hpp"
#include "render/parts/frame_part.hpp"
#include "render/tank_sampler.hpp"

namespace brume::render {

class TanksPart {
 public:
  /// `context` and `stream` must outlive it.
  TanksPart(gpu::Context& context, gpu::CommandStream& stream, glm::uvec2 size_px);

  /// Frames of another size.
  void resize(glm::uvec2 size_px);
  /// Makes room for the tanks of a frame before it is planned, and uploads what is new. Of tanks that are not
  /// shown, memory is kept for some frames. Throws resource_limit.
  void prepare(const FrameInput& input);
  /// Records the samples of the planned tanks, which become surfaces of the frame. `depth`: of
  /// GBuffer::imported.
  void record_surfaces(gpu::Recorder& recorder, const gpu::Image& depth, const gpu::Image& blue_noise);
  /// Records all layers, `media` last; without tanks nothing.
  void record_layers(gpu::Recorder& recorder, const gpu::Image& media);
  /// The layers of the last frame: half floats, premultiplied radiance and, in alpha, the transmittance.
  /// Null: it had no tanks.
  const gpu::Image* layers() const { return has_layers_.get(context_) ? &layers_ : nullptr; }

 private:
  /// A tank on the device.
  struct Slot {
    Slot(gpu::Context& context, gpu::CommandStream& stream, const planning::TankContent& tank_content)
        : sampler(context, stream, tank_content.tank, tank_content.bricks) {}
    std::shared_ptr<const planning::TankContent> content;
    std::shared_ptr<const planning::TankLight> light;
    std::optional<scene::TankView> view;
    planning::TankPlan plan;
    TankSampler sampler;
    std::uint32_t samples = 0;  ///< To record in this frame.
    std::uint64_t frame = 0;    ///< The last one that it was planned for.
  };
  Slot& slot_of(const planning::TankInput& tank);
  void add(const planning::TankInput& tank, const scene::Camera& camera);

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  passes::LayerPass layer_pass_;
  glm::uvec2 size_px_;
  gpu::Image layers_;
  std::list<Slot> slots_;
  std::vector<Slot*> shown_;  ///< In the frame, the farthest first.
  std::uint64_t frame_ = 0;
  bool has_tanks_ = false;  ///< In the frame, in view or not.
  gpu::Recorded<bool> has_layers_;
};

}  // namespace brume::render
