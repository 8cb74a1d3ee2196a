#include "core/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace brume {

double Progress::State::seconds_left() const {
  if (total == 0 || done == 0 || seconds <= 0) return -1;
  return static_cast<double>(total - std::min(done, total)) / rate();
}

Progress::Progress(std::string name, std::uint64_t total, Callback callback)
    : state_{std::move(name), 0, total, 0},
      callback_(std::move(callback)),
      start_(std::chrono::steady_clock::now()) {
  if (callback_) callback_(state_);
}

void Progress::advance(std::uint64_t count) {
  state_.done += count;
  state_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (callback_) callback_(state_);
}

std::string progress_line(const Progress::State& state) {
  constexpr std::uint64_t kWidth = 24;
  const std::uint64_t filled = state.total > 0 ? std::min(state.done, state.total) * kWidth / state.total : 0;
  const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
  char text[160];
  std::snprintf(text, sizeof text, "%-10.10s [%s] %llu/%llu  %.3g/s", state.name.c_str(), bar.c_str(),
                static_cast<unsigned long long>(state.done), static_cast<unsigned long long>(state.total),
                state.rate());
  std::string line = text;
  if (const double left = state.seconds_left(); left >= 0) {
    std::snprintf(text, sizeof text, "  %.0f s left", left);
    line += text;
  }
  return line.substr(0, 79);
}

}  // namespace brume
