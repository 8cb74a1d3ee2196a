// The library's log output: a callback that the program installs, or a sink of a thread's own. Silent
// without.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace brume {

enum class LogLevel { info, warning };

using LogCallback = std::function<void(LogLevel, const std::string&)>;

/// Installs the callback that receives every line; an empty one silences the library. It may be called from
/// any thread, one call at a time.
void set_log_callback(LogCallback callback);

/// Receives the lines of threads in the place of the callback.
class LogSink {
 public:
  virtual ~LogSink() = default;
  virtual void write(LogLevel level, const std::string& line) = 0;
  /// What receives the lines of threads that outlive the scope, by several at a time.
  virtual std::shared_ptr<LogSink> of_threads() = 0;
};

/// While it lives, the lines of this thread go to the sink, which must outlive it; null: to the callback.
class LogScope {
 public:
  explicit LogScope(LogSink* sink);
  LogScope(const LogScope&) = delete;
  ~LogScope();

 private:
  LogSink* before_;
};

/// For a thread that this one starts: LogSink::of_threads of its scope; null without one.
std::shared_ptr<LogSink> log_of_threads();

void log_info(const std::string& line);
void log_warning(const std::string& line);

}  // namespace brume
