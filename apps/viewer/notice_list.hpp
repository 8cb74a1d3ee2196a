// Recent messages of a window.
#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <vector>

namespace brume::viewer {

class NoticeList {
 public:
  static constexpr double kSeconds = 4;  ///< How long a message shows.
  static constexpr std::size_t kMost = 4;

  void add(const std::string& line);
  /// Messages that still show, the newest last.
  std::vector<std::string> recent();

 private:
  using Clock = std::chrono::steady_clock;
  struct Notice {
    std::string line;
    Clock::time_point time;
  };
  std::deque<Notice> notices_;
};

}  // namespace brume::viewer
