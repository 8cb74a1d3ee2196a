// Performance figures of the viewer: for the overlay, the graph and the report.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "gpu/timings.hpp"

namespace brume::viewer {

/// Measurements of one frame.
struct FrameFigures {
  double frame_ms = 0;    ///< Since the previous frame began.
  double tick_ms = 0;     ///< CPU time of the simulation.
  double work_ms = 0;     ///< CPU and GPU time together, without waiting for vertical sync.
  double latency_ms = 0;  ///< From reading the input to the finished image.
  std::vector<gpu::Timings::Scope> passes;
};

/// The last kHistory frames and their medians.
class Figures {
 public:
  static constexpr std::size_t kHistory = 240;

  void add(FrameFigures frame);
  const std::deque<FrameFigures>& frames() const { return frames_; }
  std::uint64_t count() const { return count_; }  ///< Number of frames so far.
  /// Median over the history; 0 without frames.
  double median(double FrameFigures::*member) const;
  double frames_per_second() const;
  /// Median GPU time of a pass over the frames in which it ran [ms].
  double pass_median(const std::string& name) const;
  /// Names of all passes that ran so far, in frame order.
  const std::vector<std::string>& pass_names() const { return pass_names_; }

 private:
  std::deque<FrameFigures> frames_;
  std::uint64_t count_ = 0;
  std::vector<std::string> pass_names_;
};

/// Resident memory of the process [bytes]; 0 if the system does not report it.
std::uint64_t resident_bytes();

/// Heap memory that is allocated and not freed [bytes]; 0 if the C library does not report it. Unlike
/// resident_bytes it does not grow with fragmentation or when pages are first touched.
std::uint64_t heap_bytes();

/// Writable private memory mapped by others than malloc, such as drivers, compilers of shaders and thread
/// stacks [bytes]; 0 if the system does not report it. Like heap_bytes it counts pages before they are
/// touched.
std::uint64_t mapped_bytes();

}  // namespace brume::viewer
