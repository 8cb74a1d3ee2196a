// Tanks in a frame, over its surfaces: they become surfaces themselves, and a layer between those and the
// media.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <span>

#include "passes/layers.hpp"
#include "passes/surface_import.hpp"
#include "render/parts/frame_part.hpp"
#include "render/tank_sampler.hpp"

namespace brume::render {

class TanksPart {
 public:
  /// Whose surfaces the tanks of a frame join.
  enum class Over {
    host,   ///< GBuffer::imported: its depth becomes that of the tanks, too.
    level,  ///< Our own G-buffer, which keeps its depth for shading: surfaces() has both.
  };
  /// `context` and `stream` must outlive it.
  TanksPart(gpu::Context& context, gpu::CommandStream& stream, glm::uvec2 size_px, Over over);

  /// Frames of another size.
  void resize(glm::uvec2 size_px);
  /// Makes room for the tanks of a frame of this size before it is planned, and uploads what is new. Of tanks
  /// that are not shown, memory is kept for some frames. Throws resource_limit.
  void prepare(const FrameInput& input, glm::uvec2 size_px);
  /// Records the samples of the planned tanks, which become surfaces of the frame. `depth`: of its G-buffer.
  void record_surfaces(gpu::Recorder& recorder, const gpu::Image& depth, const gpu::Image& blue_noise);
  /// Depth of the planned frame's surfaces with its tanks; null: Over::host, or no tank is in view.
  const gpu::Image* surfaces() const { return surfaces_ && !shown_.empty() ? &surfaces_ : nullptr; }
  /// Records all layers, `media` last; without tanks nothing.
  void record_layers(gpu::Recorder& recorder, const gpu::Image& media);
  /// The layers of the last frame: half floats, premultiplied radiance and, in alpha, the transmittance.
  /// Null: it had no tanks.
  const gpu::Image* layers() const { return has_layers_.get(context_) ? &layers_ : nullptr; }

 private:
  /// A tank on the device.
  struct Slot {
    Slot(gpu::Context& context, gpu::CommandStream& stream, const scene::TankContent& tank_content)
        : sampler(context, stream, tank_content.tank, tank_content.bricks) {}
    std::shared_ptr<const scene::TankContent> content;
    std::shared_ptr<const scene::TankIllumination> light;
    TankSampler sampler;
    std::uint32_t samples = 0;  ///< To record in this frame.
    std::uint64_t frame = 0;    ///< The last one that it was planned for.
  };
  Slot& slot_of(const planning::TankInput& tank);
  void add(const planning::TankInput& tank, const planning::View& view, glm::uvec2 size_px);

  /// What the surfaces of our own level depend on, besides the camera.
  struct LevelSurfaces {
    std::vector<std::uint32_t> hidden_objects;
    std::vector<glm::mat4> grenades;
    std::vector<scene::MovedObject> moved;
    bool is(const planning::LevelState& level) const;
  };
  void begin_level(const FrameInput& input);

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  const Over over_;
  passes::LayerPass layer_pass_;
  std::optional<passes::SurfaceImport> copy_pass_;  ///< Where Over::level.
  glm::uvec2 size_px_;
  gpu::Image layers_, surfaces_;
  std::list<Slot> slots_;
  std::vector<Slot*> shown_;  ///< In the frame, the farthest first.
  std::uint64_t frame_ = 0;
  LevelSurfaces level_;          ///< What the last frame with tanks had, where Over::level.
  bool level_stands_ = true;     ///< The surfaces of the frame before are this one's.
  bool has_layers_now_ = false;  ///< In the planned frame.
  gpu::Recorded<bool> has_layers_;
};

}  // namespace brume::render
