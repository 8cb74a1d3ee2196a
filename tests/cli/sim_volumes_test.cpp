// `brume sim --volumes`: the smoke as volume files.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "grids/files/grid_files.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

constexpr const char* kSmokeTimeline =
    "version = 1\nscene = \"room.obj\"\nduration = 1.0\n[smoke]\nvoxels = 300\nbloom = 0.5\nextinction = "
    "3.0\n"
    "[[event]]\ntype = \"smoke\"\ntime = 0.1\nfrom = [-1, 1.5, 0]\nat = [-1, 0.5, 0]\n";

class SimVolumes : public RoomTest {
 protected:
  SimVolumes() {
    folder_.write("room.toml", kSmokeTimeline);
    // This test is not beside the program that reads .vdb files.
    const auto beside = std::filesystem::path(BRUME_PROGRAM).parent_path() / "brume-vdb";
    ::setenv("BRUME_VDB", beside.c_str(), 1);
  }
  Outcome sim(const Arguments& more, const RunOptions& options = {}) const {
    return run({"sim", "room.toml"}, more, options);
  }
  Outcome sim_well(const Arguments& more) const { return run_well({"sim", "room.toml"}, more); }
  grids::Grid grid(const std::string& name) const {
    const grids::GridFile file = grids::load_grid_file(folder_.path() / name).value_or_throw();
    EXPECT_EQ(file.grids.size(), 1u);
    return file.grids.at(0);
  }
};

template <typename T>
T number_of(const grids::Grid& grid, const std::string& name) {
  T value{};
  for (const grids::Metadata& entry : grid.metadata)
    if (entry.name == name && entry.bytes.size() == sizeof value)
      std::memcpy(&value, entry.bytes.data(), sizeof value);
  return value;
}

TEST_F(SimVolumes, FramesAreThoseOfTheirTimes) {
  const Outcome all = sim_well({"--volumes", "all_%02d.brv", "--fps", "8", "--json", "-"});
  const auto result = nlohmann::json::parse(all.out);
  EXPECT_EQ(result["volumes"], 8);
  EXPECT_EQ(result["ticks"], 64);
  sim_well({"--volumes", "some_%d.brv", "--frames", "5-6", "--fps", "8"});
  sim_well({"--volumes", "last.brv"});
  for (const int frame : {5, 6}) {
    const grids::Grid one = grid("all_0" + std::to_string(frame) + ".brv");
    const grids::Grid other = grid("some_" + std::to_string(frame) + ".brv");
    EXPECT_EQ(number_of<std::int32_t>(one, "tick"), 8 * frame);
    EXPECT_EQ(number_of<double>(one, "time"), frame / 8.0);
    EXPECT_EQ(number_of<float>(one, "extinction"), 3);
    EXPECT_GT(grids::count_active(one), 100u);
    EXPECT_EQ(one.values, other.values);
  }
  EXPECT_EQ(grids::count_active(grid("all_00.brv")), 0u) << "before the smoke";
  EXPECT_EQ(number_of<std::int32_t>(grid("last.brv"), "tick"), 63);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "all_08.brv"));
  // Several frames of a tick, and frames after the end.
  const Outcome late =
      sim_well({"--volumes", "late_%d.brv", "--frames", "9-10", "--fps", "8", "--rate", "4"});
  EXPECT_EQ(late.error,
            "brume: warning: --frames 9-10: the last is at 1.25 s, after the end of the timeline at 1 s\n");
  EXPECT_EQ(number_of<std::int32_t>(grid("late_9.brv"), "tick"), 4);
  EXPECT_EQ(number_of<std::int32_t>(grid("late_10.brv"), "tick"), 5);
}

// Beside floor and walls lies what fills the solid voxels up to their surfaces; --rate has surfaces, too.
TEST_F(SimVolumes, SmokeReachesUpToWalls) {
  for (const char* rate : {"64", "20"}) {
    sim_well({"--volumes", "last.brv", "--rate", rate});
    const grids::Grid last = grid("last.brv");
    std::vector<float> values(last.values.size() / sizeof(float));
    std::memcpy(values.data(), last.values.data(), last.values.size());
    EXPECT_GT(std::ranges::count_if(values, [](float value) { return value > 1.1f; }), 20) << rate;
    EXPECT_GT(std::ranges::count(values, 1.0f), 20) << rate;
  }
}

TEST_F(SimVolumes, TheSameThroughOpenVdb) {
  sim_well({"--volumes", "a.vdb", "--up", "z"});
  sim_well({"--volumes", "a.brv", "--up", "z"});
  const grids::Grid vdb = grid("a.vdb"), brv = grid("a.brv");
  EXPECT_EQ(vdb.name, "density");
  EXPECT_EQ(vdb.grid_class, grids::GridClass::fog_volume);
  EXPECT_EQ(vdb.world_from_index, brv.world_from_index);
  // OpenVDB adds its own, such as file_bbox_min.
  for (const grids::Metadata& entry : brv.metadata)
    EXPECT_EQ(std::count(vdb.metadata.begin(), vdb.metadata.end(), entry), 1) << entry.name;
  EXPECT_EQ(vdb.values, brv.values);
  ASSERT_EQ(vdb.bricks.size(), brv.bricks.size());
  for (std::size_t i = 0; i < vdb.bricks.size(); ++i) {
    EXPECT_EQ(vdb.bricks[i].origin, brv.bricks[i].origin);
    EXPECT_EQ(vdb.bricks[i].active, brv.bricks[i].active);
  }

  // Z is up: the smoke is on the floor, at z = 0 to 3.
  const Box<double> index = active_bounds(vdb);
  const glm::dvec4 a = vdb.world_from_index * glm::dvec4(index.low, 1),
                   b = vdb.world_from_index * glm::dvec4(index.high, 1);
  EXPECT_GT(std::min(a.z, b.z), -0.6);
  EXPECT_LT(std::max(a.z, b.z), 3.6);
  EXPECT_LT(std::min(a.x, b.x), -1);
}

TEST_F(SimVolumes, OpenVdbsOwnProgramReadsThem) {
  sim_well({"--volumes", "a.vdb"});
  const std::string command = "vdb_print -l '" + (folder_.path() / "a.vdb").string() + "' 2>&1";
  FILE* const pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string printed;
  std::array<char, 512> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) printed += part.data();
  EXPECT_EQ(::pclose(pipe), 0) << printed;
  const std::string active = std::to_string(grids::count_active(grid("a.vdb")));
  for (const std::string& fact :
       {std::string("density"), std::string("fog volume"), std::string("extinction: 3"), active})
    EXPECT_NE(printed.find(fact), std::string::npos) << fact << " is not in\n" << printed;
}

TEST_F(SimVolumes, AnInterruptedSequenceSaysHowToContinue) {
  RunOptions interrupt;
  interrupt.signal = SIGTERM;
  interrupt.signal_when = [&] { return std::filesystem::exists(folder_.path() / "s_20.brv"); };
  interrupt.signal_before_call = true;
  const Outcome run = sim({"--volumes", "s_%d.brv", "--frames", "10-29", "--fps", "100"}, interrupt);
  ASSERT_EQ(run.exit_code, 6) << run.error;
  EXPECT_NE(run.error.find("of 20 frames written; continue with --frames "), std::string::npos) << run.error;
  EXPECT_EQ(run.error.find("--resume"), std::string::npos) << run.error;
}

}  // namespace
}  // namespace brume::cli
