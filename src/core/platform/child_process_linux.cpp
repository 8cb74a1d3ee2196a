#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "core/error.hpp"
#include "core/platform/child_process.hpp"

namespace brume::platform {
namespace {

// In the child: puts `from`, or /dev/null, in the place of a standard descriptor.
bool redirect(int from, int to, int mode) {
  if (from < 0) from = ::open("/dev/null", mode | O_CLOEXEC);
  return from >= 0 && ::dup2(from, to) >= 0;
}

}  // namespace

std::optional<ChildStream> make_child_input() {
  // A socket pair instead of a pipe: MSG_NOSIGNAL avoids SIGPIPE when the child ends early.
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return std::nullopt;
  return ChildStream{Descriptor(ends[0]), Descriptor(ends[1])};
}

std::optional<ChildStream> make_child_output() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  return ChildStream{Descriptor(ends[0]), Descriptor(ends[1])};
}

std::ptrdiff_t send_some(int descriptor, std::span<const std::byte> bytes) {
  ssize_t put = 0;
  do put = ::send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  while (put < 0 && errno == EINTR);
  return put;
}

bool wait_readable(int descriptor, int milliseconds) {
  pollfd waiting{descriptor, POLLIN, 0};
  return ::poll(&waiting, 1, milliseconds) > 0;
}

ChildProcess::~ChildProcess() {
  if (!running()) return;
  kill();
  wait();
}

// Not posix_spawn, which cannot tie the child's life to ours.
int ChildProcess::start(const std::vector<std::string>& arguments, const Streams& streams) {
  BRUME_ASSERT(!running() && !arguments.empty(), "");
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  messages_ = Descriptor(::memfd_create("messages", MFD_CLOEXEC));
  std::array<int, 2> ends{};  // The child's errno; closed without one by a successful exec.
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return errno;
  const Descriptor failed(ends[0]);
  Descriptor report(ends[1]);

  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ < 0) return errno;
  if (process_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // It was gone before prctl.
    ::setpgid(0, 0);                        // Ctrl-C reaches only us, and we stop it.
    const bool ready = redirect(streams.input, STDIN_FILENO, O_RDONLY) &&
                       redirect(streams.output, STDOUT_FILENO, O_WRONLY) &&
                       redirect(messages_.get(), STDERR_FILENO, O_WRONLY) &&
                       (streams.inherited < 0 || ::fcntl(streams.inherited, F_SETFD, 0) == 0);
    if (ready) ::execvp(pointers[0], pointers.data());
    const int error = errno;
    (void)!::write(report.get(), &error, sizeof error);
    ::_exit(127);
  }

  report.close();
  int error = 0;
  ssize_t got = 0;
  do got = ::read(failed.get(), &error, sizeof error);
  while (got < 0 && errno == EINTR);
  if (got <= 0) return 0;
  wait();
  return error;
}

void ChildProcess::kill() {
  if (running()) ::kill(static_cast<pid_t>(process_), SIGKILL);
}

ChildEnd ChildProcess::wait() {
  BRUME_ASSERT(running(), "");
  int status = 0;
  while (::waitpid(static_cast<pid_t>(process_), &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (!WIFSIGNALED(status)) return {ChildEnd::Cause::exited, WEXITSTATUS(status)};
  const int signal = WTERMSIG(status);
  return {signal == SIGKILL   ? ChildEnd::Cause::killed
          : signal == SIGXCPU ? ChildEnd::Cause::processor_time
          : signal == SIGXFSZ ? ChildEnd::Cause::file_size
                              : ChildEnd::Cause::crashed,
          signal};
}

std::string ChildProcess::messages() const {
  std::string text(4096, '\0');
  const off_t length = ::lseek(messages_.get(), 0, SEEK_END);
  const off_t begin = std::max<off_t>(0, length - static_cast<off_t>(text.size()));
  const ssize_t got = ::pread(messages_.get(), text.data(), text.size(), begin);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return text;
}

}  // namespace brume::platform
