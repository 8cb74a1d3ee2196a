// Bakes and conversions of many numbered files: --frames, --shard and --resume.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

class Units : public CommandTest {
 protected:
  Outcome run(const Arguments& arguments, const Arguments& more = {}) const {
    return run_well(arguments, more);
  }
  /// The files whose names begin so, hidden ones too.
  Files files(const std::string& start) const {
    Files files;
    for (const std::string& name : folder_.files())
      if (name.starts_with(start) || name.starts_with("." + start))
        files[name] = read_text_file(folder_.path() / name).value_or_throw();
    return files;
  }
  void remove(const std::string& start) const {
    for (const auto& [name, bytes] : files(start)) fs::remove(folder_.path() / name);
  }
  /// Clouds cloud_1.brv to cloud_3.brv.
  void make_clouds() const {
    run({"bake", "pyroclastic", "-o", "cloud_%d.brv", "--edge", "16", "--frames", "1-3"});
  }

  const Arguments tanks_ =
      words("bake spheres -o tank_%02d.spheres --size 20x20x20 --count 20 --radius 1-3 --frames 3-7");
  const Arguments slices_ = words("bake slices cloud_%d.brv -o s_%d.png --frames 1-3");
};

// The shards cover all units, each once, and differ by at most one unit.
TEST_F(Units, OfAllShardsAreThoseOfTheWhole) {
  run(tanks_);
  const Files whole = files("tank_");
  ASSERT_EQ(whole.size(), 10u) << "five tanks and their keys";
  EXPECT_NE(whole.at("tank_03.spheres"), whole.at("tank_04.spheres")) << "each has a seed of its own";
  for (const int count : {2, 3, 7}) {
    remove("tank_");
    std::size_t before = 0;
    for (int number = count; number >= 1; --number) {
      run(tanks_, {"--shard", std::to_string(number) + "/" + std::to_string(count)});
      const std::size_t now = files("tank_").size() / 2, units = now - before;
      EXPECT_GE(units, static_cast<std::size_t>(5 / count));
      EXPECT_LE(units, static_cast<std::size_t>((5 + count - 1) / count));
      before = now;
    }
    EXPECT_EQ(before, 5u);
    EXPECT_EQ(files("tank_"), whole) << count;
  }
}

TEST_F(Units, AnAdditionToTheSeedNumbersThem) {
  run(tanks_);
  Arguments one(tanks_.begin(), tanks_.end() - 2);
  one[3] = "one.spheres";
  run(one, {"--seed", "5"});
  EXPECT_EQ(*read_text_file(folder_.path() / "one.spheres"), files("tank_").at("tank_05.spheres"));
  EXPECT_FALSE(fs::exists(folder_.path() / ".one.spheres.key"));
}

TEST_F(Units, ResumingMakesWhatIsMissingDamagedOrOfOtherInputs) {
  make_clouds();
  EXPECT_EQ(run(slices_, {"--resume"}).error, "brume: frames 1-3: missing\n");
  const Files whole = files("s_");
  ASSERT_EQ(whole.size(), 9u) << "an image, a description and a key each";
  for (const auto& [name, bytes] : whole)
    EXPECT_TRUE(name.ends_with(".png") || name.ends_with(".json") || name.starts_with('.'))
        << name << " would be imported with the textures";
  const Outcome nothing = run(slices_, {"--resume"});
  EXPECT_EQ(nothing.out + nothing.error, "");

  // Every file of a unit counts.
  const auto check = [&](const std::string& reasons) {
    EXPECT_EQ(run(slices_, {"--resume"}).error, reasons);
    EXPECT_EQ(files("s_"), whole);
    EXPECT_EQ(run(slices_, {"--resume"}).error, "");
  };
  fs::remove(folder_.path() / "s_1.json");
  folder_.write("s_2.json", whole.at("s_1.json"));
  folder_.write("s_3.png", whole.at("s_3.png").substr(0, 40));
  check("brume: frame 1: missing\nbrume: frames 2-3: damaged; made again\n");
  fs::remove(folder_.path() / ".s_2.png.key");
  folder_.write(".s_3.png.key", whole.at(".s_1.png.key"));
  check("brume: frame 2: without a key; made again\nbrume: frame 3: of another number; made again\n");
  folder_.write(".s_1.png.key", whole.at(".s_1.png.key").substr(0, 30));
  folder_.write(".s_3.png.key", "BRUMEKEY");
  check(
      "brume: frame 1: of other settings, another program; made again\nbrume: frame 3: without a key; made "
      "again\n");

  // Inputs by their contents, not by their times.
  const Files clouds = files("cloud_");
  folder_.write("cloud_1.brv", clouds.at("cloud_1.brv"));
  check("");
  folder_.write("cloud_2.brv", clouds.at("cloud_1.brv"));
  EXPECT_EQ(run(slices_, {"--resume"}).error, "brume: frame 2: of other inputs; made again\n");
  EXPECT_EQ(files("s_").at("s_2.png"), whole.at("s_1.png"));
  folder_.write("cloud_2.brv", clouds.at("cloud_2.brv"));
  check("brume: frame 2: of other inputs; made again\n");
  EXPECT_EQ(run(slices_, {"--resume", "--padding", "1"}).error,
            "brume: frames 1-3: of other settings; made again\n");
}

