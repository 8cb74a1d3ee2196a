// A signal ends every command soon, also where nothing tests for signals, and progress is shown on terminals.
// The jobs here take hours or minutes on any machine: no test depends on how long one takes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

using Arguments = std::vector<std::string>;
using Clock = std::chrono::steady_clock;

// 3.5e13 rays: days of 100 cores, and little memory. Its progress advances with every 64 texels.
const Arguments kEndlessBake{"bake",   "occlusion",   "room.obj", "-o",      "a.png",
                             "--size", "128x128x128", "--rays",   "16777216"};
constexpr std::uint64_t kBakeTotal = std::uint64_t{128 * 128 * 128} * (16777216 / 4096);

// Smokes that go off in their first tick, in the middle of a voxel, so that they do not fly. A tick never
// tests for signals, and this one keeps a thread busy for minutes. Each flood is too small to report its own
// progress, so the progress of the tick is shown.
constexpr int kSmokes = 4000;
std::string many_smokes() {
  std::string text =
      "version = 1\nscene = \"room.obj\"\nduration = 1.0\n"
      "[grid]\nvoxel = 0.125\nsize = [256, 128, 256]\norigin = [-16.0, 0.0, -16.0]\n[smoke]\nvoxels = "
      "250000\n";
  for (int i = 0; i < kSmokes; ++i)
    text +=
        "[[event]]\ntype = \"smoke\"\ntime = 0.0\nfrom = [5.0625, 1.0625, 5.0625]\nat = [5.0625, 1.0625, "
        "5.0625]\n";
  return text;
}

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

std::string without_reports(const std::string& error) {
  std::istringstream lines(error);
  std::string rest;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("{\"progress\": ")) rest += line + "\n";
  return rest;
}

class Interrupt : public testing::Test {
 protected:
  Interrupt() { folder_.write("room.obj", room_obj()); }
  WorkFolder folder_;
};

TEST_F(Interrupt, EndsAComputationThatTestsForNoSignal) {
  // The grace of 0.5 s and what a busy machine adds to it, on all cores.
  const double most_cpu_seconds = 5 * static_cast<double>(::sysconf(_SC_NPROCESSORS_ONLN));
  folder_.write("many.toml", many_smokes());
  const WorkFolder reports;
  const auto ends = [&](Arguments arguments, const std::string& job) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    RunOptions options;
    options.error_file = reports.path() / arguments[0];
    options.signal = SIGINT;
    double cpu_seconds = 0;
    options.signal_when = [&] {
      cpu_seconds = cpu_of_child();
      return reports_job(options.error_file, job);
    };
    arguments.insert(arguments.end(), {"--progress", "json"});
    const Outcome run = run_brume(folder_.path(), arguments, options);
    EXPECT_TRUE(reports_job(options.error_file, job)) << run.error;
    EXPECT_EQ(run.exit_code, 128 + SIGINT) << run.error;
    EXPECT_EQ(without_reports(run.error), "brume: interrupted\n");
    EXPECT_LT(run.cpu_seconds - cpu_seconds, most_cpu_seconds);
    const bool has_json = std::ranges::find(arguments, "--json") != arguments.end();
    EXPECT_EQ(run.out.find("\"error\"") != std::string::npos, has_json) << run.out;
  };
  ends(kEndlessBake, "occlusion");
  // One thread takes more time and less memory.
  ends({"sim", "many.toml", "--threads", "1"}, "simulate");
  ends({"info", "many.toml", "--threads", "1", "--json", "-"}, "simulate");
  ends({"render", "many.toml", "--threads", "1", "-o", "a.png", "--size", "16x16"}, "simulate");
  EXPECT_EQ(folder_.files(), (Arguments{"many.toml", "room.obj"}));
}

// Two ends of a terminal or a pipe.
struct Ends {
  int ours = -1, of_program = -1;
};

