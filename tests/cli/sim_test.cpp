#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

using Arguments = std::vector<std::string>;
using Json = nlohmann::json;

// A room in which a smoke, a shot and a blast happen within two seconds.
void write_room(const WorkFolder& folder) {
  folder.write("room.obj", room_obj());
  folder.write("room.toml",
               "version = 1\nscene = \"room.obj\"\nduration = 2.0\n[smoke]\nvoxels = 300\nbloom = 0.5\n"
               "[[event]]\ntype = \"smoke\"\ntime = 0.1\nfrom = [-1, 1.5, 0]\nat = [1, 0.5, 1]\n"
               "[[event]]\ntype = \"shot\"\ntime = 0.8\nfrom = [-1, 1.5, 0]\ntoward = [1, 1, 1]\n"
               "[[event]]\ntype = \"blast\"\ntime = 1.0\nat = [0, 1, 0]\nradius = 1.0\n");
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

Outcome run_well(const WorkFolder& folder, const Arguments& arguments) {
  Outcome run = run_brume(folder.path(), arguments);
  EXPECT_EQ(run.exit_code, 0) << run.error;
  return run;
}

TEST(Sim, HashesDoNotDependOnTheNumberOfThreads) {
  const WorkFolder folder;
  write_room(folder);
  const std::string one =
      run_well(folder, {"sim", "room.toml", "--ticks", "128", "--hash", "--threads", "1"}).out;
  const auto lines = lines_of(one);
  ASSERT_EQ(lines.size(), 128u);
  EXPECT_EQ(lines[0].size(), 2u + 16u);
  EXPECT_EQ(lines[127].substr(0, 4), "127 ");
  for (const char* threads : {"2", "7"})
    EXPECT_EQ(run_well(folder, {"sim", "room.toml", "--ticks", "128", "--hash", "--threads", threads}).out,
              one);
  // The duration is 128 ticks; without --hash only the last one is printed.
  EXPECT_EQ(run_well(folder, {"sim", "room.toml"}).out,
            "128 ticks simulated; state hash of the last " + lines[127].substr(4) + "\n");
}

TEST(Sim, RecordingsReplay) {
  const WorkFolder folder;
  write_room(folder);
  const Outcome recorded = run_well(folder, {"sim", "room.toml", "--record", "room.brp", "--json", "-"});
  const Json result = Json::parse(recorded.out);
  EXPECT_EQ(result["ticks"], 128);
  EXPECT_EQ(result["ticks_per_second"], 64);
  // The recording does not depend on other files.
  std::filesystem::remove(folder.path() / "room.obj");
  std::filesystem::remove(folder.path() / "room.toml");
  EXPECT_EQ(folder.files(), Arguments{"room.brp"});
  const Json again = Json::parse(run_well(folder, {"sim", "--replay", "room.brp", "--json", "-"}).out);
  EXPECT_EQ(again["hash"], result["hash"]);
  EXPECT_EQ(again["same"], true);
  EXPECT_EQ(lines_of(run_well(folder, {"sim", "--replay", "room.brp", "--hash"}).out).size(), 129u);
}

TEST(Sim, TickRatesAreDifferentSimulations) {
  const WorkFolder folder;
  write_room(folder);
  const Json slow = Json::parse(run_well(folder, {"sim", "room.toml", "--rate", "20", "--json", "-"}).out);
  EXPECT_EQ(slow["ticks"], 40);
  EXPECT_EQ(slow["ticks_per_second"], 20);
}

TEST(Sim, ReportsWhereEachSmokeGoesOff) {
  const WorkFolder folder;
  write_room(folder);
  for (const char* command : {"sim", "info"}) {
    const Json result = Json::parse(run_well(folder, {command, "room.toml", "--json", "-"}).out);
    EXPECT_EQ(result["schema"], 1);
    EXPECT_EQ(result["command"], command);
    ASSERT_EQ(result["smokes"].size(), 1u) << command;
    const Json& smoke = result["smokes"][0];
    EXPECT_EQ(smoke["voxels"], 300);
    EXPECT_EQ(smoke["budget"], 300);
    EXPECT_EQ(smoke["fault"], "none");
    // Thrown at 0.1 s from -1, 1.5, 0 at 20 m/s; the block in the room stops it before its target.
    const double x = smoke["place"][0].get<double>() + 1, y = smoke["place"][1].get<double>() - 1.5,
                 z = smoke["place"][2].get<double>();
    EXPECT_NEAR(smoke["time"].get<double>(), 0.1 + std::sqrt(x * x + y * y + z * z) / 20, 1.5 / 64);
    EXPECT_LT(x, 2);
    EXPECT_EQ(smoke["defined_at"].get<std::string>().rfind("room.toml:", 0), 0u);
  }
}

TEST(Sim, ScalesScenes) {
  const WorkFolder folder;
  write_room(folder);
  const auto origin = [&](const char* scale) {
    run_well(folder, {"sim", "room.obj", "--scale", scale, "--ticks", "1", "--record", "a.brp"});
    return Json::parse(run_well(folder, {"info", "a.brp", "--json", "-"}).out)["origin"][0].get<double>();
  };
  EXPECT_LT(origin("10"), 5 * origin("1"));
}

TEST(Sim, FailuresAreOneLine) {
  const WorkFolder folder;
  write_room(folder);
  run_well(folder, {"sim", "room.toml", "--ticks", "20", "--record", "room.brp"});
  std::string bytes = *read_text_file(folder.path() / "room.brp");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  folder.write("damaged.brp", bytes);
  const auto files = folder.files();
  const auto expect_failure = [&](const Arguments& arguments, int code, const std::string& part) {
    const Outcome run = run_brume(folder.path(), arguments);
    EXPECT_EQ(run.exit_code, code) << run.error;
    EXPECT_EQ(lines_of(run.error).size(), 1u) << run.error;
    EXPECT_NE(run.error.find(part), std::string::npos) << run.error;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(folder.files(), files);
  };
  expect_failure({"sim"}, 2, "--replay");
  expect_failure({"sim", "room.toml", "--replay", "room.brp"}, 2, "needs no timeline");
  expect_failure({"sim", "--replay", "room.brp", "--ticks", "3"}, 2, "--ticks");
  expect_failure({"sim", "room.toml", "--ticks", "0"}, 2, "--ticks");
  expect_failure({"sim", "room.toml", "--rate", "1001"}, 2, "--rate");
  expect_failure({"sim", "--replay", "room.brp", "--volumes", "a.brv"}, 2, "--volumes");
  expect_failure({"sim", "room.toml", "--frames", "0-1"}, 2, "--frames");
  expect_failure({"sim", "room.toml", "--volumes", "a.raw"}, 2, "a.raw: unknown file suffix");
  expect_failure({"sim", "room.toml", "--volumes", "a_%s.brv"}, 2, "%04d");
  expect_failure({"sim", "room.toml", "--detail", "0.1"}, 2, "--volumes");
  expect_failure({"sim", "room.toml", "--volumes", "a.brv", "--detail", "0.1", "--rate", "60"}, 2, "--rate");
  expect_failure({"sim", "room.toml", "--volumes", "a.brv", "--fps", "30"}, 2, "numbered files");
  expect_failure({"sim", "room.toml", "--volumes", "a_%d.brv", "--frames", "8-9", "--ticks", "20"}, 2,
                 "tick 24");
  expect_failure({"sim", "none.toml"}, 3, "none.toml");
  expect_failure({"sim", "--replay", "none.brp"}, 3, "none.brp");
  expect_failure({"sim", "--replay", "room.toml"}, 2, "room.toml: unknown file suffix; expected .brp");
  expect_failure({"sim", "--replay", "damaged.brp"}, 3, "damaged.brp");
  expect_failure({"sim", "room.toml", "--record", "none/room.brp"}, 2, "none");
}

}  // namespace
}  // namespace brume::cli