TEST_F(Units, ConversionsOfASequence) {
  make_clouds();
  const Arguments convert{"convert", "cloud_%d.brv", "c_%02d.nvdb", "--frames", "1-3"};
  run(convert, {"--shard", "1/2"});
  EXPECT_EQ(run(convert, {"--resume"}).error, "brume: frames 2-3: missing\n");
  run({"convert", "cloud_2.brv", "alone.nvdb"});
  EXPECT_EQ(files("c_").at("c_02.nvdb"), files("alone").at("alone.nvdb"));
  EXPECT_EQ(files("c_").size(), 6u);
}

TEST_F(Units, ConversionsSkipMissingNumbers) {
  make_clouds();
  fs::rename(folder_.path() / "cloud_3.brv", folder_.path() / "cloud_6.brv");
  const Arguments convert{"convert", "cloud_%03d.brv", "c_%02d.nvdb"};
  const std::string skipped =
      "brume: warning: cloud_%03d.brv: 3 of the numbers 1-6 have no file and are skipped\n";
  EXPECT_EQ(run(convert).error, skipped);
  const Files whole = files("c_");
  ASSERT_EQ(whole.size(), 6u);
  for (const char* name : {"c_01.nvdb", "c_02.nvdb", "c_06.nvdb"}) EXPECT_TRUE(whole.contains(name)) << name;
  fs::remove(folder_.path() / "c_06.nvdb");
  EXPECT_EQ(run(convert, {"--resume"}).error, skipped + "brume: frame 6: missing\n");
  EXPECT_EQ(files("c_"), whole);
  remove("c_");
  for (const char* shard : {"1/2", "2/2"}) run(convert, {"--shard", shard});
  EXPECT_EQ(files("c_"), whole);

  // Numbers that do not count are none of those that are written.
  folder_.write("cloud_2.brv", "damaged");
  const Outcome stopped = run_brume(folder_.path(), convert);
  EXPECT_NE(stopped.error.find("; 1 of 3 frames written; continue with --resume\n"), std::string::npos)
      << stopped.error;
  // A choice of numbers requires them, under the names of the pattern.
  const Outcome chosen =
      run_brume(folder_.path(), {"convert", "cloud_%03d.brv", "d_%d.nvdb", "--frames", "3-6"});
  EXPECT_NE(chosen.error.find("cloud_003.brv: cannot open"), std::string::npos) << chosen.error;
}

TEST_F(Units, OcclusionOfPoses) {
  for (const char* name : {"pose_0.obj", "pose_1.obj"}) folder_.write(name, room_obj());
  run({"bake", "occlusion", "pose_%d.obj", "-o", "ao_%d.png", "--size", "4x4x4", "--rays", "2", "--frames",
       "0-1"});
  const Files made = files("ao_");
  ASSERT_EQ(made.size(), 6u);
  EXPECT_EQ(made.at("ao_0.png"), made.at("ao_1.png"));
}

