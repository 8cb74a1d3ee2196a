#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

using Arguments = std::vector<std::string>;
using Json = nlohmann::json;

Json json_of(const Outcome& run) {
  EXPECT_EQ(run.exit_code, 0) << run.error;
  return Json::parse(run.out, nullptr, false);
}

const Arguments kRoom{"voxelize", "room.obj", "-o", "room.vxl", "--voxel", "0.25", "--json", "-"};

TEST(Voxelize, ReportsTheResultAndLoadsTheCacheNextTime) {
  const WorkFolder folder;
  folder.write("room.obj", room_obj());
  const Json first = json_of(run_brume(folder.path(), kRoom));
  EXPECT_EQ(first["triangles"], 24);
  EXPECT_EQ(first["cached"], false);
  EXPECT_GT(first["solid"], 1000);
  EXPECT_GE(first["milliseconds"], 0.0);
  EXPECT_EQ(folder.files(), (Arguments{"room.obj", "room.vxl"}));

  const Json second = json_of(run_brume(folder.path(), kRoom));
  EXPECT_EQ(second["cached"], true);
  EXPECT_EQ(second["solid"], first["solid"]);

  const Json info = json_of(run_brume(folder.path(), {"info", "room.vxl", "--json", "-"}));
  EXPECT_EQ(info["solid"], first["solid"]);
  EXPECT_EQ(info["grid"], first["grid"]);
  // Both commands count the same triangles.
  const Json scene = json_of(run_brume(folder.path(), {"info", "room.obj", "--json", "-"}));
  EXPECT_EQ(scene["solid_triangles"], first["triangles"]);
}

TEST(Voxelize, ScalesTheScene) {
  const WorkFolder folder;
  folder.write("room.obj", room_obj());
  const Json metres = json_of(run_brume(folder.path(), {"voxelize", "room.obj", "--json", "-"}));
  const Json large = json_of(
      run_brume(folder.path(), {"voxelize", "room.obj", "--scale", "2", "--voxel", "0.5", "--json", "-"}));
  EXPECT_EQ(large["solid"], metres["solid"]);
  EXPECT_EQ(large["grid"], metres["grid"]);
}

