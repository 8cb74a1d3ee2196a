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
  /// Of light paths that a frame can wait for: a few hundredths of a second.
  static constexpr std::uint32_t kPreview = 1u << 16;

  TankPhotons() = default;
  /// Stops the other thread.
  ~TankPhotons() { restart(); }
  TankPhotons(const TankPhotons&) = delete;
  TankPhotons& operator=(const TankPhotons&) = delete;

  /// What is to be shown from now on: `count` light paths of a scene. Returns those that replace what was
  /// returned last, if any do: at first a preview. All of them are begun when nothing `moves`, and returned
  /// by a later call. `tank` is the same until restart().
  std::optional<spheres::LightPaths> update(const spheres::Tank& tank, const spheres::LightPathScene& scene,
                                            std::uint32_t count, bool moves);
  /// Waits for all of them.
  std::optional<spheres::LightPaths> complete(const spheres::Tank& tank, const spheres::LightPathScene& scene,
                                              std::uint32_t count);
  /// Whether all of them were returned.
  bool is_complete() const { return wanted_ == 0 || count_ == wanted_; }
  /// Nothing was returned so far: the tank or the renderer is another one.
  void restart();

 private:
  void stop();
  spheres::LightPaths trace(const spheres::Tank& tank, std::uint32_t count);

  std::optional<spheres::BrickLists> bricks_;
  spheres::LightPathScene scene_;
  std::uint32_t wanted_ = 0, count_ = 0;  ///< Light paths of the scene, and of those that were returned last.
  std::atomic<bool> stops_ = false;
  std::future<spheres::LightPaths> all_;  ///< Running or finished, or invalid.
};

}  // namespace brume::viewer
