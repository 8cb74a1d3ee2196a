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

thread_local LogSink* t_sink = nullptr;

void log_line(LogLevel level, const std::string& line) {
  if (t_sink) return t_sink->write(level, line);
  const std::lock_guard lock(sink().mutex);
  if (sink().callback) sink().callback(level, line);
}

}  // namespace

void set_log_callback(LogCallback callback) {
  const std::lock_guard lock(sink().mutex);
  sink().callback = std::move(callback);
}

LogScope::LogScope(LogSink* sink) : before_(std::exchange(t_sink, sink)) {}
LogScope::~LogScope() {
  t_sink = before_;
}

std::shared_ptr<LogSink> log_of_threads() {
  return t_sink ? t_sink->of_threads() : nullptr;
}

void log_info(const std::string& line) {
  log_line(LogLevel::info, line);
}
void log_warning(const std::string& line) {
  log_line(LogLevel::warning, line);
}

}  // namespace brume
