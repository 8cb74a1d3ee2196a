// The rays of a frame through its media: marched, resolved to pixels, smoothed over frames.
#pragma once

#include <array>
#include <optional>

#include "passes/accumulate.hpp"
#include "passes/march.hpp"
#include "passes/raycast.hpp"
#include "passes/resolve.hpp"
#include "render/parts/frame_part.hpp"

namespace brume::render {

class MarchPart {
 public:
  /// `context` and `stream` must outlive it. Throws resource_limit.
  MarchPart(gpu::Context& context, gpu::CommandStream& stream, glm::uvec2 size_px,
            const MediaOptions& options);

  // When the device is done with what was recorded before; all throw resource_limit.
  /// Frames of another size; what was accumulated is dropped.
  void resize(glm::uvec2 size_px);
  /// As MediaOptions::march_scale.
  void set_march_scale(std::uint32_t scale);
  void reserve(const FramePlan& plan);

  void upload(gpu::Recorder& recorder, const FrameResources& in);
  /// The rays of pixels or of tiles, then from those to every pixel.
  void record(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);
  /// The mean over frames. Where is_accumulated().
  void record_accumulate(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);

  /// Premultiplied radiance and transmittance of each pixel.
  const gpu::Image& result(const Targets& targets) const {
    return is_accumulated() ? accumulations_[shown_view_.get(context_)]->gathered() : targets.media;
  }
  std::uint32_t march_scale() const { return march_scale_; }
  bool is_accumulated() const { return options_.temporal; }
  /// Tiles of noise, from the first frame with smoke on.
  const gpu::Image& noise() const { return noise_; }
  const gpu::Image& detail() const { return detail_; }
  /// The rays of the march; empty where each pixel has its own.
  const std::optional<passes::MarchTiles>& tiles() const { return tiles_; }
  /// What MediaOptions lets the march count: a word, and one per pixel where it records entries.
  const gpu::Buffer& counters() const { return counters_; }

 private:
  /// What marches the frame's rays, and where it counts.
  struct March {
    const passes::MarchPass& pass;
    const gpu::Buffer& counters;
  };
  void reserve_accumulation(std::uint32_t view);
  March march_of(const FrameResources& in) const;
  void prepare();
  void make_noise();
  void record_raycast(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) const;

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  const MediaOptions options_;
  glm::uvec2 size_px_;
  std::uint32_t march_scale_ = 1;
  bool has_noise_ = false;

  gpu::Image noise_, detail_;
  gpu::Buffer counters_;
  std::optional<passes::MarchTiles> tiles_;          ///< Where march_scale_ is above 1.
  std::optional<passes::RaycastPass> raycast_pass_;  ///< In the place of the march.
  passes::MarchPass march_pass_;
  std::optional<passes::MarchPass> counting_march_;  ///< For the view of steps.
  std::optional<passes::ResolvePass> resolve_pass_;  ///< Where there are tiles_, or may be.
  /// Where media are accumulated over frames: of each view, from its first frame on.
  std::array<std::optional<passes::AccumulatePass>, planning::kMaxViews> accumulations_;
  gpu::Recorded<std::uint32_t> shown_view_;  ///< The view of the last frame.
};

}  // namespace brume::render
