// What the command line says about itself: help, version, mistakes, and errors as JSON.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

class CommandLineTest : public RoomTest {
 protected:
  // The one line of a wrong command line, without what every one of them ends in.
  std::string refusal(const Arguments& arguments) const {
    SCOPED_TRACE(testing::PrintToString(arguments));
    expect_failure(folder_, arguments, 2, {});
    const std::string line = run(arguments).error;
    const std::string message = line.substr(7, line.size() - 8);
    return message.substr(0, message.find("; see brume "));
  }
};

TEST_F(CommandLineTest, HelpVersionAndOverview) {
  const Outcome overview = run_well({});
  EXPECT_EQ(overview.error, "");
  for (const Arguments& same : {Arguments{"--help"}, {"-h"}, {"help"}})
    EXPECT_EQ(run(same).out, overview.out);
  EXPECT_NE(overview.out.find("\nCommands:\n  demo "), std::string::npos) << overview.out;
  EXPECT_EQ(run({"help", "sim"}).out, run({"sim", "--help"}).out);
  EXPECT_NE(run({"sim", "-h"}).out.find("--ticks N"), std::string::npos);
  const Outcome version = run_well({"-V"});
  EXPECT_EQ(version.out, run({"--version"}).out);
  for (const char* fact : {"brume ", "\ncommit ", "\ncompiler ", "\nbuild "})
    EXPECT_NE(version.out.find(fact), std::string::npos) << version.out;
}

TEST_F(CommandLineTest, HelpFitsEightyColumns) {
  for (const char* command : {"render", "sim", "voxelize", "bake", "info", "convert", "query", "diff",
                              "palettes", "devices", "bench", "demo"}) {
    const std::string help = run({command, "--help"}).out;
    std::istringstream lines(help.substr(help.find("Options:")));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << command << ": " << line;
    EXPECT_FALSE(help.ends_with("\n\n")) << command;
  }
}

TEST_F(CommandLineTest, MistakesNameWhatWasMeant) {
  EXPECT_EQ(refusal({"rendr"}), "unknown command 'rendr'; did you mean brume render?");
  EXPECT_EQ(refusal({"fly"}), "unknown command 'fly'");
  EXPECT_EQ(refusal({"room.obj"}),
            "expected a command before room.obj, such as brume render room.obj -o a.png");
  EXPECT_EQ(refusal({"render", "room.obj", "--tiem", "3"}), "unknown option --tiem; did you mean --time?");
  EXPECT_EQ(refusal({"render", "--hepl"}), "unknown option --hepl; did you mean --help?");
  EXPECT_EQ(refusal({"render", "--bogus", "1"}), "unknown option --bogus");
  EXPECT_EQ(refusal({"render", "room.obj", "-o"}), "-o: expected a value, FILE");
  EXPECT_EQ(refusal({"render", "room.obj", "--time="}), "--time: expected a value, S");
  EXPECT_EQ(refusal({"render", "room.obj", "--force=3"}), "--force: takes no value");
  EXPECT_EQ(refusal({"info", "room.obj", "b.obj"}), "unexpected argument 'b.obj'");
  EXPECT_EQ(refusal({"render", "room.obj", "-o", "a.png", "--camera", "0,1,5", "0,1,0", "60"}),
            "unexpected argument '0,1,0'; put a value with blanks into quotes, such as --camera \"0,1.7,5 "
            "0,1.5,0 60\"");
  EXPECT_EQ(refusal({"render", "room.obj", "-o", "a.png", "-o", "b.png"}), "-o: is given twice; remove one");
  EXPECT_EQ(refusal({"render", "room.obj", "-o", "a.png", "--march", "ful"}),
            "--march: unknown value 'ful'; did you mean full?");
  EXPECT_EQ(refusal({"render", "-o", "a.png"}),
            "expected INPUT: Timeline (.toml) or scene (.txt, .gltf, .glb, .obj)");
}

TEST_F(CommandLineTest, ValuesMayHaveTheNamesOfCommands) {
  for (const std::string name : {"sim", "voxelize", "bake slices"})
    EXPECT_EQ(refusal({"info", name}).rfind(name + ": unknown file suffix", 0), 0u);
  const Outcome bench = run_well({"bench", "voxelize", "--repetitions", "1", "--json", "-"});
  const Json results = Json::parse(bench.out, nullptr, false)["results"];
  ASSERT_FALSE(results.empty()) << bench.out;
  for (const Json& result : results)
    EXPECT_TRUE(result["name"].get<std::string>().starts_with("voxelize/")) << result;
  EXPECT_EQ(refusal({"bench", "render"}).rfind("no benchmark \"render\"; expected one of", 0), 0u);
}

