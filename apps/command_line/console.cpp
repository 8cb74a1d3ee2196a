#include "apps/command_line/console.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>

#include "apps/command_line/json.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/log.hpp"
#include "core/platform/console.hpp"
#include "core/platform/files.hpp"
#include "core/progress.hpp"
#include "core/utf8.hpp"

namespace brume::cli {

struct Console::State {
  std::atomic<bool> quiet{false};
  std::atomic<ProgressForm> progress{ProgressForm::line};
  std::mutex line_mutex;        // guards standard error
  std::size_t line_length = 0;  // length of the progress line that the cursor is on; 0: none
  std::atomic<bool> ending{false};
  std::string command, json_target;  // set before the command runs
  std::atomic<bool> json_written{false};
};

namespace {

using Clock = std::chrono::steady_clock;

/// Version of the JSON objects: docs/reference/command-line.md.
constexpr int kJsonSchema = 1;
constexpr std::size_t kDefaultWidth = 80;
/// Jobs shorter than this show no progress.
constexpr double kLongJobSeconds = 1;
constexpr std::chrono::milliseconds kJsonInterval(500);

std::atomic<int> g_signal{0};  // what the run received; handlers reach nothing else
Console::State* g_console = nullptr;

extern "C" void on_signal(int signal) {
  g_signal = signal;
}

bool shows_progress() {
  return !g_console->quiet && platform::is_terminal(platform::kErrors);
}

// Overwrites the current line; blanks erase the rest of a longer one. The last column stays free: a cursor
// beyond it would move to the next line.
void show_line() {
  const std::lock_guard lock(g_console->line_mutex);
  std::size_t& shown = g_console->line_length;
  const std::size_t width = terminal_width(platform::kErrors) - 1;
  std::string line;
  if (const auto job = progress_to_show(kLongJobSeconds)) line = progress_line(*job, width);
  if (line.empty() && shown == 0) return;
  const std::size_t blanks = std::min(width, shown) - std::min({width, shown, line.size()});
  std::fprintf(stderr, "\r%s%s", line.c_str(), std::string(blanks, ' ').c_str());
  if (line.empty()) std::fputc('\r', stderr);
  std::fflush(stderr);
  shown = line.size();
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

// Below any progress line.
void print_to_error(const std::string& line) {
  const std::lock_guard lock(g_console->line_mutex);
  std::fprintf(stderr, "%s%s\n", g_console->line_length > 0 ? "\n" : "", one_line(line).c_str());
  g_console->line_length = 0;
}

// Jobs that are shorter than the interval show no progress.
void print_progress_json() {
  const auto job = progress_to_show(std::chrono::duration<double>(kJsonInterval).count());
  if (job) print_to_error(progress_json(*job));
}

const char* kind_of(int code) {
  switch (static_cast<ErrorCode>(code)) {
    case ErrorCode::internal:
      return "internal";
    case ErrorCode::usage:
      return "usage";
    case ErrorCode::bad_input:
      return "bad_input";
    case ErrorCode::resource_limit:
      return "resource_limit";
    case ErrorCode::no_device:
      return "missing";
    case ErrorCode::partial:
      return "partial";
    case ErrorCode::comparison_failed:
      return "comparison_failed";
  }
  return "interrupted";
}

std::string json_text(const Json& object) {
  Json whole{{"schema", kJsonSchema}, {"command", g_console->command}};
  whole.update(object);
  return whole.dump() + "\n";
}

}  // namespace

std::size_t terminal_width(int descriptor) {
  const std::size_t columns = platform::terminal_columns(descriptor);
  return columns > 0 ? columns : kDefaultWidth;
}

Console::Console() : state_(std::make_unique<State>()) {
  BRUME_ASSERT(!g_console, "two runs at a time");
  g_console = state_.get();
  g_signal = 0;
  std::clearerr(stdout);  // another run may have left its faults
}

Console::~Console() {
  set_log_callback(nullptr);
  g_console = nullptr;
}

void start_console(bool quiet, ProgressForm progress) {
  g_console->quiet = quiet;
  g_console->progress = progress;
  set_log_callback([quiet](LogLevel level, const std::string& line) {
    if (!quiet && level == LogLevel::warning) print_to_error("brume: warning: " + line);
  });
  platform::catch_stops(on_signal);
}

struct Attendant::Thread {
  Thread(const std::atomic<double>& seconds, std::function<int(int)> end)
      : grace_seconds(seconds), end_of(std::move(end)) {}

