#include <gtest/gtest.h>

#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

class Info : public RoomTest {
 protected:
  Json info(const std::string& file) const { return json_of({"info", file}); }
  std::string text(const std::string& file) const { return run_well({"info", file}).out; }
};

TEST_F(Info, SizeAndPlaceOfAScene) {
  const Json room = info("room.obj");
  EXPECT_EQ(room["objects"], 1);
  EXPECT_EQ(room["triangles"], 24);
  EXPECT_EQ(room["size"], (Json{4, 3, 4}));
  EXPECT_EQ(room["up"], "y");
  EXPECT_EQ(room["ground"], 0);
  EXPECT_EQ(room["camera"]["from_file"], false);
  EXPECT_TRUE(room["lights"].empty());
  EXPECT_NE(text("room.obj").find("4 m wide (x), 3 m high (y), 4 m deep (z)"), std::string::npos);
}

// In metres, after the scale that render chooses.
TEST_F(Info, SizeAndPlaceOfASceneInMillimetres) {
  folder_.write("plan.obj",
                "v 1000 2000 0\nv 21000 2000 0\nv 1000 2000 8000\nv 1000 5000 0\nf 1 2 3\nf 1 2 4\n");
  const Json plan = info("plan.obj");
  EXPECT_NEAR(plan["scale"].get<double>(), 0.1, 1e-6);
  EXPECT_EQ(plan["size"], (Json{2000, 300, 800}));
  EXPECT_EQ(plan["ground"], 200);
  EXPECT_FALSE(info("room.obj").contains("scale"));
}

// The options that it prints are those that show the scene.
TEST_F(Info, ItsSmokeAndCameraWork) {
  const std::string printed = text("room.obj");
  const auto option = [&](const std::string& name, char end) {
    const std::size_t at = printed.find(name) + name.size();
    return printed.substr(at, printed.find(end, at) - at);
  };
  const std::string smoke = option("--smoke ", '\n'), camera = option("--camera \"", '"');
  const Outcome run = run_well({"render", "room.obj", "-o", "a.png", "--size", "32x18", "--smoke", smoke,
                                "--camera", camera, "--json", "-"});
  EXPECT_EQ(run.error, "") << "no warning of the smoke";
  const Json result = Json::parse(run.out);
  ASSERT_EQ(result["smokes"].size(), 1u);
  EXPECT_EQ(result["smokes"][0]["fault"], "none");
}

TEST_F(Info, EventsOfATimeline) {
  folder_.write(
      "room.toml",
      "version = 1\nscene = \"room.obj\"\nduration = 2.0\n"
      "[[event]]\ntype = \"text\"\ntime = 0.5\ntext = \"A\"\nfrom = [0, 1, 1]\ntoward = [0, 1, -1]\n"
      "[[event]]\ntype = \"shot\"\ntime = 2.5\nfrom = [0, 1, 1]\ntoward = [0, 1, -1]\n");
  const Json result = info("room.toml");
  EXPECT_EQ(result["events"]["text"], 1);
  EXPECT_EQ(result["events"]["shot"], 1);
  EXPECT_EQ(result["events"]["smoke"], 0);
  EXPECT_EQ(result["scene_exists"], true);
  EXPECT_EQ(result["grid"].size(), 3u);
  EXPECT_TRUE(result["smokes"].empty());
  const Outcome run = run_well({"info", "room.toml", "--check"});
  EXPECT_NE(run.out.find("events          1 shot, 1 text\n"), std::string::npos) << run.out;
  EXPECT_EQ(run.error, "brume: warning: after the end of the timeline at 2 s and not shown: 1 shot\n");
}

