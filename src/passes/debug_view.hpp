// Debug views of what a frame is made from: voxels, distances, slices, numbers of rays, surfaces
// (docs/reference/command-line.md).
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "passes/gbuffer.hpp"
#include "passes/hole_clusters.hpp"
#include "passes/solid_volume.hpp"
#include "planning/debug_request.hpp"
#include "shared/debug_view.h"
#include "sim/state.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::passes {

using planning::DebugView;
using planning::ViewSlice;

/// The names of all views by their number, `none` first.
constexpr std::array<std::string_view, shared::kViewCount> kDebugViewNames{
    "none",  "solid",  "distance", "density", "light", "holes",
    "steps", "bricks", "normals",  "albedo",  "depth", "overdraw"};

constexpr std::string_view debug_view_name(DebugView view) {
  return kDebugViewNames[static_cast<std::size_t>(view)];
}
/// Nothing where no view has the name.
std::optional<DebugView> find_debug_view(std::string_view name);

/// Whether a view depends on where its slice is.
constexpr bool has_slice(DebugView view) {
  return view == DebugView::density || view == DebugView::light || view == DebugView::distance;
}

/// The number at the end of a view's ramp: of distance, from what the clouds may fill [m], of holes [m], of
/// steps, of quads.
float ramp_end(DebugView view, const sim::State& state);

/// What a view is of.
struct DebugSubject {
  DebugView view = DebugView::none;  ///< Not `none`.
  ViewSlice slice;
  LevelView level;
  const smoke::SmokeBricks* volume = nullptr;  ///< null: no smoke.
  const sim::State* state = nullptr;           ///< Its clouds have distances; null: there are none.
};

class DebugViewPass {
 public:
  /// Creates almost nothing: the resources of a view are made when it is reserved first.
  explicit DebugViewPass(gpu::Context& context);

  /// Makes the view's pipeline and room for its data. Outside of a recording, when the device is done
  /// with the one before. Throws resource_limit.
  void reserve(const DebugSubject& subject, glm::uvec2 size_px);

  struct Inputs {
    const gpu::Buffer& frame;
    const GBuffer& gbuffer;
    const gpu::Image& surfaces;  ///< Depth of all surfaces, tanks included.
    const SmokeResources& smoke;
    const HoleResources& holes;
    const gpu::Image& quads;  ///< Half floats: the view of overdraw shows what ParticlePass counted there.
  };
  /// Writes the view to `display` (RGBA8). The subject is as `reserve` saw it.
  void record(gpu::Recorder& recorder, const DebugSubject& subject, const Inputs& inputs,
              const gpu::Image& display);

  /// Where MarchPass counts for the view of steps: the frame's samples, then the steps of each pixel. There
  /// after `reserve` with that view.
  const gpu::Buffer& counters() const { return counters_; }

 private:
  void find_level(const LevelView& level);
  void find_distances(const DebugSubject& subject);

  gpu::Context& context_;
  gpu::Sampler nearest_;
  std::array<std::optional<gpu::ComputePipeline>, shared::kViewCount> pipelines_;
  gpu::Buffer level_, distances_, counters_;
  gpu::Buffer nothing_;  ///< Bound where a view does not read one.
  glm::ivec3 root_size_{0};
  // What is to be uploaded, and what it was made from.
  std::vector<std::uint32_t> level_words_, distance_words_;
  std::optional<LevelView> seen_level_;
};

}  // namespace brume::passes
