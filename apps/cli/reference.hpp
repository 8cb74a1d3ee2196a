// The options of `render --mode reference`, and its frames.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "apps/cli/stopwatch.hpp"
#include "apps/command_line/arguments.hpp"
#include "apps/command_line/json.hpp"
#include "apps/command_line/targets.hpp"
#include "reference/render.hpp"
#include "scenario/frame.hpp"
#include "scenario/simulation.hpp"

namespace brume::cli {

struct ReferenceOptions {
  std::optional<std::uint32_t> max_bounces;
  std::optional<double> noise, time_limit, clamp;
  bool matte = false;
  std::string checkpoint;
};

void declare_reference(const Arguments& arguments, ReferenceOptions& options);

/// All that the options say about the pictures, for a key of what depends on them.
std::vector<std::string> to_texts(const ReferenceOptions& options);

/// Adds samples to a picture until the limits of the options, with progress. Saves and continues the
/// checkpoint, whose key is `key`. `samples` comes from the render's settings; `spent` is the part of
/// the time limit that is used up [s]. Warns where parts of the picture have no sample at the end. Throws
/// Error and Interrupted.
void add_samples(reference::Render& render, const ReferenceOptions& options, std::uint32_t samples,
                 std::uint64_t key, double spent = 0);

/// --samples, or `usual` ones where nothing else ends a picture; 0: no limit.
std::uint32_t most_samples(const ReferenceOptions& options, std::optional<std::uint32_t> samples,
                           std::uint32_t usual);

/// What the options of both modes say about frames.
struct FrameSettings {
  glm::uvec2 size_px{0};
  std::optional<std::uint32_t> samples;
  std::optional<LayerForm> layers;  ///< Empty: frames are colours, with their background.
  std::uint64_t key = 0;            ///< Hash of what a frame depends on, for the checkpoint.
};

/// Frames of a scenario by the path tracer.
class ReferenceFrames {
 public:
  /// `scenario` and `options` must outlive it.
  ReferenceFrames(const scenario::Scenario& scenario, std::unique_ptr<scenario::Simulation> simulation,
                  const ReferenceOptions& options, const FrameSettings& frames);

  /// Where the camera is at a time instead of on the timeline's path; empty: on the path.
  void set_camera(scenario::CameraAt camera) { frame_options_.camera = std::move(camera); }
  /// Renders the frame at a time [s] until the limits of the options, with progress. Saves and continues the
  /// checkpoint. Throws Error and Interrupted.
  Picture draw(double seconds);
  /// How the last frame became colours, or would.
  const image::Display& display() const { return display_; }
  /// Statistics of all frames so far.
  Json statistics() const;

 private:
  void measure_exposure(const Stopwatch& watch);
  planning::FrameInput frame_at(double seconds, std::vector<shared::Hole>& holes) const;
  std::vector<planning::FrameInput> frames_after(double seconds, const planning::FrameInput& frame) const;
  reference::RenderSettings settings_of(const planning::FrameInput& frame,
                                        std::span<const planning::FrameInput> later) const;

  const scenario::Scenario& scenario_;
  std::unique_ptr<scenario::Simulation> simulation_;
  const ReferenceOptions& options_;
  FrameSettings settings_;
  scenario::FrameOptions frame_options_{.particles = false};
  std::optional<float> exposure_;  ///< Measured; a factor.
  image::Display display_;
  std::uint32_t frames_ = 0;
  double samples_ = 0, error_ = 0, seconds_ = 0, cpu_seconds_ = 0;
};

}  // namespace brume::cli