TEST(Voxelize, WarnsOfAGridBesideTheScene) {
  const WorkFolder folder;
  folder.write("room.obj", room_obj());
  const Outcome run =
      run_brume(folder.path(), {"voxelize", "room.obj", "--grid", "10x10x10", "--origin", "1000,0,0"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_NE(run.error.find("warning: no voxel is solid"), std::string::npos) << run.error;
}

TEST(Voxelize, RebuildsWhenTheSceneChanges) {
  const WorkFolder folder;
  folder.write("room.obj", room_obj());
  const Json first = json_of(run_brume(folder.path(), kRoom));
  folder.write("room.obj", room_obj() + "v -1 1 -1\nv -1 1.5 -1\nv -0.5 1 -1\nf 17 18 19\n");
  const Json changed = json_of(run_brume(folder.path(), kRoom));
  EXPECT_EQ(changed["cached"], false);
  EXPECT_GT(changed["solid"], first["solid"]);
}

TEST(Voxelize, RebuildsADamagedCache) {
  const WorkFolder folder;
  folder.write("room.obj", room_obj());
  const Json first = json_of(run_brume(folder.path(), kRoom));
  const std::string whole = *read_text_file(folder.path() / "room.vxl");
  for (const std::size_t length : {std::size_t{0}, std::size_t{7}, whole.size() / 2, whole.size() - 1}) {
    folder.write("room.vxl", whole.substr(0, length));
    EXPECT_EQ(run_brume(folder.path(), {"info", "room.vxl"}).exit_code, 3) << length;
    const Json again = json_of(run_brume(folder.path(), kRoom));
    EXPECT_EQ(again["cached"], false) << length;
    EXPECT_EQ(again["solid"], first["solid"]);
    EXPECT_EQ(*read_text_file(folder.path() / "room.vxl"), whole);
  }
}

TEST(Voxelize, ExportsASceneThatLoads) {
  const WorkFolder folder;
  folder.write("room.obj", room_obj());
  const Outcome run =
      run_brume(folder.path(), {"voxelize", "room.obj", "--voxel", "0.5", "--obj", "cubes.obj"});
  EXPECT_EQ(run.exit_code, 0) << run.error;
  const Json room = json_of(run_brume(folder.path(), {"info", "room.obj", "--json", "-"}));
  const Json cubes = json_of(run_brume(folder.path(), {"info", "cubes.obj", "--json", "-"}));
  EXPECT_GT(cubes["triangles"], 12);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_LE(cubes["bounds_min"][axis], room["bounds_min"][axis]);
    EXPECT_GE(cubes["bounds_max"][axis], room["bounds_max"][axis]);
  }
}

TEST(Voxelize, AcceptsOriginsThatBeginWithAMinus) {
  const WorkFolder folder;
  folder.write("room.obj", room_obj());
  for (const Arguments& origin : {Arguments{"--origin", "-30,0,-30"}, Arguments{"--origin=-30,0,-30"}}) {
    Arguments arguments{"voxelize", "room.obj", "--grid", "120x20x120", "--voxel", "0.5"};
    arguments.insert(arguments.end(), origin.begin(), origin.end());
    arguments.insert(arguments.end(), {"--json", "-"});
    const Json result = json_of(run_brume(folder.path(), arguments));
    EXPECT_EQ(result["grid"], (Json{120, 20, 120}));
    EXPECT_EQ(result["origin"], (Json{-30, 0, -30}));
    EXPECT_GT(result["solid"], 100);
  }
}

TEST(Voxelize, IsIndependentOfTheNumberOfThreads) {
  const WorkFolder folder;
  folder.write("room.obj", room_obj());
  std::string one;
  for (const char* threads : {"1", "2", "7"}) {
    const Outcome run = run_brume(folder.path(), {"voxelize", "room.obj", "-o", std::string(threads) + ".vxl",
                                                  "--voxel", "0.1", "--threads", threads});
    ASSERT_EQ(run.exit_code, 0) << run.error;
    const std::string bytes = *read_text_file(folder.path() / (std::string(threads) + ".vxl"));
    if (one.empty()) one = bytes;
    EXPECT_EQ(bytes, one);
  }
}

// A real scene of 157 objects and 51 lights.
TEST(Voxelize, TheMotel) {
  const char* named = std::getenv("BRUME_MOTEL");
  const std::filesystem::path motel = named ? named : BRUME_SOURCE_DIR "/../shared/data/motel";
  if (!std::filesystem::exists(motel / "Scene.txt")) GTEST_SKIP() << "the motel scene is not there";
  const WorkFolder folder;
  const std::string scene = (motel / "Scene.txt").string();
  const Arguments arguments{"voxelize",  scene, "--grid",    "120x20x120", "--voxel",   "0.5",    "--origin",
                            "-30,0,-30", "-o",  "motel.vxl", "--obj",      "motel.obj", "--json", "-"};
  const Json first = json_of(run_brume(folder.path(), arguments));
  // Of 101,055 triangles, those of passable objects are skipped.
  EXPECT_GT(first["triangles"], 98000);
  EXPECT_LT(first["triangles"], 101055);
  EXPECT_EQ(first["cached"], false);
  const Json second = json_of(run_brume(folder.path(), arguments));
  EXPECT_EQ(second["cached"], true);
  EXPECT_EQ(second["solid"], first["solid"]);

  const Json info = json_of(run_brume(folder.path(), {"info", scene, "--json", "-"}));
  EXPECT_EQ(info["objects"], 156);
  EXPECT_EQ(info["grenade"], "from the file");
  EXPECT_EQ(info["lights"].size(), 51u);
}

}  // namespace
}  // namespace brume::cli
