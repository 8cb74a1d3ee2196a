// What the library logs while a test runs.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/log.hpp"

namespace brume {

/// The lines of a level, or above it, that are logged while it lives.
class LogLines {
 public:
  explicit LogLines(LogLevel least = LogLevel::info) {
    set_log_callback([this, least](LogLevel level, const std::string& line) {
      if (level >= least) lines.push_back(line);
    });
  }
  LogLines(const LogLines&) = delete;
  ~LogLines() { set_log_callback({}); }
  bool has(const std::string& part) const {
    return std::ranges::any_of(lines, [&](const std::string& line) { return line.find(part) != line.npos; });
  }
  std::vector<std::string> lines;
};

}  // namespace brume