TEST_F(Units, AFailureNamesItsUnitAndKeepsTheOthers) {
  make_clouds();
  fs::remove(folder_.path() / "cloud_2.brv");
  const Arguments convert{"convert", "cloud_%d.brv", "c_%d.nvdb", "--frames", "1-3"};
  const Outcome stopped = run_brume(folder_.path(), convert);
  EXPECT_EQ(stopped.exit_code, 6);
  EXPECT_NE(stopped.error.find("cloud_2.brv: cannot open"), std::string::npos) << stopped.error;
  EXPECT_NE(stopped.error.find("1 of 3 frames written; continue with --resume\n"), std::string::npos)
      << stopped.error;
  make_clouds();
  EXPECT_EQ(run(convert, {"--resume"}).error, "brume: frames 2-3: missing\n");
}

// An engine shows the atlases of a sequence by one range, in one place.
TEST_F(Units, AtlasesOfASequenceHaveOneBoxAndOneRange) {
  // Frame 2 is missing, frame 3 is larger and denser.
  const auto ball = [&](const std::string& name, const std::string& edge) {
    run({"bake", "sphere", "-o", name, "--edge", edge, "--voxel", "0.1"});
  };
  ball("cloud_1.brv", "16");
  ball("cloud_3.brv", "32");
  run({"bake", "slices", "cloud_####.brv", "-o", "s_%d.png"});
  const Files made = files("s_");
  ASSERT_EQ(made.size(), 9u) << "from the first number that exists to the last";
  EXPECT_EQ(made.at("s_1.png"), made.at("s_2.png")) << "which is held";
  EXPECT_NE(made.at("s_1.png"), made.at("s_3.png"));
  const auto box_of = [&](const std::string& name) {
    const std::string& text = made.at(name);
    return text.substr(text.find("\"box\""), text.find('}', text.find("\"box\"")) - text.find("\"box\""));
  };
  EXPECT_EQ(box_of("s_1.json"), box_of("s_3.json"));
  // A range of one frame alone, of a value that the other does not have.
  folder_.write("a_1.json",
                R"({"format": "brume raw volume", "version": 1, "raw": "a_1.raw", "size": [1, 1, 2]})");
  folder_.write("a_2.json",
                R"({"format": "brume raw volume", "version": 1, "raw": "a_2.raw", "size": [1, 1, 2]})");
  const auto raw = [](float a, float b) {
    std::string bytes(8, '\0');
    std::memcpy(bytes.data(), &a, 4);
    std::memcpy(bytes.data() + 4, &b, 4);
    return bytes;
  };
  folder_.write("a_1.raw", raw(1, 2));
  folder_.write("a_2.raw", raw(0.5f, 8));
  run({"bake", "slices", "a_%d.json", "-o", "r_%d.png"});
  const Files ranges = files("r_");
  for (const std::string name : {"r_1.json", "r_2.json"}) {
    std::string text = ranges.at(name);
    std::erase_if(text, [](char c) { return c == ' ' || c == '\n'; });
    EXPECT_NE(text.find("\"range\":[0.0,8.0]"), std::string::npos) << text;
  }
}

// Interrupted before each of its calls: what it says is what is there.
TEST_F(Units, AnInterruptedUnitSaysWhichOfItsFilesAreThere) {
  const Arguments clouds{"bake", "pyroclastic", "-o", "cloud_%d.brv", "--edge", "16", "--frames", "1-2"};
  RunOptions options;
  options.signal = SIGTERM;
  options.signal_at = ~std::uint64_t{0};
  const std::uint64_t calls = run_brume(folder_.path(), clouds, options).file_calls;
  ASSERT_GT(calls, 0u);
  int without_key = 0;
  for (options.signal_at = 1; options.signal_at <= calls; ++options.signal_at) {
    SCOPED_TRACE(options.signal_at);
    remove("cloud_");
    const Outcome stopped = run_brume(folder_.path(), clouds, options);
    const Files made = files("cloud_");
    ASSERT_TRUE(stopped.exit_code == 0 || stopped.exit_code == 6 || stopped.exit_code == 128 + SIGTERM);
    EXPECT_EQ(stopped.exit_code == 128 + SIGTERM, made.empty()) << stopped.error;
    EXPECT_EQ(stopped.exit_code == 0, made.size() == 4) << stopped.error;
    const bool has_no_key = made.contains("cloud_1.brv") && !made.contains(".cloud_1.brv.key");
    without_key += has_no_key ? 1 : 0;
    if (has_no_key) {
      EXPECT_EQ(stopped.error,
                "brume: interrupted; 0 of 2 frames written; of the next, written: cloud_1.brv; not written: "
                ".cloud_1.brv.key; continue with --resume\n");
    }
  }
  EXPECT_GT(without_key, 0);
}

