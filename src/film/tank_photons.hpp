// Light through the glass for the picture of a tank alone: few light paths at once, and all of them, batch
// after batch, from another thread.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <optional>

#include "render/tank_picture.hpp"
#include "spheres/light_paths.hpp"

namespace brume::film {

class TankPhotons {
 public:
  /// Light paths of a preview, for which a frame can wait: a few hundredths of a second.
  static constexpr std::uint32_t kPreview = 1u << 16;
  /// Light paths are traced again for every few samples, with the number of the batch as their seed: what
  /// their noise leaves in one batch averages out over all.
  static constexpr std::uint32_t kSamplesOfBatch = 16;
  static constexpr std::uint32_t batch_of(std::uint32_t samples) { return samples / kSamplesOfBatch; }

  TankPhotons() = default;
  /// Stops the other thread.
  ~TankPhotons() { restart(); }
  TankPhotons(const TankPhotons&) = delete;
  TankPhotons& operator=(const TankPhotons&) = delete;

  // The tank and its picture are the same until restart(). To be called when the device is done with what was
  // recorded before.
  /// Gives the picture the light paths of its next sample: of a preview where its light is another one; all
  /// of them are traced when nothing `moves`, and given to it by a later call, as is the next batch. Whether
  /// the picture begins again: samples by fewer paths, or by other light, are useless.
  bool update(render::TankPicture& picture, const spheres::Tank& tank, bool moves);
  /// Waits until the picture has all light paths of its next sample, unless it is `stopped`.
  void complete(render::TankPicture& picture, const spheres::Tank& tank,
                const std::function<bool()>& stopped = {});
  /// Whether the picture has all light paths of a batch, not a preview.
  bool is_complete() const { return count_ == wanted_; }
  /// Samples that may follow in a picture that has `samples`, by the light paths that it has; 0: none.
  std::uint32_t samples_from(std::uint32_t samples) const;
  /// Forgets what it gave: the tank or the picture is another one.
  void restart();

 private:
  void stop();
  void begin(const spheres::Tank& tank, std::uint32_t batch);
  bool is_finished(std::chrono::milliseconds wait = {}) const;
  bool has_paths_for(std::uint32_t samples) const;
  bool takes_light(const render::TankPicture& picture, const spheres::Tank& tank);
  spheres::LightPaths trace(const spheres::Tank& tank, std::uint32_t count, std::uint32_t batch);

  std::optional<spheres::BrickLists> bricks_;
  spheres::LightPathScene scene_;
  std::uint32_t wanted_ = 0, count_ = 0;  ///< Light paths: of the scene, and given last.
  std::uint32_t batch_ = 0;               ///< The batch that was given last.
  spheres::LightPaths first_;             ///< All of batch 0, with which every picture of the scene begins.
  std::atomic<bool> stops_ = false;
  std::future<spheres::LightPaths> next_;  ///< Running or finished, or invalid.
  std::uint32_t next_batch_ = 0;
};

}  // namespace brume::film