  const std::atomic<double>& grace_seconds;
  std::function<int(int)> end_of;
  std::mutex mutex;
  std::condition_variable wake;
  bool done = false;
  Clock::time_point reported = Clock::now();  // as JSON
  std::thread thread;

  void report_progress() {
    if (g_console->progress != ProgressForm::json) {
      if (shows_progress()) show_line();
    } else if (const auto now = Clock::now(); now - reported >= kJsonInterval) {
      reported = now;
      print_progress_json();
    }
  }

  void run() {
    constexpr std::chrono::milliseconds kInterval(100);
    std::optional<Clock::time_point> signalled;
    std::unique_lock lock(mutex);
    while (!wake.wait_for(lock, kInterval, [&] { return done; })) {
      report_progress();
      const int signal = g_signal;
      if (signal == 0) continue;
      const auto now = Clock::now();
      if (!signalled) signalled = now;
      if (now - *signalled < std::chrono::duration<double>(grace_seconds)) continue;
      if (g_console->ending.exchange(true)) return;  // The command is reporting its own end.
      std::_Exit(end_of(signal));
    }
  }
};

Attendant::Attendant(const std::atomic<double>& grace_seconds, std::function<int(int signal)> end_of)
    : thread_(new Thread(grace_seconds, std::move(end_of))) {
  // Signals interrupt the system calls of the main thread, not of this one.
  thread_->thread = platform::start_without_signals([thread = thread_] { thread->run(); });
}

Attendant::~Attendant() {
  {
    const std::lock_guard lock(thread_->mutex);
    thread_->done = true;
  }
  thread_->wake.notify_one();
  thread_->thread.join();
  delete thread_;
}

void claim_end() {
  if (!g_console->ending.exchange(true)) return;
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

bool is_interrupted() {
  return g_signal != 0;
}

void stop_if_interrupted() {
  if (const int signal = g_signal) throw Interrupted{signal};
}

void print_failure(const std::string& message) {
  print_to_error("brume: " + message);
}

void print_note(const std::string& line) {
  if (!g_console->quiet) print_to_error("brume: " + line);
}

void print_on_terminal(const std::string& line) {
  if (shows_progress()) print_to_error(line);
}

void print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
}

void set_json(const std::string& command, const std::string& target) {
  g_console->command = command;
  g_console->json_target = target;
}

void write_json(const std::string& target, const Json& object) {
  const std::string text = json_text(object);
  if (target == "-") {
    g_console->json_written = true;
    print(text);
  } else {
    write_file_atomic(to_path(target), text).value_or_throw();
    g_console->json_written = true;
  }
}

void write_json_error(int code, const std::string& message, bool may_write_file) {
  if (g_console->json_target.empty() || g_console->json_written) return;
  const std::string text =
      json_text({{"error", {{"code", code}, {"kind", kind_of(code)}, {"message", message}}}});
  if (g_console->json_target == "-") {
    print(text);
    std::fflush(stdout);
  } else if (may_write_file) {
    (void)write_file_atomic(to_path(g_console->json_target), text);
  }
}

void finish_output() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  const bool full = platform::is_full(errno);
  throw Error(ErrorCode::resource_limit,
              std::string("standard output: cannot write: ") + std::strerror(errno) +
                  (full ? "; free some space" : "; redirect it to a file or a program"));
}

}  // namespace brume::cli
