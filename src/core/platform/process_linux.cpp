#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "core/platform/process.hpp"

namespace brume::platform {

int process_id() {
  return ::getpid();
}

bool is_running(int process) {
  return ::kill(process, 0) == 0 || errno != ESRCH;
}

std::filesystem::path program_file() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored);
}

std::filesystem::path program_image() {
  return "/proc/self/exe";
}

std::string program_name(const std::string& name) {
  return name;
}

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

}  // namespace brume::platform
