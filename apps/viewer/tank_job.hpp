// Loads or packs a tank in another thread.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <future>

#include "scenario/tank.hpp"

namespace brume::viewer {

/// Makes a tank with its scene; packing ends early, with what is packed so far, when its argument returns
/// true. Throws Error.
using TankMaker = std::function<scenario::TankScenario(const std::function<bool()>& stopped)>;

class TankJob {
 public:
  /// Begins at once.
  explicit TankJob(TankMaker make);
  /// Stops it and waits for its end.
  ~TankJob();
  TankJob(const TankJob&) = delete;
  TankJob& operator=(const TankJob&) = delete;

  void stop() { stops_ = true; }
  bool stops() const { return stops_; }
  /// Since its begin [s].
  double seconds() const;
  bool is_ready() const;
  /// Waits for its end. Once; throws what making threw.
  scenario::TankScenario take() { return made_.get(); }

 private:
  std::atomic<bool> stops_{false};
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::future<scenario::TankScenario> made_;
};

}  // namespace brume::viewer
