// Frames of a GPU, and how long they took.
#pragma once

#include <algorithm>
#include <type_traits>

#include "apps/cli/stopwatch.hpp"
#include "apps/command_line/json.hpp"
#include "apps/command_line/targets.hpp"
#include "film/playback.hpp"

namespace brume::cli {

/// Draws frames and gathers the statistics for --json.
class TimedPlayback {
 public:
  explicit TimedPlayback(film::Playback& playback) : playback_(playback) {}
  /// `form`: null draws colours.
  Picture draw(double seconds, std::uint32_t frame_index, const LayerForm* form) {
    return timed([&]() -> Picture {
      if (!form) return playback_.draw(seconds, frame_index);
      image::LayeredImage layers = playback_.draw_layers(seconds, frame_index);
      return to_picture(std::move(layers), *form, playback_.display());
    });
  }
  Json statistics() const {
    Json passes = Json::object();
    for (const auto& scope : playback_.timings()) passes.set(std::string(scope.name), scope.milliseconds);
    return {{"frames", frames_},
            {"seconds_per_frame", seconds_ / std::max(frames_, 1)},
            {"cpu_seconds_per_frame", cpu_seconds_ / std::max(frames_, 1)},
            {"samples_per_pixel", playback_.samples()},
            {"marched_fraction_of_last_frame", playback_.fraction_marched()},
            {"gpu_milliseconds_of_last_frame", passes}};
  }

 private:
  template <typename Draw>
  std::invoke_result_t<Draw> timed(Draw draw) {
    const Stopwatch watch;
    auto picture = draw();
    seconds_ += watch.seconds();
    cpu_seconds_ += watch.cpu_seconds();
    ++frames_;
    return picture;
  }

  film::Playback& playback_;
  double seconds_ = 0, cpu_seconds_ = 0;
  int frames_ = 0;
};

}  // namespace brume::cli
