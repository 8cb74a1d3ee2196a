// The commands of all documents and of the help run as written.
#include <iterator>
#include <map>
#include <sstream>

#include "core/file.hpp"
#include "tests/cli/documents.hpp"

namespace brume::cli {
namespace {

TEST_F(Documents, AllCommandsRun) {
  std::size_t pages = 0;
  const auto check = [&](const std::filesystem::path& path) {
    if (path.extension() != ".md") return;
    expect_page_works(path);
    ++pages;
  };
  for (const auto& entry : std::filesystem::directory_iterator(BRUME_SOURCE_DIR)) check(entry.path());
  for (const auto& entry : std::filesystem::recursive_directory_iterator(BRUME_SOURCE_DIR "/docs"))
    check(entry.path());
  EXPECT_GT(pages, 0u);
}

TEST_F(Documents, ExamplesOfTheHelpRun) {
  const Outcome help = run_brume(folder_.path(), {"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.error, "");
  std::vector<std::string> commands{"demo",           "render",       "voxelize", "bake",    "bake slices",
                                    "bake occlusion", "bake spheres", "info",     "convert", "query",
                                    "diff",           "palettes",     "devices",  "bench",   "sim"};
#ifdef BRUME_VIEWER
  commands.push_back("view");
#endif
  for (const std::string& command : commands) {
    EXPECT_NE(help.out.find("\n  " + command + " "), std::string::npos) << command;
    std::istringstream words(command + " --help");
    const Outcome text = run_brume(folder_.path(), {std::istream_iterator<std::string>(words), {}});
    EXPECT_EQ(text.exit_code, 0) << command;
    // The examples come before the options.
    const std::string examples = text.out.substr(0, text.out.find("Usage:"));
    const auto calls = calls_in(examples);
    EXPECT_FALSE(calls.empty()) << command;
    for (const auto& call : calls) expect_works(command + " --help", call);
  }
}

TEST_F(Documents, PicturesOfTheGalleryRender) {
  RunOptions options;
  options.program = BRUME_SOURCE_DIR "/script/gallery";
  const Outcome run =
      run_brume(folder_.path(), {"pictures", "--quick", "--film", "--build", BRUME_BUILD_DIR}, options);
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "pictures/gallery.mp4"));
  // Those of the page.
  for (const auto& entry : std::filesystem::directory_iterator(BRUME_SOURCE_DIR "/docs/images/gallery")) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "pictures" / name)) << name;
  }
}

// Each change of a scene has an effect, be it in pictures of one sample.
TEST_F(Documents, PicturesOfTanksRender) {
  RunOptions options;
  options.program = BRUME_SOURCE_DIR "/script/aquaria-pictures";
  const Outcome run = run_brume(folder_.path(), {"pictures", "--quick", "--build", BRUME_BUILD_DIR}, options);
  ASSERT_EQ(run.exit_code, 0) << run.error;
  std::map<std::string, std::string> names;  // by content
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "pictures")) {
    const std::string name = entry.path().filename().string();
    const auto [same, is_new] = names.emplace(read_text_file(entry.path()).value_or_throw(), name);
    EXPECT_TRUE(is_new) << name << " equals " << same->second;
  }
  std::size_t found = 0;
  // The pictures of the page, but for the tanks in a level, which its own command renders.
  for (const auto& entry : std::filesystem::directory_iterator(BRUME_SOURCE_DIR "/docs/images")) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("aquaria_") || name == "aquaria_level.png") continue;
    ++found;
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "pictures" / name)) << name;
  }
  EXPECT_EQ(found, names.size());
}

}  // namespace
}  // namespace brume::cli
