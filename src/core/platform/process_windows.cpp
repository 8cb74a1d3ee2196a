#include <process.h>
#include <windows.h>

#include "core/platform/process.hpp"
#include "core/platform/utf16.hpp"

namespace brume::platform {
namespace {

/// The length of the longest path.
constexpr DWORD kMostPath = 32768;

}  // namespace

int process_id() {
  return ::_getpid();
}

bool is_running(int process) {
  const HANDLE opened = ::OpenProcess(SYNCHRONIZE, FALSE, static_cast<DWORD>(process));
  if (!opened) return ::GetLastError() == ERROR_ACCESS_DENIED;
  const bool running = ::WaitForSingleObject(opened, 0) == WAIT_TIMEOUT;
  ::CloseHandle(opened);
  return running;
}

std::filesystem::path program_file() {
  std::wstring path(kMostPath, 0);
  path.resize(::GetModuleFileNameW(nullptr, path.data(), kMostPath));
  return path;
}

std::filesystem::path program_image() {
  return program_file();
}

std::string program_name(const std::string& name) {
  return name + ".exe";
}

std::string environment(const char* name) {
  std::wstring value(kMostPath, 0);
  value.resize(::GetEnvironmentVariableW(to_utf16(name).c_str(), value.data(), kMostPath));
  return to_utf8(value);
}

}  // namespace brume::platform
