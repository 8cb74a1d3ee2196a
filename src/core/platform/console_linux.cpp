#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>
#include <utility>

#include "core/platform/console.hpp"

namespace brume::platform {

std::vector<std::string> command_line(int count, char** words) {
  return {words, words + count};
}

bool is_terminal(int descriptor) {
  return ::isatty(descriptor) == 1;
}

std::size_t terminal_columns(int descriptor) {
  winsize size{};
  return ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

bool shows_escape_sequences(int descriptor) {
  const char* const terminal = std::getenv("TERM");
  return is_terminal(descriptor) && terminal != nullptr && std::string_view(terminal) != "dumb";
}

// The other direction: reading from standard input and writing to the others still fails. open() takes the
// lowest free number, which is the closed one.
void prepare_standard_descriptors() {
  for (const int descriptor : {kInput, kOutput, kErrors})
    if (::fcntl(descriptor, F_GETFD) < 0)
      (void)!::open("/dev/null", descriptor == kInput ? O_WRONLY : O_RDONLY);
}

void catch_stops(void (*on_signal)(int)) {
  struct sigaction action {
  }, old{};
  action.sa_handler = on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM, SIGXCPU}) ::sigaction(signal, &action, nullptr);
  ::sigaction(SIGHUP, nullptr, &old);
  if (old.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);
  ::signal(SIGXFSZ, SIG_IGN);
}

std::thread start_without_signals(std::function<void()> run) {
  sigset_t all, old;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &old);
  std::thread thread(std::move(run));
  ::pthread_sigmask(SIG_SETMASK, &old, nullptr);
  return thread;
}

}  // namespace brume::platform
