// The reader of scenes of tanks; that it restores what is written: tank_writer_test.cpp.
#include "scene/tank_scene.hpp"

#include <gtest/gtest.h>

#include "scene/files/tank_reader.hpp"
#include "tests/work_folder.hpp"

namespace brume::scene {
namespace {

Result<TankScene> tank(const std::string& keys) {
  return parse_tank_scene("version = 1\n[tank]\n" + keys, "scenes/t.toml");
}

std::string fault(const std::string& keys) {
  const auto scene = tank(keys);
  return scene ? "none" : scene.failure().message;
}

TEST(TankSceneFile, SmallTanksHaveSmallSpheresUnlessItSaysOtherwise) {
  for (const char* size : {"[1, 1, 1]", "[7, 3, 1]", "[20, 600, 600]", "[600, 600, 200]"}) {
    const TankScene scene = tank(std::string("size = ") + size).value_or_throw();
    EXPECT_EQ(scene.pack.radius, spheres::default_radius(scene.pack.size)) << size;
    EXPECT_EQ(scene.pack.count, spheres::default_count(scene.pack)) << size;
    EXPECT_TRUE(spheres::check_options(scene.pack)) << size;
  }
  EXPECT_EQ(tank("").value_or_throw().pack.count, spheres::PackOptions().count);
  EXPECT_EQ(tank("size = [7, 3, 1]\nspheres = 65535\n").value_or_throw().pack.count, 65535u);
  EXPECT_EQ(fault("size = [7, 3, 1]\nradius = [0.2, 0.6]\n"),
            "scenes/t.toml:4:10: \"radius\": expected spheres that fit into the tank's 7 x 3 x 1 voxels");
}

TEST(TankSceneFile, ChoicesHaveEitherDash) {
  const auto arrangement = [](const std::string& name) {
    return tank("arrangement = \"" + name + "\"\n").value_or_throw().pack.arrangement;
  };
  EXPECT_EQ(arrangement("largest_first"), spheres::Arrangement::largest_first);
  EXPECT_EQ(arrangement("largest-first"), spheres::Arrangement::largest_first);
  EXPECT_EQ(arrangement("coral"), spheres::Arrangement::coral);
  EXPECT_EQ(fault("arrangement = \"corals\"\n"),
            "scenes/t.toml:3:15: \"arrangement\": expected \"random\", \"largest_first\", \"noise\" or "
            "\"coral\"");
}

TEST(TankSceneFile, FilesLieBelowItsFolder) {
  for (const char* key : {"file", "palette"}) {
    const std::string where = "scenes/t.toml:3:" + std::to_string(std::string(key).size() + 4) + ": \"" + key;
    EXPECT_EQ(fault(std::string(key) + " = \"../a.gpl\"\n"),
              where + "\": expected the name of a file below the folder of this file");
  }
}

TEST(TankSceneFile, NamesItsFilesInSpiteOfFaults) {
  const cli::WorkFolder folder;
  const auto named = [&](const std::string& text) {
    folder.write("t.toml", text);
    std::vector<std::string> names;
    for (const auto& file : files_named_by_tank_scene(folder.path() / "t.toml"))
      names.push_back(file.lexically_relative(folder.path()).string());
    return names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(named("[tank]\npalette = \"a/p.json:0.2-0.6\"\nsamples = 0\n[[camera]]\nopening = \"o.png\"\n"),
            (Names{"a/p.json", "o.png"}));
  EXPECT_EQ(named("[tank]\nfile = \"t.spheres\"\npalette = \"viridis:0-1\"\n"), Names{"t.spheres"});
  EXPECT_EQ(named("tank = 7\ncamera = [7]\n"), Names{});
  EXPECT_EQ(named("[tank\nfile = \"t.spheres\"\n"), Names{});
}

}  // namespace
}  // namespace brume::scene
