// Elapsed time, and the time of all threads of the process.
#pragma once

#include <chrono>

#include "core/platform/machine.hpp"

namespace brume::cli {

/// Starts when it is made.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  double cpu_seconds() const { return platform::processor_seconds() - cpu_start_; }

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point start_ = Clock::now();
  double cpu_start_ = platform::processor_seconds();
};

}  // namespace brume::cli
