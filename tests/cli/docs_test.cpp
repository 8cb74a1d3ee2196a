// The commands of the first pages and of --help run as written; those of the other pages: docs_all_test.cpp.
#include <sstream>

#include "apps/cli/demo_picture.hpp"
#include "core/file.hpp"
#include "tests/cli/documents.hpp"

namespace brume::cli {
namespace {

TEST_F(Documents, CommandsOfTheFirstPagesRun) {
  for (const char* page : {"/README.md", "/docs/first-steps.md"})
    expect_page_works(BRUME_SOURCE_DIR + std::string(page));
}

TEST_F(Documents, ExamplesOfTheHelpRun) {
  const Outcome help = run_brume(folder_.path(), {"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.error, "");
  std::vector<std::string> commands{"demo",  "render", "voxelize", "bake",  "info", "convert",
                                    "query", "diff",   "devices",  "bench", "sim"};
#ifdef BRUME_VIEWER
  commands.push_back("view");
#endif
  for (const std::string& command : commands) {
    EXPECT_NE(help.out.find("\n  " + command + " "), std::string::npos) << command;
    const Outcome text = run_brume(folder_.path(), {command, "--help"});
    EXPECT_EQ(text.exit_code, 0) << command;
    // The examples come before the options.
    const std::string examples = text.out.substr(0, text.out.find("Usage:"));
    const auto calls = calls_in(examples);
    EXPECT_FALSE(calls.empty()) << command;
    for (const auto& call : calls) expect_works(command + " --help", call);
  }
}

TEST(DocumentRules, GalleryShowsTheFrameOfTheDemo) {
  std::ostringstream call;
  call << "`brume render scenes/demo.toml -o demo.png --time " << kPictureTime << ' ';
  const auto gallery = read_text_file(BRUME_SOURCE_DIR "/docs/gallery.md");
  EXPECT_NE(gallery->find(call.str()), std::string::npos) << call.str();
}

TEST(DocumentRules, FindTheCommandsOfABlock) {
  const std::string text =
      "brume no\n```sh\nbrume a \\\n  --b \"c d\"  # e\nls\n```\n```toml\nbrume no\n```\n";
  EXPECT_EQ(calls_in(shell_blocks(text)), (std::vector<std::vector<std::string>>{{"a", "--b", "c d"}}));
}

}  // namespace
}  // namespace brume::cli
