// brume bake spheres, and info and convert of tanks.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>

#include "spheres/file.hpp"
#include "spheres/pack.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

class Spheres : public CommandTest {
 protected:
  /// The result of bake spheres of a small tank.
  Json bake(const std::string& output, const Arguments& more = {}) const {
    const Outcome done = run_well(
        words("bake spheres --size 60x40x20 --count 300 --radius 0.5-3 --json - -o " + output), more);
    EXPECT_EQ(done.error, "");
    return Json::parse(done.out, nullptr, false);
  }
  spheres::Tank load(const std::string& name) const {
    return spheres::load_tank(folder_.path() / name).value_or_throw();
  }
  void refused(const Arguments& more, const std::vector<std::string>& parts) const {
    expect_failure(folder_, joined({"bake", "spheres", "-o", "new.spheres"}, more), 2, parts);
  }
};

TEST_F(Spheres, AreThoseOfTheOptions) {
  const Json json = bake("a.spheres", {"--voxel", "0.01", "--distribution", "2", "--arrangement", "noise",
                                       "--noise-size", "30", "--opacity", "0.5", "--seed", "5"});
  spheres::PackOptions options;
  options.size = {60, 40, 20};
  options.voxel = 0.01f;
  options.count = 300;
  options.radius = {0.5f, 3};
  options.distribution = 2;
  options.arrangement = spheres::Arrangement::noise;
  options.noise_size = 30;
  options.seed = 5;
  const spheres::Tank expected = spheres::pack(options).value_or_throw(), tank = load("a.spheres");
  EXPECT_EQ(tank.spheres, expected.spheres);
  EXPECT_EQ(tank.size, expected.size);
  EXPECT_EQ(tank.voxel, expected.voxel);
  for (const spheres::Color color : tank.colors) EXPECT_EQ(color >> 24, 128u);
  EXPECT_EQ(json["spheres"], 300);
  EXPECT_EQ(json["count"], 300);
  EXPECT_EQ(json["timed_out"], false);
  EXPECT_EQ(json["size"], Json({60, 40, 20}));
}

TEST_F(Spheres, OfEveryArrangementAreTheSameForAnyNumberOfThreads) {
  for (const char* arrangement : {"random", "largest_first", "noise", "coral"}) {
    bake("one.spheres", {"--arrangement", arrangement, "--threads", "1"});
    bake("eight.spheres", {"--arrangement", arrangement, "--threads", "8"});
    EXPECT_EQ(bytes("one.spheres"), bytes("eight.spheres")) << arrangement;
    EXPECT_EQ(load("one.spheres").spheres.size(), 300u);
  }
}

TEST_F(Spheres, AreSummarized) {
  bake("a.spheres", {"--opacity", "0.2"});
  const spheres::Tank tank = load("a.spheres");
  const Json info = json_of({"info", "a.spheres"});
  EXPECT_EQ(info["kind"], "tank");
  EXPECT_EQ(info["spheres"], 300);
  EXPECT_EQ(info["size"], Json({60, 40, 20}));
  EXPECT_FLOAT_EQ(info["voxel_size"], 0.0025f);
  EXPECT_EQ(info["opaque"], 0);
  EXPECT_FLOAT_EQ(info["opacity"]["max"], 51 / 255.0f);
  double volume = 0, lowest = 60;
  float largest = 0;
  for (const spheres::Sphere& sphere : tank.spheres) {
    volume += 4.0 / 3 * std::acos(-1.0) * std::pow(double{sphere.radius}, 3);
    largest = std::max(largest, sphere.radius);
    lowest = std::min(lowest, double{sphere.center.x} - double{sphere.radius});
  }
  EXPECT_NEAR(info["fill"], volume / (60 * 40 * 20), 1e-12);
  EXPECT_FLOAT_EQ(info["radius"]["max"], largest);
  EXPECT_DOUBLE_EQ(info["bounds"]["min"][0], lowest);
  EXPECT_NEAR(info["world_bounds"]["min"][0], (lowest - 30) * double{tank.voxel}, 1e-12);
  EXPECT_NE(run({"info", "a.spheres"}).out.find("\nspheres         300\n"), std::string::npos);

  spheres::save_tank(folder_.path() / "none.spheres", {glm::uvec3(4), 1, {}, {}}).value_or_throw();
  EXPECT_EQ(json_of({"info", "none.spheres"})["spheres"], 0);
}

