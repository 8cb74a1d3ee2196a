#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

// A room in which a smoke, a shot and a blast happen within two seconds.
class Sim : public RoomTest {
 protected:
  Sim() {
    folder_.write("room.toml",
                  "version = 1\nscene = \"room.obj\"\nduration = 2.0\n[smoke]\nvoxels = 300\nbloom = 0.5\n"
                  "[[event]]\ntype = \"smoke\"\ntime = 0.1\nfrom = [-1, 1.5, 0]\nat = [1, 0.5, 1]\n"
                  "[[event]]\ntype = \"shot\"\ntime = 0.8\nfrom = [-1, 1.5, 0]\ntoward = [1, 1, 1]\n"
                  "[[event]]\ntype = \"blast\"\ntime = 1.0\nat = [0, 1, 0]\nradius = 1.0\n");
  }
};

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST_F(Sim, HashesDoNotDependOnTheNumberOfThreads) {
  const std::string one = run_well({"sim", "room.toml", "--ticks", "128", "--hash", "--threads", "1"}).out;
  const auto lines = lines_of(one);
  ASSERT_EQ(lines.size(), 128u);
  EXPECT_EQ(lines[0].size(), 2u + 16u);
  EXPECT_EQ(lines[127].substr(0, 4), "127 ");
  for (const char* threads : {"2", "7"})
    EXPECT_EQ(run_well({"sim", "room.toml", "--ticks", "128", "--hash", "--threads", threads}).out, one);
  // The duration is 128 ticks; without --hash only the last one is printed.
  EXPECT_EQ(run_well({"sim", "room.toml"}).out,
            "128 ticks simulated; state hash of the last " + lines[127].substr(4) + "\n");
}

TEST_F(Sim, RecordingsReplay) {
  const Outcome recorded = run_well({"sim", "room.toml", "--record", "room.brp", "--json", "-"});
  const Json result = Json::parse(recorded.out);
  EXPECT_EQ(result["ticks"], 128);
  EXPECT_EQ(result["ticks_per_second"], 64);
  // The recording does not depend on other files.
  std::filesystem::remove(folder_.path() / "room.obj");
  std::filesystem::remove(folder_.path() / "room.toml");
  EXPECT_EQ(folder_.files(), Arguments{"room.brp"});
  const Json again = json_of({"sim", "--replay", "room.brp"});
  EXPECT_EQ(again["hash"], result["hash"]);
  EXPECT_EQ(again["same"], true);
  EXPECT_EQ(lines_of(run_well({"sim", "--replay", "room.brp", "--hash"}).out).size(), 129u);
}

TEST_F(Sim, TickRatesAreDifferentSimulations) {
  const Json slow = json_of({"sim", "room.toml", "--rate", "20"});
  EXPECT_EQ(slow["ticks"], 40);
  EXPECT_EQ(slow["ticks_per_second"], 20);
}

TEST_F(Sim, ReportsWhereEachSmokeGoesOff) {
  for (const char* command : {"sim", "info"}) {
    const Json result = json_of({command, "room.toml"});
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

TEST_F(Sim, ScalesScenes) {
  const auto origin = [&](const char* scale) {
    run_well({"sim", "room.obj", "--scale", scale, "--ticks", "1", "--record", "a.brp"});
    return json_of({"info", "a.brp"})["origin"][0].get<double>();
  };
  EXPECT_LT(origin("10"), 5 * origin("1"));
}

TEST_F(Sim, FailuresAreOneLine) {
  run_well({"sim", "room.toml", "--ticks", "20", "--record", "room.brp"});
  std::string bytes = this->bytes("room.brp");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  folder_.write("damaged.brp", bytes);
  const auto refused = [&](const Arguments& arguments, int code, const std::string& part) {
    expect_failure(folder_, arguments, code, {part});
  };
  refused({"sim"}, 2, "--replay");
  refused({"sim", "room.toml", "--replay", "room.brp"}, 2, "needs no timeline");
  refused({"sim", "--replay", "room.brp", "--ticks", "3"}, 2, "--ticks");
  refused({"sim", "room.toml", "--ticks", "0"}, 2, "--ticks");
  refused({"sim", "room.toml", "--rate", "1001"}, 2, "--rate");
  refused({"sim", "--replay", "room.brp", "--volumes", "a.brv"}, 2, "--volumes");
  refused({"sim", "room.toml", "--frames", "0-1"}, 2, "--frames");
  refused({"sim", "room.toml", "--volumes", "a.raw"}, 2, "a.raw: unknown file suffix");
  refused({"sim", "room.toml", "--volumes", "a_%s.brv"}, 2, "%04d");
  refused({"sim", "room.toml", "--detail", "0.1"}, 2, "--volumes");
  refused({"sim", "room.toml", "--volumes", "a.brv", "--detail", "0.1", "--rate", "60"}, 2, "--rate");
  refused({"sim", "room.toml", "--volumes", "a.brv", "--fps", "30"}, 2, "numbered files");
  refused({"sim", "room.toml", "--volumes", "a_%d.brv", "--frames", "8-9", "--ticks", "20"}, 2, "tick 24");
  refused({"sim", "none.toml"}, 3, "none.toml");
  refused({"sim", "--replay", "none.brp"}, 3, "none.brp");
  refused({"sim", "--replay", "room.toml"}, 2, "room.toml: unknown file suffix; expected .brp");
  refused({"sim", "--replay", "damaged.brp"}, 3, "damaged.brp");
  refused({"sim", "room.toml", "--record", "none/room.brp"}, 2, "none");
}

}  // namespace
}  // namespace brume::cli
