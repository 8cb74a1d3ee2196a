// The library's log output: a callback that the program installs. Silent until then.
#pragma once

#include <functional>
#include <string>

namespace brume {

enum class LogLevel { info, warning };

using LogCallback = std::function<void(LogLevel, const std::string&)>;

/// Installs the callback that receives every line; an empty one silences the library. It may be called from
/// any thread, one call at a time.
void set_log_callback(LogCallback callback);

void log_info(const std::string& line);
void log_warning(const std::string& line);

}  // namespace brume
