// script/farm without Slurm: the same job script, by several processes.
#include <signal.h>

#include <fstream>

#include "tests/farm/farm_scene.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

class Farm : public testing::Test {
 protected:
  Farm() {
    write_scene(folder_, 1);
    write_flight(folder_);
  }
  /// The options of render are last, after "--".
  Outcome farm(std::vector<std::string> more, const std::string& build = BRUME_BUILD_DIR) const {
    more.insert(more.begin(), {"flight.toml", "out", "--local", "2", "--shards", "3"});
    more.insert(more.end(), kQuick.begin(), kQuick.end());
    return run_farm(folder_, more, build);
  }
  std::string log() const { return text_of(folder_, "out/farm.log"); }
  /// The film that one command makes.
  std::string film_alone(std::vector<std::string> more) const {
    more.insert(more.begin(), {"render", "flight.toml", "-o", "alone.mp4"});
    more.insert(more.end(), kQuick.begin(), kQuick.end());
    const Outcome run = run_brume(folder_.path(), more);
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return text_of(folder_, "alone.mp4");
  }
  // Passed on to brume render, which then needs no device; CommandsOfThePageRun renders with one.
  static inline const std::vector<std::string> kQuick{"--size",    "32x18",     "--mode",
                                                      "reference", "--samples", "1"};
  WorkFolder folder_;
};

void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
}

TEST_F(Farm, MakesTheFilmOfOneCommandAndRedoesWhatIsDamaged) {
  const std::string alone = film_alone({"--fps", "12"});
  const std::vector<std::string> options{"--fps", "12", "--"};
  const Outcome first = farm(options);
  ASSERT_EQ(first.exit_code, 0) << first.error;
  EXPECT_TRUE(text_of(folder_, "out/film.mp4") == alone);
  expect_in(log(), "flight.toml: frames 0-11 in 3 shards");

  fs::remove(folder_.path() / "out/frames/000004.png");
  fs::resize_file(folder_.path() / "out/frames/000009.png", 100);
  fs::remove(folder_.path() / "out/film.mp4");
  const Outcome second = farm(options);
  ASSERT_EQ(second.exit_code, 0) << second.error;
  EXPECT_TRUE(text_of(folder_, "out/film.mp4") == alone);
  expect_in(log(), ": frame 4: missing\n");
  expect_in(log(), ": frame 9: truncated; made again\n");
}

// The encoder's output depends on its number of threads.
TEST_F(Farm, EncodesByTheThreadsOfRender) {
  const auto alone = [&](const std::string& threads) {
    return film_alone({"--fps", "12", "--threads", threads});
  };
  const std::string by_one = alone("1"), by_five = alone("5");
  ASSERT_FALSE(by_one == by_five);
  ASSERT_EQ(farm({"--fps", "12", "--", "--threads", "1"}).exit_code, 0);
  EXPECT_TRUE(text_of(folder_, "out/film.mp4") == by_one);
  ASSERT_EQ(farm({"--fps", "12", "--", "--threads=5"}).exit_code, 0);
  EXPECT_TRUE(text_of(folder_, "out/film.mp4") == by_five);
}

// A program whose first call for the second shard meets a full disk.
TEST_F(Farm, RunsFailedShardsAgain) {
  fs::create_directory(folder_.path() / "bin");
  std::ofstream(folder_.path() / "bin/brume")
      << "#!/bin/sh\ncase \"$*\" in\n*'--shard 2/3') if mkdir " << folder_.path().string()
      << "/failed 2> /dev/null; then ulimit -f 0; fi ;;\nesac\nexec " BRUME_BUILD_DIR "/brume \"$@\"\n";
  fs::permissions(folder_.path() / "bin/brume", fs::perms::owner_all);
  const std::string build = (folder_.path() / "bin").string();
  const Outcome run = farm({"--frames", "0-5", "--"}, build);
  ASSERT_EQ(run.exit_code, 0) << run.error << run.out;
  EXPECT_TRUE(text_of(folder_, "out/film.mp4") == film_alone({"--frames", "0-5"}));
  expect_in(log(), "round 1: shard 2 on ");
  expect_in(log(), " failed: exit code 4\n");  // there is no room for the message either
  expect_in(log(), "film.mp4 is complete after round 2\n");
}

TEST_F(Farm, CommandsOfThePageRun) {
  int local = 0;
  for (const auto& call : farm_calls()) {
    if (std::find(call.begin(), call.end(), "--local") == call.end()) continue;  // slurm_test.cpp
    const Outcome run = run_farm(folder_, quick(call, "room.toml"));
    EXPECT_EQ(run.exit_code, 0) << run.error;
    ++local;
  }
  EXPECT_GT(local, 0);
}

