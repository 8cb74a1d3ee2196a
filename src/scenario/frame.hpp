// The frame of a scenario at a time.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "planning/frame_input.hpp"
#include "scenario/frame_options.hpp"
#include "scenario/lens.hpp"
#include "scenario/simulation.hpp"

namespace brume::scenario {

/// What a frame shows of a scenario at a time. `holes` keeps the holes that the result refers to. Objects,
/// volumes, decals and tanks move with the carriers.
planning::FrameInput frame_input(const Scenario& scenario, const Simulation& simulation, double seconds,
                                 std::vector<shared::Hole>& holes, const FrameOptions& options = {});

/// Moves the camera and what carriers move from where they are at the frame's time to where they are at
/// another one [s]. All else stays: smoke, holes, lights, the contents of volumes. `options`: the frame's.
void move_frame(const Scenario& scenario, double from_seconds, double to_seconds, const FrameOptions& options,
                planning::FrameInput& input);

/// The samples of the picture of a frame at a time [s]: the frame as each of them sees it. `count`: how many;
/// empty: as many as are usual.
class FrameSamples {
 public:
  /// `scenario` must outlive it, and `options.steered`.
  FrameSamples(const Scenario& scenario, double seconds, const FrameOptions& options,
               planning::FrameInput frame, std::optional<std::uint32_t> count);
  std::uint32_t count() const { return static_cast<std::uint32_t>(samples_.size()); }
  planning::FrameInput operator[](std::uint32_t i) const& { return seen(i, frame_); }
  /// The same without a copy of the frame: call it last.
  planning::FrameInput operator[](std::uint32_t i) && { return seen(i, std::move(frame_)); }

 private:
  planning::FrameInput seen(std::uint32_t i, planning::FrameInput frame) const;

  const Scenario& scenario_;
  double seconds_;
  FrameOptions options_;
  planning::FrameInput frame_;
  std::vector<CameraSample> samples_;
};

}  // namespace brume::scenario
