// The commands of all documents and of the help run as written.
#include <iterator>
#include <sstream>

#include "tests/cli/documents.hpp"

namespace brume::cli {
namespace {

TEST_F(Documents, AllCommandsRun) {
  std::size_t pages = 0;
  for (const char* folder : {BRUME_SOURCE_DIR, BRUME_SOURCE_DIR "/docs"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() != ".md") continue;
      expect_page_works(entry.path());
      ++pages;
    }
  }
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

}  // namespace
}  // namespace brume::cli
