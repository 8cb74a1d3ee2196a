// Progress of a long job: done of total, rate, remaining time. The job counts, the program displays.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

namespace brume {

/// One long job. `advance` may be called from one thread at a time.
class Progress {
 public:
  struct State {
    std::string name;  ///< Name of the job: "voxelize", "frames".
    std::uint64_t done = 0;
    std::uint64_t total = 0;  ///< 0: unknown.
    double seconds = 0;       ///< Since the start of the job.
    double rate() const { return seconds > 0 ? static_cast<double>(done) / seconds : 0; }
    /// Seconds until done = total at the present rate; negative: not yet known.
    double seconds_left() const;
  };
  using Callback = std::function<void(const State&)>;

  /// The callback (may be empty) is called at the start, then at each advance.
  Progress(std::string name, std::uint64_t total, Callback callback);
  void advance(std::uint64_t count = 1);
  const State& state() const { return state_; }

 private:
  State state_;
  Callback callback_;
  std::chrono::steady_clock::time_point start_;
};

/// "frames  [#####.....]  60/120  4.1/s  15 s left", at most 79 characters.
std::string progress_line(const Progress::State& state);

}  // namespace brume
