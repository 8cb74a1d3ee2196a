// Progress of long jobs: done of total, rate, remaining time. The job counts, the program displays.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace brume {

/// One long job, listed for displays while it lives. Cheap enough for jobs of a millisecond.
class Progress {
 public:
  struct State {
    std::string name;  ///< Name of the job: "voxelize", "frames".
    std::uint64_t done = 0;
    std::uint64_t total = 0;  ///< 0: unknown.
    double seconds = 0;       ///< Since the start of the job.
    std::string detail = {};  ///< What else there is to say: "error 2.1 %".
    double rate() const { return seconds > 0 ? static_cast<double>(done) / seconds : 0; }
    /// Seconds until done = total at the present rate; negative: not yet known.
    double seconds_left() const;
  };

  explicit Progress(std::string name, std::uint64_t total = 0);
  Progress(const Progress&) = delete;
  ~Progress();
  /// May be called from any thread.
  void advance(std::uint64_t count = 1) { done_.fetch_add(count, std::memory_order_relaxed); }
  /// From any thread.
  void set_total(std::uint64_t total) { total_.store(total, std::memory_order_relaxed); }
  void set_detail(std::string detail);
  State state() const;

 private:
  std::string name_, detail_;
  std::atomic<std::uint64_t> total_;
  std::atomic<std::uint64_t> done_{0};
  std::chrono::steady_clock::time_point start_;
};

/// The job to display: of those that have run for at least `seconds`, the one with a total that began last,
/// else any that began last. Nothing if there is none. From any thread.
std::optional<Progress::State> progress_to_show(double seconds);

/// "frames  [#####.....]  60/120  4.1/s  15 s left  detail", at most `width` characters; jobs without a total
/// show the time that they have taken.
std::string progress_line(const Progress::State& state, std::size_t width);

/// The same for programs, one line: {"progress": {"name": "frames", "done": 60, "total": 120, "rate": 4.1,
/// "seconds_left": 15}}; `total` and `seconds_left` are null while they are not known, and `detail` is there
/// where the job has one. Bytes of names that are not ASCII are replaced by "?".
std::string progress_json(const Progress::State& state);

}  // namespace brume
