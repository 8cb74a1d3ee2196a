// The options of `render --mode reference`, and its frames.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "apps/cli/arguments.hpp"
#include "apps/cli/json.hpp"
#include "apps/cli/targets.hpp"
#include "planning/frame_input.hpp"
#include "scenario/simulation.hpp"

namespace brume::cli {

struct ReferenceOptions {
  std::optional<std::uint32_t> samples, max_bounces;
  std::optional<double> noise, time_limit, clamp, shutter;
  bool matte = false;
  std::string checkpoint;
};

void declare_reference(const Arguments& arguments, ReferenceOptions& options);

/// All that the options say about the pictures, for a key of what depends on them.
std::vector<std::string> texts_of(const ReferenceOptions& options);

/// Frames of a scenario by the path tracer.
class ReferenceFrames {
 public:
  /// `scenario` must outlive it. `has_layers`: frames as numbers. `key`: hash of what a frame depends on, for
  /// the checkpoint.
  ReferenceFrames(const scenario::Scenario& scenario, std::unique_ptr<scenario::Simulation> simulation,
                  const ReferenceOptions& options, glm::uvec2 size_px, bool has_layers, std::uint64_t key);

  /// Where the camera is instead of on the timeline's path; empty: on the path.
  void set_camera(const std::optional<scene::Camera>& camera) { camera_ = camera; }
  /// Renders the frame at a time [s] until the limits of the options, with progress. Saves and continues the
  /// checkpoint. Throws Error and Interrupted.
  Picture draw(double seconds);
  /// Of all frames so far.
  Json statistics() const;

 private:
  void measure_exposure();
  planning::FrameInput frame_at(double seconds, std::vector<shared::Hole>& holes) const;
  std::vector<planning::FrameInput> frames_until(double seconds) const;

  const scenario::Scenario& scenario_;
  std::unique_ptr<scenario::Simulation> simulation_;
  const ReferenceOptions& options_;
  glm::uvec2 size_px_;
  bool has_layers_;
  std::uint64_t key_;
  std::optional<scene::Camera> camera_;
  std::optional<float> exposure_;  ///< Measured; a factor.
  std::uint32_t frames_ = 0;
  double samples_ = 0, error_ = 0, seconds_ = 0, cpu_seconds_ = 0;
};

}  // namespace brume::cli