TEST_F(Info, TheTankOfAScene) {
  folder_.write("pal.gpl", "GIMP Palette\n0 0 0\n255 255 255\n");
  folder_.write(
      "packed.toml",
      "version = 1\nduration = 2\n[tank]\nsize = [7, 3, 1]\nvoxel = 0.5\npalette = \"pal.gpl:0-0.5\"\n"
      "samples = 9\narrangement = \"coral\"\n[[light]]\nposition = [1, 2, 3]\n[[light.key]]\n"
      "time = 1\nposition = [1, 2, 4]\n[glass]\n"
      "[[camera]]\ntime = 0\nposition = [0, 0, 9]\ntarget = [0, 0, 0]\nfov = 42\n");
  const Json packed = info("packed.toml");
  EXPECT_EQ(packed["kind"], "tank scene");
  EXPECT_EQ(packed["size"], (Json{7, 3, 1}));
  EXPECT_EQ(packed["voxel_size"], 0.5);
  EXPECT_EQ(packed["radius"]["max"], 0.5);
  EXPECT_EQ(packed["arrangement"], "coral");
  EXPECT_EQ(packed["samples"], 9);
  EXPECT_EQ(packed["seconds"], 2);
  EXPECT_EQ(packed["lights"][0]["position"], (Json{1, 2, 3}));
  EXPECT_EQ(packed["lights"][0]["keys"], 1);
  EXPECT_EQ(packed["glass"], true);
  EXPECT_EQ(packed["camera"]["from_file"], true);
  EXPECT_NEAR(packed["camera"]["fov_degrees"].get<double>(), 42, 1e-4);
  EXPECT_NE(text("packed.toml").find("\nsize            7x3x1 voxels\n"), std::string::npos);
  run_well({"info", "packed.toml", "--check"});

  run_well({"bake", "spheres", "-o", "t.spheres", "--size", "40x20x10", "--count", "3"});
  folder_.write("loaded.toml", "version = 1\n[tank]\nfile = \"t.spheres\"\n");
  const Json loaded = info("loaded.toml");
  EXPECT_EQ(loaded["tank"], "t.spheres");
  EXPECT_EQ(loaded["size"], (Json{40, 20, 10}));
  EXPECT_EQ(loaded["spheres"], 3);
  EXPECT_EQ(loaded["camera"]["from_file"], false);

  // As of a timeline, what is missing is a warning or, with --check, an error; a fault is always one.
  folder_.write("gone.toml", "version = 1\n[tank]\nfile = \"gone.spheres\"\n");
  EXPECT_NE(info("gone.toml")["problem"].get<std::string>().find("gone.spheres"), std::string::npos);
  expect_failure(folder_, {"info", "gone.toml", "--check"}, 3, {"gone.spheres"});
  folder_.write("fault.toml", "version = 1\n[tank]\nsamples = 0\n");
  expect_failure(folder_, {"info", "fault.toml"}, 3, {"fault.toml:3:11: \"samples\""});
}

TEST_F(Info, ChecksWhatRenderingWouldLoad) {
  const std::string head = "version = 1\nduration = 2.0\nscene = ";
  const std::string shot =
      "[[event]]\ntype = \"shot\"\ntime = 0.5\nfrom = [0, 1, 1]\ntoward = [0, 1, -1]\nshape = \"mask\"\nmask "
      "= ";
  const std::pair<std::string, std::string> cases[] = {
      {head + "\"none.obj\"\n", "none.obj"},
      {head + "\"room.obj\"\n" + shot + "\"none.png\"\n", "none.png"},
      {head + "\"room.obj\"\n[[event]]\ntype = \"door\"\ntime = 1.0\nobject = \"gate\"\nopen = true\n",
       "gate"},
  };
  for (const auto& [timeline, part] : cases) {
    folder_.write("a.toml", timeline);
    expect_failure(folder_, {"info", "a.toml", "--check"}, 3, {part});
    const Outcome without = run_well({"info", "a.toml"});
    EXPECT_NE(without.error.find("warning: cannot be rendered: "), std::string::npos) << without.error;
    EXPECT_NE(info("a.toml")["problem"].get<std::string>().find(part), std::string::npos);
  }
}

}  // namespace
}  // namespace brume::cli
