// A frame of a game, as a renderer takes it.
#pragma once

#include <utility>
#include <vector>

#include "apps/viewer/game.hpp"
#include "film/playback.hpp"

namespace brume::viewer {

/// What a renderer shows of a game: what is steered where it is, and decals only if they are chosen. `holes`
/// keeps the holes that the result refers to.
render::FrameInput frame_input(const Game& game, std::vector<shared::Hole>& holes,
                               volumes::VolumeWait wait = volumes::VolumeWait::until_loaded);

/// A paused frame of a game, as `brume render` shows it: the mean of the samples of its camera.
class StillFrame {
 public:
  /// `game` must outlive it, unchanged.
  explicit StillFrame(const Game& game);
  std::uint32_t samples() const { return samples_->count(); }
  render::FrameInput sample(std::uint32_t i) const { return (*samples_)[i]; }
  /// The same without a copy of the frame: call it last.
  render::FrameInput last_sample(std::uint32_t i) { return std::move(*samples_)[i]; }

 private:
  std::vector<shared::Hole> holes_;
  std::optional<std::vector<scene::Carrier>> steered_;
  std::optional<scenario::FrameSamples> samples_;
};

}  // namespace brume::viewer
