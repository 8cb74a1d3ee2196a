// Pages lead somewhere, and say what they mean.
#include "tests/house/pages.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/file.hpp"

namespace brume::house {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;

const fs::path kProject = BRUME_SOURCE_DIR;

/// Every Markdown file of the project.
std::vector<fs::path> pages() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(kProject))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  for (const char* folder : {"docs", "scenes", "bench", "data", "examples", "integrations"})
    for (const auto& entry : fs::recursive_directory_iterator(kProject / folder))
      if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

TEST(Pages, LinksAreFound) {
  const std::vector<Link> links = links_of(
      "[a](b.md#c) `[no](no.md)`\n```\n[no](no.md)\n```\n![p](../i.png) <img src=\"x.webp\" width=\"2\">\n");
  ASSERT_EQ(links.size(), 3u);
  EXPECT_EQ(links[0].target, "b.md#c");
  EXPECT_EQ(links[1].target, "../i.png");
  EXPECT_EQ(links[1].line, 5u);
  EXPECT_EQ(links[2].target, "x.webp");
}

TEST(Pages, HeadingsHaveAnchors) {
  EXPECT_EQ(anchors_of("# A title: `code`, and more\n## Twice\n```\n# no\n```\n### Twice\n"),
            (std::set<std::string>{"a-title-code-and-more", "twice", "twice-1"}));
}

TEST(Pages, VaguePhrasesAreFound) {
  EXPECT_EQ(vague_phrases("The size is that of a voxel.\nOf these, none.\n| x | Of a page. |\n"),
            (Texts{"1: that of", "2: Of ", "3: | Of "}));
  EXPECT_EQ(vague_phrases("```\nthat of\n```\nThe sum of that. Office hours.\n"), Texts{});
}

TEST(Pages, LinksLeadSomewhere) {
  std::size_t count = 0;
  for (const fs::path& page : pages())
    for (const Link& link : links_of(*read_text_file(page))) {
      if (link.target.find("://") != std::string::npos || link.target.starts_with("mailto:")) continue;
      const std::size_t hash = link.target.find('#');
      const std::string file = link.target.substr(0, hash);
      const fs::path target = file.empty() ? page : page.parent_path() / file;
      ++count;
      if (!fs::exists(target)) {
        ADD_FAILURE() << page << ":" << link.line << ": " << link.target << " does not exist";
      } else if (hash != std::string::npos && target.extension() == ".md") {
        EXPECT_TRUE(anchors_of(*read_text_file(target)).contains(link.target.substr(hash + 1)))
            << page << ":" << link.line << ": " << link.target << " names no heading";
      }
    }
  EXPECT_GT(count, 100u);
}

TEST(Pages, SayWhatTheyMean) {
  std::vector<fs::path> texts{kProject / "README.md"};
  for (const char* folder : {"docs", "include"})
    for (const auto& entry : fs::recursive_directory_iterator(kProject / folder))
      if (const auto extension = entry.path().extension();
          extension == ".md" || extension == ".h" || extension == ".hpp")
        texts.push_back(entry.path());
  for (const fs::path& path : texts)
    EXPECT_EQ(vague_phrases(*read_text_file(path)), Texts()) << path << ": name the noun instead";
}

}  // namespace
}  // namespace brume::house
