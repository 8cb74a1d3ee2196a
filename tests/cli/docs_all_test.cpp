// The commands of all documents run as written.
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

}  // namespace
}  // namespace brume::cli
