#include "apps/cli/console.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>

#include "apps/cli/json.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/log.hpp"

namespace brume::cli {
namespace {

std::atomic<int> g_signal{0};
std::atomic<bool> g_quiet{false};
std::atomic<bool> g_line_shown{false};  // The cursor is on a progress line.

extern "C" void on_signal(int signal) {
  g_signal = signal;
}

// Overwrites the current line; the padding erases the rest of a longer one.
void show_line(const std::string& line) {
  std::fprintf(stderr, "\r%-79s", line.c_str());
  std::fflush(stderr);
  g_line_shown = true;
}

void end_line() {
  if (g_line_shown.exchange(false)) std::fputc('\n', stderr);
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

}  // namespace

void reserve_standard_descriptors() {
  // The other direction: reading from standard input and writing to the others still fails. open() takes the
  // lowest free number, which is the closed one.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(descriptor, F_GETFD) < 0)
      (void)!::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void start_console(bool quiet) {
  g_quiet = quiet;
  set_log_callback([quiet](LogLevel level, const std::string& line) {
    if (quiet || level != LogLevel::warning) return;
    end_line();
    std::fprintf(stderr, "brume: warning: %s\n", one_line(line).c_str());
  });
  struct sigaction action {
  }, old{};
  action.sa_handler = on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM, SIGXCPU}) ::sigaction(signal, &action, nullptr);
  ::sigaction(SIGHUP, nullptr, &old);
  if (old.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);
  ::signal(SIGXFSZ, SIG_IGN);
}

void stop_if_interrupted() {
  if (const int signal = g_signal) throw Interrupted{signal};
}

Progress::Callback progress_display() {
  using Clock = std::chrono::steady_clock;
  const bool shown = !g_quiet && ::isatty(STDERR_FILENO) == 1;
  auto last = std::make_shared<Clock::time_point>();
  return [shown, last](const Progress::State& state) {
    stop_if_interrupted();
    if (!shown) return;
    const bool ended = state.total > 0 && state.done >= state.total;
    const auto now = Clock::now();
    if (!ended && now - *last < std::chrono::milliseconds(100)) return;
    *last = now;
    show_line(progress_line(state));
    if (ended) end_line();
  };
}

void print_failure(const std::string& message) {
  end_line();
  std::fprintf(stderr, "brume: %s\n", one_line(message).c_str());
}

void print_on_terminal(const std::string& line) {
  if (g_quiet || ::isatty(STDERR_FILENO) != 1) return;
  end_line();
  std::fprintf(stderr, "%s\n", one_line(line).c_str());
}

void print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
}

void write_json(const std::string& target, const Json& object) {
  const std::string text = object.dump() + "\n";
  if (target == "-") {
    print(text);
  } else {
    write_file_atomic(target, text).value_or_throw();
  }
}

void finish_output() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  const bool full = errno == ENOSPC || errno == EDQUOT || errno == EFBIG;
  throw Error(ErrorCode::resource_limit,
              std::string("standard output: cannot write: ") + std::strerror(errno) +
                  (full ? "; free some space" : "; redirect it to a file or a program"));
}

}  // namespace brume::cli
