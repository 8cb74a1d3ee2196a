// What a screen shows of a frame: shaded surfaces behind the media, exposed and smoothed, or a debug view.
#pragma once

#include <optional>

#include "passes/antialias.hpp"
#include "passes/average.hpp"
#include "passes/debug_view.hpp"
#include "passes/display.hpp"
#include "passes/particles.hpp"
#include "render/parts/decals.hpp"
#include "render/parts/frame_part.hpp"

namespace brume::render {

/// Particles: quads of slices, over the picture.
class ParticlesPart {
 public:
  /// `context` must outlive it.
  explicit ParticlesPart(gpu::Context& context) : context_(context) {}
  /// Throws resource_limit.
  void reserve(const FramePlan& plan);
  void record(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
              const SlicesPart& slices) const;
  /// How many quads each pixel has, in the radiance.
  void record_overdraw(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                       const SlicesPart& slices) const;

 private:
  gpu::Context& context_;
  std::optional<passes::ParticlePass> pass_;  ///< From the first frame with particles in view on.
};

class PicturePart {
 public:
  struct Options {
    bool antialias = false;    ///< As RendererOptions.
    bool prepare_all = false;  ///< As MediaOptions.
    bool has_panes = false;    ///< Panes are drawn over the shaded surfaces.
  };
  /// `context` must outlive it. Throws resource_limit.
  PicturePart(gpu::Context& context, glm::uvec2 size_px, const Options& options);

  /// Frames of another size. When the device is done with what was recorded before.
  void resize(glm::uvec2 size_px);
  /// Throws resource_limit.
  void reserve(const FramePlan& plan);

  /// The surfaces behind `layers`, less what decals take. True where that is the picture already.
  bool record_shade(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                    const gpu::Image& layers, const gpu::Image* occlusion) const;
  /// The mean of several samples or frames, and its colours on a display.
  void record_display(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                      const gpu::Image& media);
  void record_debug_view(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);

  /// Half floats: radiance of the picture before exposure and tone curve.
  const gpu::Image& radiance(const Targets& targets) const {
    return antialias_pass_ ? antialias_pass_->result() : targets.radiance;
  }
  bool is_antialiased() const { return antialias_pass_.has_value(); }
  /// Where the frame's march counts steps; null: nowhere.
  const gpu::Buffer* step_counters(const FramePlan& plan) const;

 private:
  passes::ShadePass::Needs shade_needs(const FramePlan& plan) const;

  gpu::Context& context_;
  glm::uvec2 size_px_;
  const bool shading_displays_;
  passes::ShadePass shade_pass_;
  std::optional<passes::DisplayPass> display_pass_;  ///< From the first frame on that shading does not show.
  std::optional<passes::DebugViewPass> debug_view_;  ///< From the first frame with a debug view on.
  std::optional<passes::AntialiasPass> antialias_pass_;  ///< Where Options::antialias.
  std::optional<passes::AveragePass> average_pass_;      ///< From the first picture of several frames on.
};

}  // namespace brume::render
