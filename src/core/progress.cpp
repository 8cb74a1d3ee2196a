#include "core/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <utility>

namespace brume {
namespace {

struct Jobs {
  std::mutex mutex;
  std::vector<const Progress*> list;  // in the order in which they began
};

// Never destroyed: jobs of other threads may outlive static objects.
Jobs& jobs() {
  static Jobs* const instance = new Jobs;
  return *instance;
}

/// Guards the details of all jobs. The list of jobs has a mutex of its own, which progress_to_show holds
/// while it reads states.
std::mutex& detail_mutex() {
  static std::mutex* const instance = new std::mutex;
  return *instance;
}

std::string time_text(double seconds) {
  char text[48];
  if (seconds < 100) {
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  } else {
    std::snprintf(text, sizeof text, "%.0f min %02d s", std::floor(seconds / 60),
                  static_cast<int>(std::fmod(seconds, 60)));
  }
  return text;
}

/// As a text of JSON.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c >= ' ' && c <= '~' ? c : '?';
  }
  return result + "\"";
}

/// Six digits; null: none.
std::string number_or_null(double value, bool is_known) {
  if (!is_known || !std::isfinite(value)) return "null";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

double Progress::State::seconds_left() const {
  if (total == 0 || done == 0 || seconds <= 0) return -1;
  return static_cast<double>(total - std::min(done, total)) / rate();
}

Progress::Progress(std::string name, std::uint64_t total)
    : name_(std::move(name)), total_(total), start_(std::chrono::steady_clock::now()) {
  const std::lock_guard lock(jobs().mutex);
  jobs().list.push_back(this);
}

Progress::~Progress() {
  const std::lock_guard lock(jobs().mutex);
  std::erase(jobs().list, this);
}

void Progress::set_detail(std::string detail) {
  const std::lock_guard lock(detail_mutex());
  detail_ = std::move(detail);
}

Progress::State Progress::state() const {
  const std::lock_guard lock(detail_mutex());
  return {name_, done_.load(std::memory_order_relaxed), total_.load(std::memory_order_relaxed),
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(), detail_};
}

std::optional<Progress::State> progress_to_show(double seconds) {
  const std::lock_guard lock(jobs().mutex);
  std::optional<Progress::State> shown;
  for (auto job = jobs().list.rbegin(); job != jobs().list.rend(); ++job) {
    Progress::State state = (*job)->state();
    if (state.seconds < seconds) continue;
    if (state.total > 0) return state;
    if (!shown) shown = std::move(state);
  }
  return shown;
}

std::string progress_json(const Progress::State& state) {
  const double left = state.seconds_left();
  return "{\"progress\": {\"name\": " + quoted(state.name) + ", \"done\": " + std::to_string(state.done) +
         ", \"total\": " + (state.total > 0 ? std::to_string(state.total) : "null") +
         ", \"rate\": " + number_or_null(state.rate(), true) +
         ", \"seconds_left\": " + number_or_null(left, left >= 0) +
         (state.detail.empty() ? "" : ", \"detail\": " + quoted(state.detail)) + "}}";
}

std::string progress_line(const Progress::State& state, std::size_t width) {
  // Texts first, so that the bar gets the room that remains.
  char text[160];
  std::snprintf(text, sizeof text, "%-10s", state.name.c_str());
  const std::string name = text;
  if (state.total == 0) return (name + " " + time_text(state.seconds)).substr(0, width);
  std::snprintf(text, sizeof text, " %llu/%llu  %.3g/s", static_cast<unsigned long long>(state.done),
                static_cast<unsigned long long>(state.total), state.rate());
  std::string numbers = text;
  if (const double left = state.seconds_left(); left >= 0) numbers += "  " + time_text(left) + " left";
  if (!state.detail.empty()) numbers += "  " + state.detail;

  constexpr std::size_t kLeastBar = 4, kFrame = 3;  // a blank and two brackets
  const std::size_t taken = name.size() + numbers.size() + kFrame;
  if (taken + kLeastBar > width) return (name + numbers).substr(0, width);
  const std::size_t room = width - taken;
  const std::size_t filled = std::min(state.done, state.total) * room / state.total;
  return name + " [" + std::string(filled, '#') + std::string(room - filled, '.') + "]" + numbers;
}

}  // namespace brume
