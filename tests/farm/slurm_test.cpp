// script/farm on a cluster of four Slurm nodes, of which one is killed and one has a full disk.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <future>
#include <map>
#include <optional>
#include <regex>
#include <thread>

#include "tests/farm/cluster.hpp"
#include "tests/farm/farm_scene.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kKilled = 2, kFull = 3;

// The frames that a shard rendered in a round, and where.
struct Rendered {
  std::string node;
  int first = 0, last = 0;
};

class SlurmFarm : public testing::Test {
 protected:
  SlurmFarm() {
    write_scene(folder_, 10);
    fs::create_directories(folder_.path() / "out/frames");
  }
  fs::path frame(int number) const {
    char name[20];
    std::snprintf(name, sizeof name, "%06d.png", number);
    return folder_.path() / "out/frames" / name;
  }
  /// The shard that a node renders now; nothing: none.
  std::optional<int> shard_on(int node) const {
    for (int shard = 1; shard <= kShards; ++shard) {
      const fs::path state = folder_.path() / "out/state" / std::to_string(shard);
      const auto on = read_text_file(state.string() + ".node");
      if (on && *on == "node" + std::to_string(node) + "\n" && !fs::exists(state.string() + ".exit"))
        return shard;
    }
    return std::nullopt;
  }
  /// The first of the frames of a shard that is missing; nothing: none is there, or all.
  std::optional<int> first_missing(int shard) const {
    const int first = kFrames * (shard - 1) / kShards, last = kFrames * shard / kShards - 1;
    if (!fs::exists(frame(first)) || fs::exists(frame(last))) return std::nullopt;
    int number = first;
    while (fs::exists(frame(number))) ++number;
    return number;
  }
  /// A folder with a brume that, on one node, renders the first half of its shard and then waits to be
  /// killed. On all other nodes it is the program of this build.
  std::string program_that_waits() const {
    fs::create_directory(folder_.path() / "bin");
    const fs::path program = folder_.path() / "bin/brume";
    std::ofstream(program) << "#!/bin/bash\nif [[ ${SLURMD_NODENAME-} == node" << kKilled
                           << " ]]; then\n  shard=${!#%/*}\n  "
                           << BRUME_BUILD_DIR "/brume \"${@:1:$#-1}\" $((2 * shard - 1))/" << 2 * kShards
                           << " && echo $shard > " << waiting().string()
                           << "\n  exec sleep infinity\nfi\nexec " << BRUME_BUILD_DIR "/brume \"$@\"\n";
    fs::permissions(program, fs::perms::owner_all);
    return program.parent_path().string();
  }
  fs::path waiting() const { return folder_.path() / "waiting"; }
  /// Kills that node; returns its shard and the first frame that it did not write.
  std::pair<int, int> kill_between_frames(Cluster& cluster, const std::function<bool()>& ended) const {
    while (!ended()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      const auto shard = fs::exists(waiting()) ? shard_on(kKilled) : std::nullopt;
      const auto missing = shard ? first_missing(*shard) : std::nullopt;
      if (!missing) continue;
      cluster.kill(kKilled);
      return {*shard, *missing};
    }
    ADD_FAILURE() << "the node rendered nothing";
    return {0, 0};
  }
  /// What the log says about a shard of a round.
  std::optional<Rendered> rendered(const std::string& log, int round, int shard) const {
    const std::regex line("round " + std::to_string(round) + ": shard " + std::to_string(shard) +
                          " on (\\S+): frames? (\\d+)(?:-(\\d+))?: missing\n");
    std::smatch match;
    if (!std::regex_search(log, match, line)) return std::nullopt;
    return Rendered{match[1], std::stoi(match[2]), std::stoi(match[3].matched ? match[3] : match[2])};
  }
  /// The shards that failed on a node, with the reasons.
  std::map<int, std::string> failed(const std::string& log, int node) const {
    std::map<int, std::string> shards;
    const std::regex line("round 1: shard (\\d+) on node" + std::to_string(node) + " failed: (.*)\n");
    for (std::sregex_iterator it(log.begin(), log.end(), line), end; it != end; ++it)
      shards[std::stoi((*it)[1])] = (*it)[2];
    return shards;
  }

  static constexpr int kFrames = 240, kShards = 8;
  WorkFolder folder_;
};

TEST_F(SlurmFarm, OneNodeIsKilledAndOneDiskIsFull) {
  if (const std::string obstacle = Cluster::obstacle(); !obstacle.empty()) GTEST_SKIP() << obstacle;
  const Outcome alone =
      run_brume(folder_.path(), {"render", "room.toml", "-o", "alone.mp4", "--size", "64x36"});
  ASSERT_EQ(alone.exit_code, 0) << alone.error;

  // On the third node the folder of the frames is a disk with room for fewer frames than a shard has.
  const std::string small_disk =
      "mount -t tmpfs -o nr_blocks=20 none " + (folder_.path() / "out/frames").string();
  Cluster cluster(folder_.path() / "cluster", 4, {{kFull, small_disk}});
  const std::string program = program_that_waits();
  auto farm = std::async(std::launch::async, [&] {
    return run_farm(
        folder_, {"room.toml", "out", "--shards", std::to_string(kShards), "--", "--size", "64x36"}, program);
  });
  const auto ended = [&] { return farm.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
  const auto [killed_shard, first_lost] = kill_between_frames(cluster, ended);
  const Outcome run = farm.get();
  ASSERT_EQ(run.exit_code, 0) << run.error << run.out;

  // The film.
  EXPECT_TRUE(text_of(folder_, "out/film.mp4") == text_of(folder_, "alone.mp4"));
  const std::string log = text_of(folder_, "out/farm.log");
  std::printf("%s", log.c_str());

  // Of the killed node exactly the frames that it had not written are rendered again, elsewhere.
  EXPECT_EQ(failed(log, kKilled),
            (std::map<int, std::string>{{killed_shard, "it, its job or its node was killed"}}));
  const auto again = rendered(log, 2, killed_shard);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->first, first_lost);
  EXPECT_EQ(again->last, kFrames * killed_shard / kShards - 1);
  EXPECT_NE(again->node, "node" + std::to_string(kKilled));

  // Of the full disk all frames are, as it is no part of the shared folder.
  const auto on_full_disk = failed(log, kFull);
  EXPECT_FALSE(on_full_disk.empty());
  for (const auto& [shard, reason] : on_full_disk) {
    EXPECT_NE(reason.find("No space left on device"), std::string::npos) << reason;
    const auto first = rendered(log, 1, shard), second = rendered(log, 2, shard);
    ASSERT_TRUE(first && second) << shard;
    EXPECT_EQ(second->first, kFrames * (shard - 1) / kShards);
    EXPECT_EQ(second->last, kFrames * shard / kShards - 1);
    EXPECT_NE(second->node, "node" + std::to_string(kFull));
  }

  // The commands of the page, on the nodes that remain.
  int calls = 0;
  for (const auto& call : farm_calls()) {
    if (std::find(call.begin(), call.end(), "--local") != call.end()) continue;  // farm_test.cpp
    const Outcome page = run_farm(folder_, quick(call, "room.toml"));
    EXPECT_EQ(page.exit_code, 0) << page.error << page.out;
    ++calls;
  }
  EXPECT_GT(calls, 0);
}

}  // namespace
}  // namespace brume::cli
