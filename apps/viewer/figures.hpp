// What the window measures of itself, for the overlay, the graph and the report.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "gpu/timings.hpp"

namespace brume::viewer {

/// One frame.
struct FrameFigures {
  double frame_ms = 0;    ///< From the frame before.
  double tick_ms = 0;     ///< Of the processor, for the simulation.
  double work_ms = 0;     ///< Of processor and device together, without waiting for the screen.
  double latency_ms = 0;  ///< From reading the input to the finished picture.
  std::vector<gpu::Timings::Scope> passes;
};

class Figures {
 public:
  static constexpr std::size_t kKept = 240;

  void add(FrameFigures frame);
  const std::deque<FrameFigures>& frames() const { return frames_; }
  std::uint64_t count() const { return count_; }
  /// The middle one of the frames that are kept; 0 where there are none.
  double median(double FrameFigures::*member) const;
  double frames_per_second() const;
  /// The middle one of a pass's times, over the frames that had it [ms].
  double pass_median(const std::string& name) const;
  /// Names of all passes that were seen, in the order of a frame.
  const std::vector<std::string>& pass_names() const { return pass_names_; }

 private:
  std::deque<FrameFigures> frames_;
  std::uint64_t count_ = 0;
  std::vector<std::string> pass_names_;
};

/// Memory that the process holds [bytes]; 0 where the system does not say.
std::uint64_t resident_bytes();

/// Memory that the process has allocated and not freed [bytes], wherever it lies; 0 where the C library does
/// not say. Unlike resident_bytes it does not grow because freed memory is in pieces, or is touched for the
/// first time.
std::uint64_t heap_bytes();

}  // namespace brume::viewer