Ends open_terminal(unsigned short width) {
  Ends ends{::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC), -1};
  EXPECT_EQ(::grantpt(ends.ours) | ::unlockpt(ends.ours), 0);
  ends.of_program = ::open(::ptsname(ends.ours), O_RDWR | O_NOCTTY | O_CLOEXEC);
  const winsize size{24, width, 0, 0};
  EXPECT_EQ(::ioctl(ends.ours, TIOCSWINSZ, &size), 0);
  return ends;
}

Ends open_pipe() {
  int ends[2];
  EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  return {ends[0], ends[1]};
}

// Runs the program with standard error there until what it shows is enough, or it ends; returns that.
std::string shown_until(const std::filesystem::path& folder, Arguments arguments, Ends ends,
                        const std::function<bool(const std::string&)>& is_enough) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends.of_program, STDERR_FILENO);
    arguments.insert(arguments.begin(), BRUME_PROGRAM);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    if (::chdir(folder.c_str()) == 0) ::execv(BRUME_PROGRAM, pointers.data());
    ::_exit(127);
  }
  // The program alone holds its end, so that reading ends with it.
  ::close(ends.of_program);
  std::string shown;
  constexpr std::chrono::minutes kHang(10);  // only against a test that hangs
  const auto end = Clock::now() + kHang;
  for (pollfd ready{ends.ours, POLLIN, 0}; !is_enough(shown) && Clock::now() < end;) {
    if (::poll(&ready, 1, static_cast<int>(std::chrono::milliseconds(kHang).count())) <= 0) break;
    char buffer[512];
    const ssize_t got = ::read(ends.ours, buffer, sizeof buffer);
    if (got <= 0) break;
    shown.append(buffer, static_cast<std::size_t>(got));
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(ends.ours);
  return shown;
}

TEST_F(Interrupt, LongJobsShowProgressAsWideAsTheTerminal) {
  for (const unsigned short width : {std::uint16_t{90}, std::uint16_t{120}}) {
    const std::string text = "s left";
    const std::string shown =
        shown_until(folder_.path(), kEndlessBake, open_terminal(width),
                    [&](const std::string& so_far) { return so_far.find(text) != std::string::npos; });
    EXPECT_NE(shown.find("occlusion "), std::string::npos) << shown;
    // A line begins with a carriage return; the last column stays free.
    const std::size_t begin = shown.rfind('\r', shown.find(text));
    ASSERT_NE(begin, std::string::npos) << shown;
    EXPECT_EQ(shown.find("left", begin) + 4 - (begin + 1), width - 1u) << shown;
  }
}

// The whole lines that report the bake.
std::vector<nlohmann::json> reports_of_bake(const std::string& shown) {
  std::vector<nlohmann::json> reports;
  std::istringstream lines(shown.substr(0, shown.rfind('\n') + 1));
  for (std::string line; std::getline(lines, line);) {
    const auto report = nlohmann::json::parse(line).at("progress");
    if (report.at("name") == "occlusion") reports.push_back(report);
  }
  return reports;
}

TEST_F(Interrupt, LongJobsReportProgressAsJsonToPipes) {
  Arguments arguments = kEndlessBake;
  arguments.insert(arguments.end(), {"--progress", "json"});
  const auto advances = [](const std::string& shown) {
    const auto reports = reports_of_bake(shown);
    return !reports.empty() && reports.back().at("done") > reports.front().at("done");
  };
  const std::string shown = shown_until(folder_.path(), arguments, open_pipe(), advances);
  EXPECT_TRUE(advances(shown)) << shown;
  for (const auto& report : reports_of_bake(shown)) {
    EXPECT_EQ(report.at("total"), kBakeTotal);
    EXPECT_GE(report.at("rate"), 0);
    EXPECT_EQ(report.at("seconds_left").is_null(), report.at("done") == 0) << report;
    EXPECT_TRUE(report.at("done") == 0 || report.at("seconds_left") > 0) << report;
  }
}

}  // namespace
}  // namespace brume::cli