TEST_F(Units, FilesOfAllUnitsAreCheckedBeforeTheFirst) {
  make_clouds();
  const Arguments convert{"convert", "cloud_%d.brv", "c_%d.nvdb", "--frames", "1-3"};
  fs::create_directory(folder_.path() / ".c_3.nvdb.key");
  expect_failure(folder_, convert, 2, {".c_3.nvdb.key: is a folder"});
  fs::remove(folder_.path() / ".c_3.nvdb.key");
  folder_.write(".c_2.nvdb.key", "a poem");
  expect_failure(folder_, convert, 2, {".c_2.nvdb.key: exists and is no ", "--force"});
  folder_.write("s_3.json", "[1, 2]");
  expect_failure(folder_, slices_, 2, {"s_3.json: exists and is no ", "--force"});
  fs::create_directory(folder_.path() / "c_3.raw");
  expect_failure(folder_, {"convert", "cloud_%d.brv", "c_%d.json", "--frames", "1-3"}, 2,
                 {"c_3.raw: is a folder"});
}

TEST_F(Units, ShardsAreWholeNumbers) {
  make_clouds();
  for (const char* shard : {"1.0/2", "1/2x", "0/2", "3/2", "1/2/2", "+1/2", "1e0/2", " 1/2", "-1/2", "1/",
                            "/2", "/", "1", "0x1/2", "4294967297/2", "1/1000001"})
    expect_failure(folder_, {"convert", "cloud_%d.brv", "c_%d.nvdb", "--frames", "1-3", "--shard", shard}, 2,
                   {"--shard '" + std::string(shard) + "': expected PART/PARTS"});
}

TEST_F(Units, RefusesWhatIsNotNumbered) {
  make_clouds();
  const auto refuse = [&](const Arguments& arguments, const std::vector<std::string>& parts) {
    expect_failure(folder_, arguments, 2, parts);
  };
  refuse({"convert", "cloud_1.brv", "c_%d.vdb", "--frames", "1-3"}, {"c_%d.vdb", "INPUT"});
  refuse({"convert", "cloud_%d.brv", "c.vdb"},
         {"OUTPUT c.vdb: requires a number, as INPUT has one, such as c_%04d.vdb"});
  refuse({"bake", "pyroclastic", "-o", "c_%d.brv"}, {"--frames"});
  refuse({"convert", "cloud_1.brv", "c.vdb", "--shard", "1/2"}, {"--shard", "c", "number"});
  refuse({"convert", "cloud_1.brv", "c.vdb", "--resume"}, {"--resume"});
  refuse({"convert", "cloud_%d.brv", "cloud_%d.brv", "--frames", "1-3"}, {"is the input"});
  refuse({"bake", "sphere", "-o", "ball_%d.brv", "--frames", "0-1"}, {"pyroclastic"});
  refuse({"bake", "spheres", "-o", "t_%d.spheres", "--frames", "0-1", "--time-limit", "1"}, {"--time-limit"});
  refuse({"bake", "spheres", "-o", "t_%d.spheres", "--frames", "0-1", "--json", "r.json"}, {"--json"});
  refuse({"bake", "slices", "cloud_%d.brv", "-o", "s_%d.png", "--frames", "1-2", "--shard", "0/2"}, {"0/2"});
}

}  // namespace
}  // namespace brume::cli
