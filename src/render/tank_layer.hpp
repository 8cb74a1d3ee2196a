// Tanks in a frame, over its surfaces: they become surfaces themselves, and a layer between those and the
// media.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <span>

#include "passes/layers.hpp"
#include "render/tank_sampler.hpp"

namespace brume::render {

/// A tank, and what it is shown with; neither changes.
struct TankContent {
  spheres::Tank tank;
  spheres::BrickLists bricks;
};
struct TankLight {
  scene::TankScene scene;  ///< Lights, glass, fog, bounces and Sky::ambient, as they are at the start.
  spheres::LightPaths paths;
};

/// A tank in a frame.
struct TankInput {
  std::shared_ptr<const TankContent> content;
  std::shared_ptr<const TankLight> light;
  planning::TankPlacement placement;
  scene::TankView view = scene::TankView::spheres;
  std::uint32_t samples = 1;  ///< Paths of each pixel in this frame, > 0.
  std::uint32_t index = 0;    ///< Of the first one, where the picture begins: another one has other noise.
  /// The frame's surfaces before the tank are those of the frame before: samples are added to it, where all
  /// else is the same, too.
  bool continues = false;
};

class TankLayer {
 public:
  /// `context` and `stream` must outlive it.
  TankLayer(gpu::Context& context, gpu::CommandStream& stream, glm::uvec2 size_px);

  /// Frames of another size.
  void resize(glm::uvec2 size_px);
  /// Makes room for the tanks of the next frame, and uploads what is new. Of tanks that are not shown, memory
  /// is kept for some frames. Throws resource_limit.
  void plan(std::span<const TankInput> tanks, const scene::Camera& camera);
  /// Records the samples of the planned tanks, which become surfaces of the frame. `depth`: of
  /// GBuffer::imported.
  void record_surfaces(gpu::Recorder& recorder, const gpu::Image& depth, const gpu::Image& blue_noise);
  /// Records all layers, `media` last.
  void record_layers(gpu::Recorder& recorder, const gpu::Image& media);
  /// Those: half floats, premultiplied radiance and, in alpha, the transmittance.
  const gpu::Image& layers() const { return layers_; }

 private:
  /// A tank on the device.
  struct Slot {
    Slot(gpu::Context& context, gpu::CommandStream& stream, const TankContent& of)
        : sampler(context, stream, of.tank, of.bricks) {}
    std::shared_ptr<const TankContent> content;
    std::shared_ptr<const TankLight> light;
    std::optional<scene::TankView> view;
    planning::TankPlan plan;
    TankSampler sampler;
    std::uint32_t samples = 0;  ///< To record in this frame.
    std::uint64_t frame = 0;    ///< The last one that it was planned for.
  };
  Slot& slot_of(const TankInput& tank);
  void plan(const TankInput& tank, const scene::Camera& camera);

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  passes::LayerPass layer_pass_;
  glm::uvec2 size_px_;
  gpu::Image layers_;
  std::list<Slot> slots_;
  std::vector<Slot*> shown_;  ///< In the frame, the farthest first.
  std::uint64_t frame_ = 0;
};

}  // namespace brume::render
