// script/compare-cycles: the path tracer is as bright as Cycles, and the script notices where it is not.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

bool has_blender() {
  return std::system("command -v blender > /dev/null 2>&1") == 0;
}

Outcome compare_cycles(const WorkFolder& folder, std::vector<std::string> arguments) {
  RunOptions options;
  options.program = BRUME_SOURCE_DIR "/script/compare-cycles";
  arguments.insert(arguments.begin(), "found");
  return run_brume(folder.path(), arguments, options);
}

nlohmann::json rows_of(const WorkFolder& folder) {
  return nlohmann::json::parse(*read_text_file(folder.path() / "found/results.json")).at("scenes");
}

// Lambert's law, an emitter, a sky, metals with a normal map and a medium. The script's own bound: 1 % and
// three standard errors of each part and of the picture; the latter are about 0.1 % here, 0.3 % with the
// medium.
TEST(CompareCyclesTest, TheSameModelsAreEquallyBright) {
  if (!has_blender()) GTEST_SKIP() << "blender is not installed; script/bootstrap test installs it";
  const WorkFolder folder;
  const Outcome outcome = compare_cycles(
      folder, {"--scene", "walls", "--scene", "panel_and_sky", "--scene", "metals", "--scene", "fog_sphere",
               "--size", "48x36", "--samples", "64", "--brume-samples", "256", "--build", BRUME_BUILD_DIR});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.error;
  std::size_t same = 0;
  for (const nlohmann::json& row : rows_of(folder)) {
    const std::string name =
        row.at("scene").get<std::string>() + ", " + row.at("surfaces").get<std::string>();
    // That the comparison is worth something: a difference of 2.5 % of any picture is noticed.
    EXPECT_LT(row.at("whole_error").get<double>(), 0.005) << name;
    EXPECT_GE(row.at("parts").get<int>(), 11) << name;
    if (row.at("same_model").get<bool>()) {
      ++same;
      EXPECT_TRUE(row.at("agrees").get<bool>()) << name;
    } else {
      EXPECT_FALSE(row.at("agrees").get<bool>()) << name << ": documented differences";
    }
  }
  EXPECT_EQ(same, 4u);
}

// A renderer that ends paths early is too dark by more than noise.
TEST(CompareCyclesTest, LightThatIsMissingIsNoticed) {
  if (!has_blender()) GTEST_SKIP() << "blender is not installed; script/bootstrap test installs it";
  const WorkFolder folder;
  folder.write("brume", "#!/bin/sh\ncase \" $* \" in\n*' --mode reference '*) exec '" BRUME_PROGRAM
                        "' \"$@\" --max-bounces 3 ;;\nesac\nexec '" BRUME_PROGRAM "' \"$@\"\n");
  std::filesystem::permissions(folder.path() / "brume", std::filesystem::perms::owner_all);
  const Outcome outcome =
      compare_cycles(folder, {"--scene", "panel_and_sky", "--size", "32x24", "--samples", "32", "--seeds",
                              "4", "--brume-samples", "128", "--build", folder.path().string()});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out << outcome.error;
  const nlohmann::json rows = rows_of(folder);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_FALSE(rows[0].at("agrees").get<bool>());
  EXPECT_GT(rows[0].at("off").get<int>(), 0);
  EXPECT_LT(rows[0].at("whole").get<double>(), -0.01);
}

// The means, errors and rules of the comparison, and the reader of images.
TEST(CompareCyclesTest, RegionsAndImagesAreRight) {
  const WorkFolder folder;
  RunOptions options;
  options.program = "/usr/bin/python3";
  const Outcome outcome =
      run_brume(folder.path(), {"-B", BRUME_SOURCE_DIR "/tests/peers/regions_test.py"}, options);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_NE(outcome.error.find("\nOK"), std::string::npos) << outcome.error;
}

TEST(CompareCyclesTest, NamesWhatIsWrong) {
  if (!has_blender()) GTEST_SKIP() << "blender is not installed; script/bootstrap test installs it";
  const WorkFolder folder;
  const Outcome size = compare_cycles(folder, {"--size", "1x"});
  EXPECT_EQ(size.exit_code, 2);
  EXPECT_NE(size.error.find("expected WIDTHxHEIGHT"), std::string::npos) << size.error;
  const Outcome build = compare_cycles(folder, {"--build", "nowhere"});
  EXPECT_EQ(build.exit_code, 1);
  EXPECT_NE(build.error.find("nowhere/brume is missing"), std::string::npos) << build.error;
  EXPECT_TRUE(folder.files().empty());
}

}  // namespace
}  // namespace brume::cli