TEST_F(Spheres, AreExported) {
  run_well(
      {"bake", "spheres", "-o", "a.spheres", "--size", "30x30x30", "--count", "20", "--radius", "0.5-3"});
  const Json points = json_of({"convert", "a.spheres", "a.ply"});
  EXPECT_EQ(points["spheres"], 20);
  EXPECT_EQ(points["bytes"], bytes("a.ply").size());
  EXPECT_EQ(bytes("a.ply").rfind("ply\nformat binary_little_endian 1.0\n", 0), 0u);
  run_well({"convert", "a.spheres", "A.OBJ"});
  EXPECT_EQ(json_of({"info", "A.OBJ"})["triangles"], 20 * 1280);
  ASSERT_EQ(run({"convert", "a.spheres", "a.ply"}).exit_code, 0) << "its own it is";
  expect_failure(folder_, {"convert", "a.spheres", "a.vxl"}, 2, {"a.vxl", ".obj"});
  expect_failure(folder_, {"convert", "a.spheres", "b.ply", "--grid", "a"}, 2, {"--grid is for volumes"});
  folder_.write("text.ply", "text");
  expect_failure(folder_, {"convert", "a.spheres", "text.ply"}, 2, {"exists and is no .ply file", "--force"});
}

TEST_F(Spheres, OfHostileOptionsAreRefused) {
  refused({"--radius", "-1-5"}, {"--radius: from -1 to 5 voxels; expected 0 < least <= largest <= 100"});
  refused({"--radius", "5-2"}, {"--radius: from 5 to 2 voxels"});
  refused({"--radius", "1-400"}, {"--radius: from 1 to 400 voxels", "half of the tank's shortest side"});
  for (const char* text : {"a-b", "1-", "nan-1", "1-inf", "1,2"})
    refused({"--radius", text}, {"--radius: expected LEAST-LARGEST", text});
  refused({"--count", "1000000000"}, {"--count: expected a whole number from 0 to 8388608"});
  refused({"--count", "8388608", "--radius", "20"}, {"--count: 8388608 spheres", "the volume of the tank"});
  refused({"--size", "0x1x1"}, {"--size: 0x1x1 voxels; expected 1 to 2048 along each axis"});
  refused({"--size", "2048x2048x2048"}, {"--size: 2048x2048x2048 voxels; expected at most 268435456 in all"});
  refused({"--size", "9"}, {"--size"});
  refused({"--size", "2049x1x1"}, {"--size: 2049x1x1 voxels; expected 1 to 2048 along each axis"});
  refused({"--radius", "0.001-1"}, {"--radius: from 0.001 voxels; expected at least 0.01"});
  refused({"--arrangement", "noise", "--noise-size", "4097"},
          {"--noise-size: expected a number from 1 to 4096"});
  refused({"--voxel", "1001"}, {"--voxel: expected a number from 1e-06 to 1000"});
  refused({"--distribution", "9"}, {"--distribution: expected a number from 0 to 8"});
  refused({"--opacity", "1.1"}, {"--opacity"});
  refused({"--arrangement", "corral"}, {"--arrangement: unknown value 'corral'; did you mean coral?"});
  refused({"--noise-size", "20"}, {"--noise-size is for --arrangement noise and --coloring noise"});
  refused({"--time-limit", "0"}, {"--time-limit"});
  expect_failure(folder_, {"bake", "spheres", "-o", "a.brv"}, 2, {"-o a.brv", ".spheres"});
  EXPECT_EQ(folder_.files(), Arguments{});
}

TEST_F(Spheres, ThatDoNotFitAreFewerWithAWarning) {
  const Outcome full = run_well(
      {"bake", "spheres", "-o", "a.spheres", "--size", "20x20x20", "--count", "1500", "--radius", "1-4"});
  EXPECT_NE(full.error.find(" of 1500 spheres are packed: there is no room for more"), std::string::npos)
      << full.error;
  EXPECT_LT(load("a.spheres").spheres.size(), 1500u);
}

TEST_F(Spheres, OfNoGivenNumberAreAsManyAsTheTankHasRoomFor) {
  const Outcome one = run_well({"bake", "spheres", "-o", "one.spheres", "--size", "1x1x1"});
  EXPECT_EQ(one.error, "");
  EXPECT_EQ(one.out.rfind("1 sphere of radius ", 0), 0u) << one.out;
  EXPECT_NE(one.out.find(" fills "), std::string::npos) << one.out;
  const Outcome large = run_well({"bake", "spheres", "-o", "large.spheres", "--radius", "40-60"});
  EXPECT_EQ(large.error, "");
  EXPECT_GT(load("large.spheres").spheres.size(), 10u);
}

TEST_F(Spheres, AreArrangedByNamesOfScenesWithEitherDash) {
  const Json usual = bake("a.spheres"), dash = bake("b.spheres", {"--arrangement", "largest-first"});
  bake("c.spheres", {"--arrangement", "largest_first"});
  EXPECT_EQ(usual["arrangement"], "largest_first");
  EXPECT_EQ(dash["arrangement"], "largest_first");
  EXPECT_EQ(bytes("b.spheres"), bytes("a.spheres"));
  EXPECT_EQ(bytes("c.spheres"), bytes("a.spheres"));
}

TEST_F(Spheres, OfATimeLimitAreThosePackedByThen) {
  // More than any machine packs in a millisecond.
  const Outcome run = run_well({"bake", "spheres", "-o", "a.spheres", "--count", "8000000", "--radius",
                                "0.5-2", "--time-limit", "0.001", "--json", "-"});
  EXPECT_NE(run.error.find("--time-limit ended it"), std::string::npos) << run.error;
  const Json json = Json::parse(run.out);
  EXPECT_EQ(json["timed_out"], true);
  EXPECT_EQ(json["spheres"], load("a.spheres").spheres.size());
}