TEST_F(Farm, RefusesWhatCannotWork) {
  const auto refuse = [&](const std::vector<std::string>& arguments, int code, const std::string& part) {
    const Outcome run = run_farm(folder_, arguments);
    EXPECT_EQ(run.exit_code, code) << run.error;
    expect_in(run.error, part);
  };
  refuse({"room.toml"}, 2, "TIMELINE FOLDER");
  refuse({"room.toml", "out", "--shards", "0"}, 2, "--shards 0");
  refuse({"room.toml", "out", "--shards"}, 2, "--shards expects a value");
  refuse({"room.toml", "out", "--size", "32x18"}, 2, "after --");
  refuse({"none.toml", "out", "--local", "1"}, 3, "none.toml");
  refuse({"room.toml", "50%d", "--local", "1"}, 2, "percent");
  folder_.write("file", "");
  refuse({"room.toml", "file", "--local", "1"}, 2, "file: is a file");
  refuse({"room.toml", "file/out", "--local", "1"}, 3, "file/out: cannot make the folder");
  refuse({"room.toml", "a\nb", "--local", "1"}, 2, "line break");
  refuse({"room.toml", "", "--local", "1"}, 2, "'': expected a folder");
  refuse({"room.toml", "out", "--local", "1", "--fps", "0"}, 2, "--fps 0");
  fs::create_directories(folder_.path() / "taken/film.mp4");
  refuse({"room.toml", "taken", "--local", "1"}, 2, "film.mp4: is a folder");
}

// What brume render would refuse is refused before a shard runs.
TEST_F(Farm, ChecksTheOptionsOfRenderFirst) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> faults{
      {{"--size", "1x"}, "--size '1x': expected WIDTHxHEIGHT"},
      {{"--size", "33x18"}, "--size 33x18: the width and height of a film must be even"},
      {{"--nonsense"}, "unknown option --nonsense"},
      {{"--raycast", "two-pass"}, "--raycast: "},
      {{"--march=haff"}, "did you mean half?"},
      {{"--frames", "0-1"}, "--frames is an option of script/farm"},
      {{"-o", "b_%d.png"}, "-o: script/farm sets it"},
      {{"--time", "1"}, "--time"}};
  for (const auto& [options, part] : faults) {
    std::vector<std::string> more{"room.toml", "out", "--local", "2", "--frames", "0-3", "--"};
    more.insert(more.end(), options.begin(), options.end());
    const Outcome run = run_farm(folder_, more);
    EXPECT_EQ(run.exit_code, 2) << run.error;
    expect_in(run.error, part);
    EXPECT_EQ(std::ranges::count(run.error, '\n'), 1) << run.error;
    EXPECT_EQ(run.out, "");
  }
  folder_.write("room.toml", "version = 1\nscene = 5\n");
  const Outcome bad = run_farm(folder_, {"room.toml", "out", "--local", "2", "--frames", "0-3"});
  EXPECT_EQ(bad.exit_code, 3) << bad.error;
  expect_in(bad.error, "room.toml:2:");
}

TEST_F(Farm, HelpIsItsOwnText) {
  const Outcome help = run_farm(folder_, {"--help"});
  EXPECT_EQ(help.exit_code, 0) << help.error;
  for (const char* option : {"TIMELINE FOLDER", "--shards N", "--frames A-B", "--fps F", "--retries N",
                             "--sbatch OPTION", "--local N", "--build FOLDER"})
    expect_in(help.out, option);
  EXPECT_EQ(help.out.find("set -e"), std::string::npos);
}

TEST_F(Farm, AnInterruptionSaysWhatRemainsAndEndsItsProcesses) {
  std::vector<std::string> options{"flight.toml", "out",   "--local", "2", "--shards",
                                   "3",           "--fps", "12",      "--"};
  options.insert(options.end(), kQuick.begin(), kQuick.end());
  // The second shard waits for the signal.
  fs::create_directory(folder_.path() / "bin");
  std::ofstream(folder_.path() / "bin/brume")
      << "#!/bin/sh\ncase \"$*\" in\n*'--shard 2/3') echo > " << folder_.path().string()
      << "/waiting; exec sleep 3600 ;;\nesac\nexec " BRUME_BUILD_DIR "/brume \"$@\"\n";
  fs::permissions(folder_.path() / "bin/brume", fs::perms::owner_all);
  RunOptions interrupted;
  interrupted.signal = SIGTERM;  // SIGINT is ignored where the tests run in the background.
  interrupted.signal_when = [&] {
    return fs::exists(folder_.path() / "waiting") && fs::exists(folder_.path() / "out/frames/000000.png");
  };
  const Outcome run = run_farm(folder_, options, (folder_.path() / "bin").string(), interrupted);
  EXPECT_EQ(run.exit_code, 128 + SIGTERM) << run.error;
  std::size_t frames = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path() / "out/frames"))
    frames += entry.path().extension() == ".png" ? 1 : 0;
  expect_in(run.error, "script/farm: interrupted; " + std::to_string(frames) + " of 12 frames are in ");
  expect_in(run.error, "the same command continues\n");
  EXPECT_FALSE(fs::exists(folder_.path() / "out/film.mp4"));
  EXPECT_EQ(run_farm(folder_, options).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder_.path() / "out/film.mp4"));
}

}  // namespace
}  // namespace brume::cli
