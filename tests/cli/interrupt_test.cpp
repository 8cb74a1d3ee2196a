// A signal ends every command soon, also where nothing tests for signals, and progress is shown on terminals.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

using Arguments = std::vector<std::string>;

// A smoke of eight million voxels: its flood alone takes seconds.
constexpr const char* kHugeSmoke =
    "version = 1\nscene = \"room.obj\"\nduration = 1.0\n"
    "[grid]\nvoxel = 0.1\nsize = [512, 256, 512]\norigin = [-25.6, 0.0, -25.6]\n[smoke]\nvoxels = 8388608\n"
    "[[event]]\ntype = \"smoke\"\ntime = 0.0\nfrom = [5.0, 1.0, 5.0]\nat = [5.0, 1.0, 5.0]\n";

// The CPU seconds that the only child of this process has used.
double cpu_of_child() {
  std::ifstream children("/proc/self/task/" + std::to_string(::gettid()) + "/children");
  std::string child;
  if (!(children >> child)) return 0;
  std::string stat;
  std::getline(std::ifstream("/proc/" + child + "/stat"), stat);
  std::istringstream fields(stat.substr(stat.rfind(')') + 1));
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

class Interrupt : public testing::Test {
 protected:
  Interrupt() {
    folder_.write("room.obj", room_obj());
    folder_.write("huge.toml", kHugeSmoke);
  }
  WorkFolder folder_;
};

TEST_F(Interrupt, EndsAComputationThatTestsForNoSignal) {
  for (const Arguments& arguments : {Arguments{"sim", "huge.toml"},
                                     {"info", "huge.toml", "--json", "-"},
                                     {"render", "huge.toml", "-o", "a.png", "--size", "16x16"}}) {
    constexpr double kStarted = 0.4;
    RunOptions options;
    options.signal = SIGINT;
    options.signal_when = [] { return cpu_of_child() > kStarted; };
    const Outcome run = run_brume(folder_.path(), arguments, options);
    EXPECT_EQ(run.exit_code, 128 + SIGINT) << run.error;
    EXPECT_EQ(run.error, "brume: interrupted\n");
    // 0.5 s of patience on all cores, and what a busy machine adds to it.
    EXPECT_LT(run.cpu_seconds, kStarted + 4) << arguments[0];
    EXPECT_EQ(run.out.find("\"error\"") != std::string::npos, arguments[0] == "info") << run.out;
  }
  EXPECT_EQ(folder_.files(), (Arguments{"huge.toml", "room.obj"}));
}

// Runs the program with standard error on a terminal of this width until the terminal shows `text`; returns
// what it showed.
std::string shown_on_terminal(const std::filesystem::path& folder, Arguments arguments, unsigned short width,
                              const std::string& text) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  EXPECT_EQ(::grantpt(terminal) | ::unlockpt(terminal), 0);
  const std::string name = ::ptsname(terminal);
  const int program_end = ::open(name.c_str(), O_RDWR | O_NOCTTY);
  const winsize size{24, width, 0, 0};
  ::ioctl(terminal, TIOCSWINSZ, &size);
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(program_end, STDERR_FILENO);
    arguments.insert(arguments.begin(), BRUME_PROGRAM);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    if (::chdir(folder.c_str()) == 0) ::execv(BRUME_PROGRAM, pointers.data());
    ::_exit(127);
  }
  std::string shown;
  constexpr int kWaitMilliseconds = 120'000;  // only against a test that hangs
  for (pollfd ready{terminal, POLLIN, 0}; shown.find(text) == std::string::npos;) {
    if (::poll(&ready, 1, kWaitMilliseconds) <= 0) break;
    char buffer[512];
    const ssize_t got = ::read(terminal, buffer, sizeof buffer);
    if (got <= 0) break;
    shown.append(buffer, static_cast<std::size_t>(got));
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(program_end);
  ::close(terminal);
  return shown;
}

TEST_F(Interrupt, LongJobsShowProgressAsWideAsTheTerminal) {
  for (const unsigned short width : {std::uint16_t{70}, std::uint16_t{120}}) {
    const std::string shown = shown_on_terminal(folder_.path(), {"sim", "huge.toml"}, width, "s left");
    EXPECT_NE(shown.find("flood "), std::string::npos) << shown;
    // A line begins with a carriage return; the last column stays free.
    const std::size_t begin = shown.rfind('\r', shown.find("s left"));
    ASSERT_NE(begin, std::string::npos) << shown;
    EXPECT_EQ(shown.find("left", begin) + 4 - (begin + 1), width - 1u) << shown;
  }
}

TEST_F(Interrupt, LongJobsReportProgressAsJsonToPipes) {
  // The shell writes its process, which becomes the program, so that it can be ended.
  const std::string command = "cd '" + folder_.path().string() +
                              "' && echo $$ && exec '" BRUME_PROGRAM "' sim huge.toml --progress json 2>&1";
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::vector<std::string> lines;
  for (char line[512]; lines.size() < 3 && std::fgets(line, sizeof line, pipe) != nullptr;)
    lines.emplace_back(line);
  if (!lines.empty()) ::kill(static_cast<pid_t>(std::stol(lines[0])), SIGKILL);
  ::pclose(pipe);
  ASSERT_EQ(lines.size(), 3u);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto report = nlohmann::json::parse(lines[i]).at("progress");
    EXPECT_TRUE(report.at("name").is_string());
    EXPECT_GE(report.at("rate"), 0);
    for (const char* key : {"total", "seconds_left"})
      EXPECT_TRUE(report.at(key).is_null() || report.at(key) >= 0) << lines[i];
  }
}

}  // namespace
}  // namespace brume::cli