TEST_F(CommandLineTest, ADeviceIsMissedWhereThereIsWorkForIt) {
  RunOptions without_motel, without_device;
  without_motel.environment = {{"BRUME_MOTEL", "none"}};
  without_device.environment = {{"VK_ICD_FILENAMES", "none"}, {"VK_DRIVER_FILES", "none"}};
  const std::filesystem::path folder = folder_.path();
  const Outcome motel = run_brume(folder, {"bench", "frame/motel", "voxelize/motel"}, without_motel);
  EXPECT_EQ(motel.exit_code, 5) << motel.error;
  EXPECT_EQ(motel.error.rfind("brume: nothing is measured: voxelize/motel: none/Scene.txt: not found", 0), 0u)
      << motel.error;
  const Outcome device = run_brume(folder, {"bench", "fill/1800", "lens/5"}, without_device);
  EXPECT_EQ(device.exit_code, 5) << device.error;
  EXPECT_EQ(device.out, "") << "it is missed before the first case";
  const Arguments idle{"render", "room.obj", "-o", "f_%d.png", "--frames", "0-2", "--shard", "1/9"};
  EXPECT_EQ(run_brume(folder, idle, without_device).exit_code, 0) << "it has no frame";
  const Outcome some = run_brume(folder, {"bench", "voxelize", "--repetitions", "1"}, without_motel);
  EXPECT_EQ(some.exit_code, 0) << some.error;
  EXPECT_NE(some.out.find("skipped: voxelize/motel: "), std::string::npos) << some.out;
  EXPECT_EQ(refusal({"bench", "fill/1800", "wire", "--device", "0"}),
            "--device: these benchmarks run on the processor; remove the option");
}

TEST_F(CommandLineTest, TextsAreNotEmpty) {
  for (const Arguments& words : {std::vector<std::string>{"bench", "wire", "--json", ""},
                                 {"bench", "wire", "--json="},
                                 {"bench", ""},
                                 {"render", "", "-o", "a.png"},
                                 {"render", "room.obj", "-o", ""},
                                 {"convert", "a.brv", ""},
                                 {"convert", "a.brv", "b.brv", "--grid", ""},
                                 {"sim", "room.obj", "--record", ""}})
    EXPECT_NE(refusal(words).find("expected a value"), std::string::npos) << refusal(words);
}

TEST_F(CommandLineTest, NumbersAreFiniteAndInTheirRange) {
  const auto time = [&](const std::string& text) {
    return refusal({"render", "room.obj", "-o", "a.png", "--time", text});
  };
  for (const char* text : {"nan", "inf", "-1", "3600.1", "abc", "", "1s", "0x10", "1/0", "1e999", " 1"})
    EXPECT_EQ(time(text), "--time: expected a number from 0 to 3600, found '" + std::string(text) + "'");
  EXPECT_EQ(refusal({"sim", "room.obj", "--ticks", "2.5"}),
            "--ticks: expected a whole number from 1 to 4194304, found '2.5'");
  for (const char* rate : {"nan", "0", "1001", "24000/0", "1/24", "24fps"})
    EXPECT_EQ(
        refusal({"render", "room.obj", "-o", "a.mp4", "--fps", rate}).rfind("--fps: expected a number", 0),
        0u);
}

TEST_F(CommandLineTest, OptionsThatWouldDoNothingAreRefused) {
  const auto still = [&](Arguments more) {
    more.insert(more.begin(), {"render", "room.obj", "-o", "a.png"});
    return refusal(more);
  };
  const std::string film = " requires a film (.mp4) or numbered frames, such as -o f_%04d.png";
  EXPECT_EQ(still({"--fps", "24"}), "--fps" + film + ", or --flipbook");
  EXPECT_EQ(still({"--frames", "0-1"}), "--frames" + film + ", or --flipbook");
  EXPECT_EQ(still({"--temporal"}), "--temporal" + film);
  EXPECT_EQ(still({"--light-update-fraction", "0.5"}), "--light-update-fraction" + film);
  EXPECT_EQ(still({"--resolve-error-scale", "2"}), "--resolve-error-scale requires --march half or quarter");
  EXPECT_EQ(still({"--resume"}), "--resume requires numbered frames, such as -o f_%04d.png");
  EXPECT_EQ(refusal({"info", "room.obj", "--check"}), "--check is for timelines and scenes of tanks (.toml)");
  EXPECT_EQ(refusal({"info", "room.obj", "-q", "--progress", "json"}),
            "--progress: there is none with --quiet");
  EXPECT_EQ(refusal({"info", "room.obj", "--progress", "jsn"}),
            "--progress: unknown value 'jsn'; did you mean json?");
}

