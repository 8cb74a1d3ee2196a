// The volumes that a frame samples without a march, and what they show: decals on its surfaces.
#pragma once

#include <array>
#include <optional>

#include "passes/decals.hpp"
#include "passes/slice_textures.hpp"
#include "render/parts/frame_part.hpp"

namespace brume::render {

/// Slices of volumes on the device, for decals and particles.
class SlicesPart {
 public:
  /// `context` and `stream` must outlive it.
  SlicesPart(gpu::Context& context, gpu::CommandStream& stream) : context_(context), stream_(stream) {}

  /// Uploads the volumes of a frame, before it is planned, where they are others than before. Throws
  /// resource_limit and bad_input as SliceTextures.
  void prepare(const FrameInput& input);
  std::span<const shared::SliceTexture> textures() const {
    return slices_ ? slices_->textures() : std::span<const shared::SliceTexture>();
  }
  /// From the first frame with volumes on.
  const gpu::Image& image() const { return slices_->image(); }

 private:
  gpu::Context& context_;
  gpu::CommandStream& stream_;
  std::optional<passes::SliceTextures> slices_;
  std::shared_ptr<const grids::DenseVolumes> loaded_;  ///< What `slices_` holds.
};

class DecalsPart {
 public:
  /// `context` must outlive it.
  explicit DecalsPart(gpu::Context& context) : context_(context) {}

  /// Frames of another size. When the device is done with what was recorded before.
  void resize();
  /// Makes room for the frames of a view, outside of a recording. Throws resource_limit.
  void reserve(std::uint32_t view, glm::uvec2 size_px);
  void upload(gpu::Recorder& recorder, const FramePlan& plan, const SlicesPart& slices);
  /// The commands of a frame begin: without `record` it shows no decals.
  void begin(gpu::Recorder& recorder, const FramePlan& plan);
  /// The next frame of the view does not continue a film.
  void forget(gpu::Recorder& recorder, std::uint32_t view) {
    if (passes_[view]) passes_[view]->invalidate_past(recorder);
  }
  /// What the frame's decals take from its surfaces; `smooths`: the mean over the frames of a film. Where
  /// none is in view, an image of 0.
  void record(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
              const SlicesPart& slices, bool smooths);

  /// Whether the last frame had decals, in view or not.
  bool has_decals() const { return shown_.get(context_).has_decals; }
  /// Half floats: in red, which fraction of their light the surfaces of the last frame lost. Null: none.
  const gpu::Image* occlusion() const { return shown_.get(context_).occlusion; }

 private:
  struct Shown {
    bool has_decals = false;
    const gpu::Image* occlusion = nullptr;
  };
  gpu::Context& context_;
  /// The pass of each view, from its first frame with decals on.
  std::array<std::optional<passes::DecalPass>, planning::kMaxViews> passes_;
  gpu::Recorded<Shown> shown_;
};

}  // namespace brume::render
