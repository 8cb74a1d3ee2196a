#include "tests/cli/run_program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace brume::cli {
namespace {

ProgramCall g_call = nullptr;

std::string read_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void send_to(int descriptor, const std::filesystem::path& file) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (opened < 0 || ::dup2(opened, descriptor) < 0) ::_exit(126);
}

bool is_traced(const RunOptions& options) {
  return options.signal_at > 0 || options.signal_before_call;
}

// Runs in the child process; replaces it with the program.
[[noreturn]] void become(const std::filesystem::path& folder, std::vector<std::string> arguments,
                         const RunOptions& options, const std::filesystem::path& out,
                         const std::filesystem::path& error) {
  send_to(STDOUT_FILENO, out);
  send_to(STDERR_FILENO, error);
  for (const auto& [name, value] : options.environment) ::setenv(name.c_str(), value.c_str(), 1);
  if (options.file_bytes > 0) {
    ::signal(SIGXFSZ, SIG_DFL);  // As a shell starts programs; the program must ignore it itself.
    const rlimit limit{options.file_bytes, options.file_bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (is_traced(options)) ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
  const std::string program = options.program.empty() ? BRUME_PROGRAM : options.program;
  arguments.insert(arguments.begin(), program);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  if (options.close_standard_descriptors)
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::close(descriptor);
  if (::chdir(folder.c_str()) == 0) ::execv(program.c_str(), pointers.data());
  ::_exit(127);
}

// Whether the system call that the traced thread is about to make changes files.
bool changes_files(const __ptrace_syscall_info& call) {
  const auto number = static_cast<long>(call.entry.nr);
  if (number == SYS_openat) return (call.entry.args[2] & (O_WRONLY | O_RDWR)) != 0;
  constexpr long kCalls[] = {
      SYS_write,  SYS_sendto, SYS_fsync, SYS_fchmod, SYS_linkat, SYS_renameat, SYS_unlinkat,
#ifdef SYS_rename
      SYS_rename, SYS_unlink,
#endif
  };
  return std::find(std::begin(kCalls), std::end(kCalls), number) != std::end(kCalls);
}

// Runs a child that called PTRACE_TRACEME, and signals it before its call number `signal_at`, or before the
// first one at which `signal_when` holds. Its other threads and its children run freely. Returns the exit
// status.
int trace(pid_t child, const RunOptions& options, std::uint64_t& calls) {
  int status = 0;
  ::waitpid(child, &status, 0);  // Its exec.
  ::ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL);
  int deliver = 0;
  for (bool signalled = false;;) {
    ::ptrace(signalled ? PTRACE_CONT : PTRACE_SYSCALL, child, nullptr, deliver);
    if (::waitpid(child, &status, 0) < 0 || !WIFSTOPPED(status)) return status;
    deliver = WSTOPSIG(status);
    if (deliver != (SIGTRAP | 0x80)) continue;  // A signal: passed on.
    deliver = 0;
    __ptrace_syscall_info call{};
    ::ptrace(PTRACE_GET_SYSCALL_INFO, child, sizeof call, &call);
    if (call.op != PTRACE_SYSCALL_INFO_ENTRY || !changes_files(call)) continue;
    ++calls;
    if (options.signal_before_call ? !options.signal_when() : calls != options.signal_at) continue;
    // To the main thread: another one could handle it later, while this one goes on.
    ::tgkill(child, child, options.signal);
    signalled = true;
  }
}

// Waits until a child ends, or `holds`; whether it ended. One that hangs is killed.
bool ends_before(pid_t child, const std::function<bool()>& holds, int& status, rusage& usage) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::minutes kHang(10);
  constexpr useconds_t kPollMicroseconds = 2000;
  for (const auto end = Clock::now() + kHang; Clock::now() < end; ::usleep(kPollMicroseconds)) {
    if (::wait4(child, &status, WNOHANG, &usage) == child) return true;
    if (holds()) return false;
  }
  ADD_FAILURE() << "the program hangs";
  ::kill(child, SIGKILL);
  ::wait4(child, &status, 0, &usage);
  return true;
}

