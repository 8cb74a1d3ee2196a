#include "core/log.hpp"

#include <mutex>
#include <utility>

namespace brume {
namespace {

struct Sink {
  std::mutex mutex;
  LogCallback callback;
};

Sink& sink() {
  static Sink instance;
  return instance;
}

void log_line(LogLevel level, const std::string& line) {
  const std::lock_guard lock(sink().mutex);
  if (sink().callback) sink().callback(level, line);
}

}  // namespace

void set_log_callback(LogCallback callback) {
  const std::lock_guard lock(sink().mutex);
  sink().callback = std::move(callback);
}

void log_info(const std::string& line) {
  log_line(LogLevel::info, line);
}
void log_warning(const std::string& line) {
  log_line(LogLevel::warning, line);
}

}  // namespace brume
