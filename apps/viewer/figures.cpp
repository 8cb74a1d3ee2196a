#include "apps/viewer/figures.hpp"

#include <malloc.h>

#include <algorithm>

#include "core/platform/machine.hpp"

namespace brume::viewer {
namespace {

double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void Figures::add(FrameFigures frame) {
  for (const auto& pass : frame.passes)
    if (std::find(pass_names_.begin(), pass_names_.end(), pass.name) == pass_names_.end())
      pass_names_.emplace_back(pass.name);
  frames_.push_back(std::move(frame));
  if (frames_.size() > kHistory) frames_.pop_front();
  ++count_;
}

double Figures::median(double FrameFigures::*member) const {
  std::vector<double> values;
  for (const FrameFigures& frame : frames_) values.push_back(frame.*member);
  return median_of(std::move(values));
}

double Figures::pass_median(const std::string& name) const {
  std::vector<double> values;
  for (const FrameFigures& frame : frames_)
    for (const auto& pass : frame.passes)
      if (pass.name == name) values.push_back(pass.milliseconds);
  return median_of(std::move(values));
}

double Figures::frames_per_second() const {
  const double milliseconds = median(&FrameFigures::frame_ms);
  return milliseconds > 0 ? 1000 / milliseconds : 0;
}

std::uint64_t resident_bytes() {
  return platform::memory_use().resident;
}

std::uint64_t heap_bytes() {
#ifdef __GLIBC__
  const struct mallinfo2 heap = ::mallinfo2();
  return heap.uordblks + heap.hblkhd;
#else
  return 0;
#endif
}

std::uint64_t mapped_bytes() {
#ifdef __GLIBC__
  const struct mallinfo2 heap = ::mallinfo2();
  const std::uint64_t of_malloc = heap.arena + heap.hblkhd, all = platform::memory_use().data;
  return all > of_malloc ? all - of_malloc : 0;
#else
  return 0;
#endif
}

}  // namespace brume::viewer
