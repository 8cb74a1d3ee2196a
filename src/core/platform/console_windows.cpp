#include <fcntl.h>
#include <io.h>
#include <windows.h>
// after windows.h
#include <shellapi.h>

#include <csignal>
#include <utility>

#include "core/platform/console.hpp"
#include "core/platform/utf16.hpp"

namespace brume::platform {
namespace {

HANDLE handle_of(int descriptor) {
  return reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));
}

}  // namespace

std::vector<std::string> command_line(int count, char** words) {
  int wide_count = 0;
  wchar_t** const wide = ::CommandLineToArgvW(::GetCommandLineW(), &wide_count);
  if (!wide) return {words, words + count};
  std::vector<std::string> result;
  for (int i = 0; i < wide_count; ++i) result.push_back(to_utf8(wide[i]));
  ::LocalFree(wide);
  return result;
}

bool is_terminal(int descriptor) {
  DWORD mode = 0;
  return ::GetConsoleMode(handle_of(descriptor), &mode) != 0;
}

std::size_t terminal_columns(int descriptor) {
  CONSOLE_SCREEN_BUFFER_INFO info;
  if (!::GetConsoleScreenBufferInfo(handle_of(descriptor), &info)) return 0;
  return static_cast<std::size_t>(info.srWindow.Right - info.srWindow.Left + 1);
}

bool shows_escape_sequences(int descriptor) {
  DWORD mode = 0;
  return ::GetConsoleMode(handle_of(descriptor), &mode) &&
         ::SetConsoleMode(handle_of(descriptor), mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

void prepare_standard_descriptors() {
  for (const int descriptor : {kInput, kOutput, kErrors}) {
    if (::_get_osfhandle(descriptor) == -1)
      (void)::_open("NUL", descriptor == kInput ? _O_WRONLY : _O_RDONLY);
    ::_setmode(descriptor, _O_BINARY);
  }
  ::SetConsoleOutputCP(CP_UTF8);
}

void catch_stops(void (*on_signal)(int)) {
  for (const int signal : {SIGINT, SIGTERM, SIGBREAK}) std::signal(signal, on_signal);
}

std::thread start_without_signals(std::function<void()> run) {
  return std::thread(std::move(run));
}

}  // namespace brume::platform
