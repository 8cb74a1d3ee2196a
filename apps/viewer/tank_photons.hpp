// Light through the glass for the window of a tank: few light paths at once, and all of them from another
// thread.
#pragma once

#include <atomic>
#include <future>
#include <optional>

#include "spheres/light_paths.hpp"

namespace brume::viewer {

class TankPhotons {
 public:
  /// Light paths of a preview, for which a frame can wait: a few hundredths of a second.
  static constexpr std::uint32_t kPreview = 1u << 16;

  /// Light paths that replace what was returned before.
  struct Change {
    spheres::LightPaths paths;
    bool restarts = false;  ///< The light is another one, or has more paths: samples so far are useless.
  };

  TankPhotons() = default;
  /// Stops the other thread.
  ~TankPhotons() { restart(); }
  TankPhotons(const TankPhotons&) = delete;
  TankPhotons& operator=(const TankPhotons&) = delete;

  /// What is to be shown from now on: `count` light paths of a scene (planning::light_path_count), for a
  /// picture that has `samples`.
  /// Returns a preview for another scene; all of them are traced when nothing `moves`, and returned by a
  /// later call, as is the next batch (render::TankPicture::batch_of). `tank` is the same until
  /// restart().
  std::optional<Change> update(const spheres::Tank& tank, const spheres::LightPathScene& scene,
                               std::uint32_t count, std::uint32_t samples, bool moves);
  /// Waits until update() has nothing more to return for these samples; the last of it.
  std::optional<Change> complete(const spheres::Tank& tank, const spheres::LightPathScene& scene,
                                 std::uint32_t count, std::uint32_t samples);
  /// Whether all light paths of the scene were returned, not a preview.
  bool is_complete() const { return count_ == wanted_; }
  /// Whether the next sample of a picture that has `samples` may use what was returned.
  bool is_ready_for(std::uint32_t samples) const;
  /// Forgets what was returned: the tank or the renderer is another one.
  void restart();

 private:
  void stop();
  void begin(const spheres::Tank& tank, std::uint32_t batch);
  bool is_finished() const;
  spheres::LightPaths trace(const spheres::Tank& tank, std::uint32_t count, std::uint32_t batch);

  std::optional<spheres::BrickLists> bricks_;
  spheres::LightPathScene scene_;
  std::uint32_t wanted_ = 0, count_ = 0;  ///< Light paths: of the scene, and returned last.
  std::uint32_t batch_ = 0;               ///< The batch that was returned last.
  spheres::LightPaths first_;             ///< All of batch 0, with which every picture of the scene begins.
  std::atomic<bool> stops_ = false;
  std::future<spheres::LightPaths> next_;  ///< Running or finished, or invalid.
  std::uint32_t next_batch_ = 0;
};

}  // namespace brume::viewer
