// In test programs with this source, run_brume calls the program's function in their own process.
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <stdexcept>

#include "apps/cli/run.hpp"
#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

/// Sends what is written to a descriptor to a file.
class Redirection {
 public:
  Redirection(int descriptor, const fs::path& file)
      : descriptor_(descriptor), before_(::fcntl(descriptor, F_DUPFD_CLOEXEC, 0)) {
    const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (before_ < 0 || opened < 0 || ::dup2(opened, descriptor) < 0)
      throw std::runtime_error(file.string() + ": cannot take the output");
    ::close(opened);
  }
  Redirection(const Redirection&) = delete;
  ~Redirection() {
    ::dup2(before_, descriptor_);
    ::close(before_);
  }

 private:
  int descriptor_, before_;
};

class WorkingFolder {
 public:
  explicit WorkingFolder(const fs::path& folder) : before_(fs::current_path()) { fs::current_path(folder); }
  WorkingFolder(const WorkingFolder&) = delete;
  ~WorkingFolder() {
    std::error_code ignored;
    fs::current_path(before_, ignored);
  }

 private:
  fs::path before_;
};

/// Gives the signals that a run handles back their handlers: a test that hangs can be interrupted.
class SignalHandlers {
 public:
  SignalHandlers() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], nullptr, &before_[i]);
  }
  SignalHandlers(const SignalHandlers&) = delete;
  ~SignalHandlers() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
  }

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGXFSZ};
  std::array<struct sigaction, kSignals.size()> before_{};
};

Outcome call(const fs::path& folder, const std::vector<std::string>& arguments) {
  const WorkFolder said;
  Outcome outcome;
  std::vector<const char*> words{"brume"};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  std::fflush(stdout);
  {
    const Redirection out(STDOUT_FILENO, said.path() / "out"), error(STDERR_FILENO, said.path() / "error");
    const WorkingFolder here(folder);
    const SignalHandlers handlers;
    outcome.exit_code = run(static_cast<int>(words.size()), words.data());
    std::fflush(stdout);
  }
  outcome.out = read_text_file(said.path() / "out").value_or_throw();
  outcome.error = read_text_file(said.path() / "error").value_or_throw();
  return outcome;
}

[[maybe_unused]] const bool kCalls = (set_program_call(call), true);

}  // namespace
}  // namespace brume::cli
