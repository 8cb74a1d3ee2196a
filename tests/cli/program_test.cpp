// The program is its function: the same results, files and exit codes from a process as from a call, which
// the other cases rely on. Each command runs as a process here, or where it needs another desktop or
// installation.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/cli/run.hpp"
#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

using Arguments = std::vector<std::string>;

/// What a command line did.
struct Result {
  Outcome outcome;
  std::map<std::string, std::string> files;
};

/// Runs all of them, one after the other, in one folder.
std::vector<Result> results_of(const std::vector<Arguments>& calls, bool own_process) {
  const WorkFolder folder;
  folder.write("room.obj", room_obj());
  folder.write("room.toml", "version = 1\nscene = \"room.obj\"\nduration = 0.5\n");
  RunOptions options;
  options.own_process = own_process;
  std::vector<Result> results;
  for (const Arguments& arguments : calls) {
    Result& result = results.emplace_back();
    result.outcome = run_brume(folder.path(), arguments, options);
    // Keys name the program, which is this test where it is called.
    for (const std::string& name : folder.files())
      if (!name.ends_with(".key")) result.files[name] = *read_text_file(folder.path() / name);
  }
  return results;
}

/// Without the numbers, some of which are times, and the blanks between them.
std::string words_of(std::string text) {
  std::erase_if(text, [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == ' '; });
  return text;
}

/// Runs them by calls and by processes, and expects the same exit codes of both.
void expect_same(const std::vector<std::pair<Arguments, int>>& cases) {
  std::vector<Arguments> calls;
  for (const auto& [arguments, exit_code] : cases) calls.push_back(arguments);
  const std::vector<Result> called = results_of(calls, false), started = results_of(calls, true);
  for (std::size_t i = 0; i < calls.size(); ++i) {
    SCOPED_TRACE(testing::PrintToString(calls[i]));
    EXPECT_EQ(started[i].outcome.exit_code, cases[i].second) << started[i].outcome.error;
    EXPECT_EQ(called[i].outcome.exit_code, cases[i].second) << called[i].outcome.error;
    EXPECT_EQ(called[i].outcome.error, started[i].outcome.error);
    EXPECT_EQ(words_of(called[i].outcome.out), words_of(started[i].outcome.out));
    EXPECT_EQ(called[i].files, started[i].files);
  }
}

TEST(Program, EveryCommandIsThatOfACall) {
  expect_same({{{}, 0},
               {{"--version"}, 0},
               {{"help", "render"}, 0},
               {{"render", "room.obj", "-o", "a.png", "--size", "16x16"}, 0},
               {{"sim", "room.toml", "--ticks", "4", "--hash", "--record", "a.brp"}, 0},
               {{"voxelize", "room.obj", "-o", "a.vxl"}, 0},
               {{"bake", "sphere", "-o", "c_1.brv", "--edge", "8"}, 0},
               {{"bake", "slices", "room.obj", "-o", "s.png", "--size", "4x4x4"}, 0},
               {{"bake", "occlusion", "room.obj", "-o", "o.png", "--size", "4x4x4", "--rays", "2"}, 0},
               {{"bake", "spheres", "-o", "t.spheres", "--size", "9x9x9", "--count", "3"}, 0},
               {{"info", "room.obj"}, 0},
               {{"convert", "c_1.brv", "c.nvdb"}, 0},
               {{"query", "room.toml", "--from", "0,1,1", "--to", "0,1,-1", "--time", "0.1"}, 0},
               {{"diff", "a.png", "a.png"}, 0},
               {{"palettes", "viridis"}, 0},
               {{"devices"}, 0},
               {{"bench", "fill/1800", "--repetitions", "1"}, 0},
#ifdef BRUME_VIEWER
               {{"view", "--play", "room.toml", "--record", "room.toml"}, 2},
#endif
               {{"demo", "--out", "none"}, 2}});
}

TEST(Program, EveryExitCodeIsThatOfACall) {
  expect_same(
      {{{"fly"}, 2},
       {{"info", "none.obj"}, 3},
       {{"voxelize", "room.obj", "--voxel", "0.00001"}, 4},
       {{"render", "room.obj", "-o", "a.png", "--device", "none such"}, 5},
       {{"bake", "sphere", "-o", "c_1.brv", "--edge", "8"}, 0},
       {{"convert", "c_%d.brv", "d_%d.brv", "--frames", "1-2"}, 6},
       {{"query", "room.toml", "--from", "0,1,1", "--to", "0,1,-1", "--time", "0.1", "--expect", "hidden"},
        7}});
}

// Nothing of a call is left for the next: what is quiet, that a result was written, a signal.
TEST(Program, CallsStartAfresh) {
  const WorkFolder folder;
  folder.write("room.obj", room_obj());
  const Arguments beside{"voxelize", "room.obj", "--grid", "4x4x4", "--origin", "1000,0,0", "-q"};
  EXPECT_EQ(run_brume(folder.path(), beside).error, "");
  EXPECT_NE(run_brume(folder.path(), {beside.begin(), beside.end() - 1}).error, "");

  EXPECT_EQ(run_brume(folder.path(), {"info", "room.obj", "--json", "-"}).exit_code, 0);
  const Outcome failed = run_brume(folder.path(), {"sim", "none.toml", "--json", "-"});
  EXPECT_EQ(nlohmann::json::parse(failed.out, nullptr, false)["command"], "sim") << failed.out;

  // The handlers of a call outlive it, unless the caller sets others.
  struct sigaction before {};
  ::sigaction(SIGTERM, nullptr, &before);
  const std::string file = (folder.path() / "a.brv").string();
  const std::array words{"brume", "bake", "sphere", "--edge", "8", "-o", file.c_str()};
  EXPECT_EQ(run(static_cast<int>(words.size()), words.data()), 0);
  ::raise(SIGTERM);
  const Outcome next = run_brume(folder.path(), {"info", "room.obj"});
  EXPECT_EQ(next.exit_code, 0) << next.error;
  ::sigaction(SIGTERM, &before, nullptr);
}

}  // namespace
}  // namespace brume::cli