// Checks and removes the error in the new file of --json, if there is one.
void take_json_error(const WorkFolder& folder, const std::vector<std::string>& arguments, int exit_code) {
  const auto option = std::find(arguments.begin(), arguments.end(), "--json");
  if (option == arguments.end() || option + 1 == arguments.end()) return;
  const auto file = folder.path() / option[1];
  if (!std::filesystem::is_regular_file(file)) return;
  const std::string text = read_text(file);
  if (text.find("\"error\": {") == std::string::npos) return;
  EXPECT_NE(text.find("\"code\": " + std::to_string(exit_code)), std::string::npos) << text;
  std::filesystem::remove(file);
}

Outcome start_brume(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                    const RunOptions& options) {
  const auto said = fresh_folder();
  const std::filesystem::path out =
      options.out_file.empty() ? said / "out" : std::filesystem::path(options.out_file);
  const std::filesystem::path error =
      options.error_file.empty() ? said / "error" : std::filesystem::path(options.error_file);
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) become(folder, arguments, options, out, error);
  Outcome run;
  int status = 0;
  rusage usage{};
  if (is_traced(options)) {
    status = trace(child, options, run.file_calls);
  } else if (options.signal == 0) {
    ::wait4(child, &status, 0, &usage);
  } else if (!ends_before(child, options.signal_when, status, usage)) {
    ::kill(child, options.signal);
    ends_before(
        child, [] { return false; }, status, usage);
  }
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  run.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  if (options.out_file.empty()) run.out = read_text(out);
  run.error = read_text(error);
  std::filesystem::remove_all(said);
  return run;
}

}  // namespace

bool reports_job(const std::filesystem::path& file, const std::string& name) {
  return read_text(file).find("{\"progress\": {\"name\": \"" + name + "\"") != std::string::npos;
}

void set_program_call(ProgramCall call) {
  g_call = call;
}

Outcome run_brume(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                  const RunOptions& options) {
  if (g_call != nullptr && !options.need_process()) return g_call(folder, arguments);
  return start_brume(folder, arguments, options);
}

void expect_failure(const WorkFolder& folder, const std::vector<std::string>& arguments, int exit_code,
                    const std::vector<std::string>& parts, const RunOptions& options) {
  SCOPED_TRACE(testing::PrintToString(arguments));
  const auto before = folder.files();
  const Outcome run = run_brume(folder.path(), arguments, options);
  EXPECT_EQ(run.exit_code, exit_code) << run.error;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(std::count(run.error.begin(), run.error.end(), '\n'), 1) << run.error;
  EXPECT_EQ(run.error.rfind("brume: ", 0), 0u) << run.error;
  EXPECT_EQ(run.error.rfind("brume: warning", 0), std::string::npos) << run.error;
  for (const std::string& part : parts) EXPECT_NE(run.error.find(part), std::string::npos) << run.error;
  take_json_error(folder, arguments, exit_code);
  EXPECT_EQ(folder.files(), before);
}

std::string room_obj() {
  std::string text;
  int first = 1;
  const std::array<std::array<int, 4>, 6> faces{
      {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};
  const auto box = [&](std::array<double, 3> low, std::array<double, 3> high) {
    for (int corner = 0; corner < 8; ++corner) {
      text += "v";
      for (unsigned axis = 0; axis < 3; ++axis) {
        text += ' ';
        text += std::to_string(corner >> axis & 1 ? high[axis] : low[axis]);
      }
      text += "\n";
    }
    for (const auto& face : faces) {
      text += "f";
      for (const int corner : face) {
        text += ' ';
        text += std::to_string(first + corner);
      }
      text += "\n";
    }
    first += 8;
  };
  box({-2, 0, -2}, {2, 3, 2});
  box({0.6, 0, 0.6}, {1.4, 0.9, 1.3});
  return text;
}

}  // namespace brume::cli