TEST_F(Spheres, OfAnInterruptedRunAreNotWritten) {
  const std::string old = "BRUMESPHold";
  folder_.write("old.spheres", old);
  RunOptions options;
  options.signal = SIGTERM;
  // While it packs more than there is room for.
  const WorkFolder reports;
  options.error_file = reports.path() / "error";
  options.signal_when = [&] { return reports_job(options.error_file, "pack spheres"); };
  const Outcome run = run_brume(folder_.path(),
                                {"bake", "spheres", "-o", "old.spheres", "--count", "8000000", "--radius",
                                 "0.5-2", "--progress", "json"},
                                options);
  EXPECT_EQ(run.exit_code, 128 + SIGTERM) << run.error;
  EXPECT_TRUE(run.error.ends_with("\nbrume: interrupted\n")) << run.error;
  EXPECT_EQ(bytes("old.spheres"), old);
  EXPECT_EQ(folder_.files(), Arguments{"old.spheres"});
}

TEST_F(Spheres, OfDamagedFilesAreRefused) {
  bake("a.spheres");
  const std::string whole = bytes("a.spheres");
  folder_.write("cut.spheres", whole.substr(0, whole.size() / 2));
  std::string many = whole;
  many[15] = '\x7f';
  folder_.write("many.spheres", many);
  folder_.write("text.spheres", "text");
  for (const Arguments& command : {Arguments{"info"}, {"convert"}}) {
    const auto with = [&](const char* file) {
      Arguments arguments = command;
      arguments.emplace_back(file);
      if (command[0] == "convert") arguments.emplace_back("a.ply");
      return arguments;
    };
    expect_failure(folder_, with("cut.spheres"), 3, {"cut.spheres: the file is truncated"});
    expect_failure(folder_, with("many.spheres"), 4, {"many.spheres: has 2130706732 spheres"});
    expect_failure(folder_, with("text.spheres"), 3, {"text.spheres: not a .spheres file"});
    expect_failure(folder_, with("none.spheres"), 3, {"none.spheres"});
  }
}

/// A scene of a tank, path-traced.
class TankScene : public Spheres {
 protected:
  TankScene() {
    write("tank.toml", 2);
    write("direct.toml", 0);
  }
  void write(const std::string& name, int bounces) const {
    folder_.write(name,
                  "version = 1\n[tank]\nsize = [24, 24, 12]\nvoxel = 0.05\nspheres = 60\nradius = [1, 4]\n"
                  "palette = \"viridis\"\nbounces = " +
                      std::to_string(bounces) +
                      "\n[[light]]\nposition = [0.5, 0.8, 1.5]\nintensity = 4\n"
                      "[[camera]]\ntime = 0\nposition = [0, 0.4, 2]\ntarget = [0, 0, 0]\nfov = 42\n");
  }
  /// The bytes of each pixel's channels.
  std::vector<std::uint8_t> render(const std::string& scene, const Arguments& more,
                                   const std::string& output = "p.png",
                                   const std::string& file = "p.png") const {
    run_well(words("render --mode reference --size 48x32 --samples 4 " + scene + " -o " + output), more);
    return png(file).rgba;
  }
  static double difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(int{a[i]} - int{b[i]});
    return sum;
  }
};

TEST_F(TankScene, TakesBouncesFromTheCommandLine) {
  const auto few = render("tank.toml", {"--time", "0", "--max-bounces", "0"});
  EXPECT_EQ(few, render("direct.toml", {"--time", "0"}));
  EXPECT_NE(few, render("tank.toml", {"--time", "0"}));
}

TEST_F(TankScene, TheCameraOrbitsItsTarget) {
  render("tank.toml", {"--orbit", "360", "--frames", "0-1"}, "f_%04d.png", "f_0001.png");
  const auto frame = [&](const char* name) { return png(name).rgba; };
  const auto front = render("tank.toml", {"--time", "0"});
  EXPECT_EQ(frame("f_0000.png"), front);
  // From behind: the same camera but for roundings, which few pixels show.
  const auto behind = render("tank.toml", {"--time", "0", "--camera", "0,0.4,-2 0,0,0 42"});
  EXPECT_LT(difference(frame("f_0001.png"), behind), 0.05 * difference(front, behind));
}

TEST_F(TankScene, RefusesOptionsOfLevels) {
  for (const char* option :
       {"--shutter=0.1", "--march=half", "--step=2", "--volume-memory=64", "--view=depth", "--voxel=0.1",
        "--scale=2", "--kelvin=900", "--smoke-size=2", "--color-map=viridis"})
    expect_failure(folder_, {"render", "tank.toml", "-o", "p.png", option}, 2,
                   {"is not for a tank of spheres"});
}

}  // namespace
}  // namespace brume::cli
