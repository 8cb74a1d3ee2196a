// Work of another thread that can be stopped.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <future>

namespace brume::viewer {

class Job {
 public:
  /// Begins at once. `work` ends early when its argument returns true.
  explicit Job(std::function<void(const std::function<bool()>& stopped)> work)
      : done_(std::async(std::launch::async,
                         [this, work = std::move(work)] { work([this] { return stops_.load(); }); })) {}
  /// Stops it and waits for its end.
  ~Job() {
    stops_ = true;
    if (done_.valid()) done_.wait();
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  void stop() { stops_ = true; }
  bool stops() const { return stops_; }
  /// Since its begin [s].
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  /// Waits for its end, but no longer than that; whether it has ended.
  bool wait(double seconds) const {
    return done_.wait_for(std::chrono::duration<double>(seconds)) == std::future_status::ready;
  }
  /// Waits for its end. Once; throws what the work threw.
  void take() { done_.get(); }

 private:
  std::atomic<bool> stops_{false};
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::future<void> done_;
};

}  // namespace brume::viewer
