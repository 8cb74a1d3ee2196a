// Elapsed time, and the time of all threads of the process.
#pragma once

#include <sys/resource.h>

#include <chrono>

namespace brume::cli {

/// Starts when it is made.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  double cpu_seconds() const { return process_seconds() - cpu_start_; }

 private:
  using Clock = std::chrono::steady_clock;
  static double process_seconds() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
  }

  Clock::time_point start_ = Clock::now();
  double cpu_start_ = process_seconds();
};

}  // namespace brume::cli
