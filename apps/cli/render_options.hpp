// The options of `brume render`.
#pragma once

#include <optional>
#include <string>

#include "apps/cli/flipbook_options.hpp"
#include "apps/cli/reference.hpp"
#include "apps/cli/scene_options.hpp"
#include "apps/cli/units.hpp"
#include "apps/command_line/arguments.hpp"
#include "apps/command_line/outputs.hpp"
#include "apps/command_line/parse.hpp"
#include "apps/command_line/targets.hpp"
#include "passes/debug_view.hpp"
#include "render/renderer.hpp"
#include "scenario/first_view.hpp"

namespace brume::cli {

struct RenderOptions {
  std::string input, output, timeline, frames, size = "1280x720", march = "full", camera, device, json,
                                               view = "none", slice, fps = "24", raycast, mode = "realtime",
                                               shard, background;
  SceneOptions scene;
  ReferenceOptions reference;
  FlipbookOptions flipbook;
  std::optional<double> time, orbit, shutter;
  std::optional<std::uint32_t> samples;
  bool temporal = false, resume = false;
  float step = 1, light_update_fraction = 1, resolve_error_scale = 1;
  std::uint32_t volume_memory = 0;  // [MiB]; 0: as much as suits the device
};

/// The parsed options, checked before any file is read.
struct Plan {
  TargetKind kind = TargetKind::picture;
  render::RendererOptions renderer;
  std::optional<scene::Camera> camera;
  scenario::FirstViewOptions scene;
  std::optional<FrameRange> frames;
  Shard shard;
  passes::DebugView view = passes::DebugView::none;
  std::optional<passes::ViewSlice> slice;
  FrameRate rate;
  bool has_layers = false;  ///< Whether frames are written as numbers.
  /// Form of frames that are drawn as numbers, to be written or for their alpha; empty: none is.
  std::optional<LayerForm> layers;
  std::optional<FlipbookPlan> flipbook;  ///< Instead of a picture: of all frames.
};

void declare_render(const Arguments& arguments, RenderOptions& options);

/// Parses the options and declares the files that are known before any is read. Throws Error (usage) for what
/// contradicts itself or would do nothing.
Plan make_plan(const Arguments& arguments, const RenderOptions& options, Outputs& outputs);

/// Declares the frames of a sequence that the command writes.
void declare_frames(const RenderOptions& options, const Plan& plan, FrameRange range, Outputs& outputs);

inline bool is_reference(const RenderOptions& options) {
  return options.mode == "reference";
}
/// Whether each frame depends on those before.
inline bool frames_depend(const RenderOptions& options) {
  return options.temporal || options.light_update_fraction < 1;
}

}  // namespace brume::cli
