// The commands of the first pages run as written, but for the pictures of the second; those, and the commands
// of the other pages and of --help: docs_all_test.cpp.
#include <sstream>

#include "apps/cli/demo_picture.hpp"
#include "core/file.hpp"
#include "tests/cli/documents.hpp"

namespace brume::cli {
namespace {

TEST_F(Documents, CommandsOfTheFirstPagesRun) {
  expect_page_works(BRUME_SOURCE_DIR "/README.md");
  expect_page_works(BRUME_SOURCE_DIR "/docs/start/your-level.md", Pictures::up_to_device);
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