TEST_F(CommandLineTest, SuffixesOfAnyCase) {
  std::filesystem::copy(folder_.path() / "room.obj", folder_.path() / "ROOM.OBJ");
  folder_.write("ROOM.TOML", "version = 1\nscene = \"ROOM.OBJ\"\nduration = 0.1\n");
  for (const Arguments& call : {Arguments{"info", "ROOM.OBJ"},
                                {"info", "ROOM.TOML"},
                                {"sim", "ROOM.TOML"},
                                {"voxelize", "ROOM.OBJ", "-o", "A.VXL"},
                                {"info", "A.VXL"},
                                {"render", "ROOM.TOML", "-o", "A.PNG", "--size", "16x16"},
                                {"render", "ROOM.TOML", "-o", "A.MP4", "--size", "16x16", "--frames", "0-0"},
                                {"info", "A.PNG"}}) {
    run_well(call);
  }
  EXPECT_EQ(refusal({"sim", "room.xyz"}),
            "room.xyz: unknown file suffix; expected .txt, .gltf, .glb, .obj, .toml, .vdb, .nvdb, .brv, "
            ".json or .spheres");
}

TEST_F(CommandLineTest, PointsWithBlanksAndPercentSignsInNames) {
  for (const char* camera :
       {"0,1,1.5 0,1,0", "0,1,1.5  0,1,0 60", "0, 1, 1.5, 0, 1, 0 60", "0,1,1.5, 0,1,0, 60"}) {
    run_well({"render", "room.obj", "-o", "100%.png", "--size", "16x16", "--camera", camera, "--smoke",
              "0, 1, -1", "--force"});
  }
  run_well({"render", "room.obj", "-o", "a%%d.png", "--size", "16x16"});
  EXPECT_EQ(folder_.files(), (Arguments{"100%.png", "a%d.png", "room.obj"}));
  EXPECT_EQ(refusal({"render", "room.obj", "-o", "a.png", "--smoke", "1e9,0,0"}),
            "--smoke '1e9,0,0': expected coordinates within 16384 m");
}

TEST_F(CommandLineTest, ErrorsAreJsonWhereResultsWere) {
  const auto error_of = [&](const Arguments& arguments) {
    const Outcome failed = run(arguments);
    const Json json = Json::parse(failed.out, nullptr, false);
    EXPECT_EQ(json["schema"], 1) << failed.out;
    EXPECT_EQ(json["command"], arguments[0]);
    EXPECT_EQ(json["error"]["code"], failed.exit_code);
    EXPECT_EQ("brume: " + json["error"]["message"].get<std::string>() + "\n", failed.error);
    return json["error"]["kind"].get<std::string>();
  };
  EXPECT_EQ(error_of({"info", "none.obj", "--json", "-"}), "bad_input");
  EXPECT_EQ(error_of({"info", "room.obj", "--json", "-", "--bogus"}), "usage");
  EXPECT_EQ(error_of({"voxelize", "room.obj", "--voxel", "0.00001", "--json=-"}), "resource_limit");

  // In the file, if the command may write it: not over an input, nor before the command line is understood.
  EXPECT_EQ(run({"voxelize", "none.obj", "--json", "a.json"}).exit_code, 3);
  EXPECT_EQ(Json::parse(*read_text_file(folder_.path() / "a.json"))["error"]["kind"], "bad_input");
  const std::string before = *read_text_file(folder_.path() / "room.obj");
  EXPECT_EQ(run({"info", "room.obj", "--json", "room.obj"}).exit_code, 2);
  EXPECT_EQ(run({"info", "room.obj", "--json", "room.obj", "--bogus"}).exit_code, 2);
  EXPECT_EQ(*read_text_file(folder_.path() / "room.obj"), before);

  // Nor over what a scene refers to that is read, or would be if its loading had not failed before.
  folder_.write("room.mtl", "newmtl wall\n");
  folder_.write("with.obj", "mtllib room.mtl\n" + room_obj());
  folder_.write("broken.obj", "v 0 0 zero\nmtllib room.mtl\n");
  EXPECT_EQ(run({"info", "with.obj", "--json", "room.mtl", "--force"}).exit_code, 2);
  EXPECT_EQ(run({"info", "broken.obj", "--json", "room.mtl", "--force"}).exit_code, 3);
  EXPECT_EQ(*read_text_file(folder_.path() / "room.mtl"), "newmtl wall\n");
}

}  // namespace
}  // namespace brume::cli
