#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

class Voxelize : public RoomTest {};

const Arguments kRoom{"voxelize", "room.obj", "-o", "room.vxl", "--voxel", "0.25"};

TEST_F(Voxelize, ReportsTheResultAndLoadsTheCacheNextTime) {
  const Json first = json_of(kRoom);
  EXPECT_EQ(first["triangles"], 24);
  EXPECT_EQ(first["cached"], false);
  EXPECT_GT(first["solid"], 1000);
  EXPECT_GE(first["milliseconds"], 0.0);
  EXPECT_EQ(folder_.files(), (Arguments{"room.obj", "room.vxl"}));

  const Json second = json_of(kRoom);
  EXPECT_EQ(second["cached"], true);
  EXPECT_EQ(second["solid"], first["solid"]);

  const Json info = json_of({"info", "room.vxl"});
  EXPECT_EQ(info["solid"], first["solid"]);
  EXPECT_EQ(info["grid"], first["grid"]);
  // Both commands count the same triangles.
  const Json scene = json_of({"info", "room.obj"});
  EXPECT_EQ(scene["solid_triangles"], first["triangles"]);
}

TEST_F(Voxelize, ScalesTheScene) {
  const Json metres = json_of({"voxelize", "room.obj"});
  const Json large = json_of({"voxelize", "room.obj", "--scale", "2", "--voxel", "0.5"});
  EXPECT_EQ(large["solid"], metres["solid"]);
  EXPECT_EQ(large["grid"], metres["grid"]);
}

TEST_F(Voxelize, WarnsOfAGridBesideTheScene) {
  const Outcome done = run_well({"voxelize", "room.obj", "--grid", "10x10x10", "--origin", "1000,0,0"});
  EXPECT_NE(done.error.find("warning: no voxel is solid"), std::string::npos) << done.error;
}

TEST_F(Voxelize, RebuildsWhenTheSceneChanges) {
  const Json first = json_of(kRoom);
  folder_.write("room.obj", room_obj() + "v -1 1 -1\nv -1 1.5 -1\nv -0.5 1 -1\nf 17 18 19\n");
  const Json changed = json_of(kRoom);
  EXPECT_EQ(changed["cached"], false);
  EXPECT_GT(changed["solid"], first["solid"]);
}

TEST_F(Voxelize, RebuildsADamagedCache) {
  const Json first = json_of(kRoom);
  const std::string whole = bytes("room.vxl");
  for (const std::size_t length : {std::size_t{0}, std::size_t{7}, whole.size() / 2, whole.size() - 1}) {
    folder_.write("room.vxl", whole.substr(0, length));
    EXPECT_EQ(run({"info", "room.vxl"}).exit_code, 3) << length;
    const Json again = json_of(kRoom);
    EXPECT_EQ(again["cached"], false) << length;
    EXPECT_EQ(again["solid"], first["solid"]);
    EXPECT_EQ(bytes("room.vxl"), whole);
  }
}

TEST_F(Voxelize, ExportsASceneThatLoads) {
  run_well({"voxelize", "room.obj", "--voxel", "0.5", "--obj", "cubes.obj"});
  const Json room = json_of({"info", "room.obj"});
  const Json cubes = json_of({"info", "cubes.obj"});
  EXPECT_GT(cubes["triangles"], 12);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_LE(cubes["bounds_min"][axis], room["bounds_min"][axis]);
    EXPECT_GE(cubes["bounds_max"][axis], room["bounds_max"][axis]);
  }
}

TEST_F(Voxelize, AcceptsOriginsThatBeginWithAMinus) {
  for (const Arguments& origin : {Arguments{"--origin", "-30,0,-30"}, Arguments{"--origin=-30,0,-30"}}) {
    const Json result = json_of(words("voxelize room.obj --grid 120x20x120 --voxel 0.5"), origin);
    EXPECT_EQ(result["grid"], (Json{120, 20, 120}));
    EXPECT_EQ(result["origin"], (Json{-30, 0, -30}));
    EXPECT_GT(result["solid"], 100);
  }
}

TEST_F(Voxelize, IsIndependentOfTheNumberOfThreads) {
  std::string one;
  for (const char* threads : {"1", "2", "7"}) {
    run_well({"voxelize", "room.obj", "-o", std::string(threads) + ".vxl", "--voxel", "0.1", "--threads",
              threads});
    const std::string made = this->bytes((std::string(threads) + ".vxl"));
    if (one.empty()) one = made;
    EXPECT_EQ(made, one);
  }
}

// A real scene of 157 objects and 51 lights.
TEST_F(Voxelize, TheMotel) {
  const char* named = std::getenv("BRUME_MOTEL");
  const std::filesystem::path motel = named ? named : BRUME_SOURCE_DIR "/../shared/data/motel";
  if (!std::filesystem::exists(motel / "Scene.txt")) GTEST_SKIP() << "the motel scene is not there";
  const std::string scene = (motel / "Scene.txt").string();
  const Arguments arguments{"voxelize", scene,       "--grid", "120x20x120", "--voxel", "0.5",
                            "--origin", "-30,0,-30", "-o",     "motel.vxl",  "--obj",   "motel.obj"};
  const Json first = json_of(arguments);
  // Of 101,055 triangles, those of passable objects are skipped.
  EXPECT_GT(first["triangles"], 98000);
  EXPECT_LT(first["triangles"], 101055);
  EXPECT_EQ(first["cached"], false);
  const Json second = json_of(arguments);
  EXPECT_EQ(second["cached"], true);
  EXPECT_EQ(second["solid"], first["solid"]);

  const Json info = json_of({"info", scene});
  EXPECT_EQ(info["objects"], 156);
  EXPECT_EQ(info["grenade"], "from the file");
  EXPECT_EQ(info["lights"].size(), 51u);
}

}  // namespace
}  // namespace brume::cli
