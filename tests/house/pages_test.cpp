// Pages lead somewhere, and say what they mean.
#include "tests/house/pages.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/file.hpp"
#include "tests/house/sources.hpp"

namespace brume::house {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;

/// Every Markdown file of the project.
std::vector<fs::path> pages() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(kRoot))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  for (const char* folder : {"docs", "scenes", "bench", "data", "examples", "integrations"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
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

TEST(Pages, ReferencesOfCommentsAreFound) {
  const std::vector<Reference> found = references_in(
      "// See CONTRIBUTING.md, \"Add a medium\".\nf(\"docs/a.md\");\n/// lib/noise.glsl (docs/how/b-c.md)\n");
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].file, "CONTRIBUTING.md");
  EXPECT_EQ(found[0].heading, "Add a medium");
  EXPECT_EQ(found[1].file, "lib/noise.glsl");
  EXPECT_EQ(found[2].file, "docs/how/b-c.md");
  EXPECT_EQ(found[2].line, 3u);
}

TEST(Pages, ReferencesOfCommentsLeadSomewhere) {
  std::size_t count = 0;
  const auto check = [&](const fs::path& source, const std::string& text) {
    for (const Reference& reference : references_in(text)) {
      ++count;
      const bool is_page = reference.file.ends_with(".md");
      const fs::path target = kRoot / (is_page ? "" : "shaders") / reference.file;
      if (!fs::exists(target)) {
        ADD_FAILURE() << source << ":" << reference.line << ": " << reference.file << " does not exist";
      } else if (!reference.heading.empty()) {
        const std::set<std::string> anchor = anchors_of("# " + reference.heading + "\n");
        EXPECT_TRUE(anchors_of(*read_text_file(target)).contains(*anchor.begin()))
            << source << ":" << reference.line << ": \"" << reference.heading << "\" is no heading of "
            << reference.file;
      }
    }
  };
  for (const char* folder : {"include", "src", "apps", "bench", "shaders", "python"})
    for_each_source(kRoot / folder, check);
  EXPECT_GT(count, 50u);
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
  std::vector<fs::path> texts{kRoot / "README.md"};
  for (const char* folder : {"docs", "include"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
      if (const auto extension = entry.path().extension();
          extension == ".md" || extension == ".h" || extension == ".hpp")
        texts.push_back(entry.path());
  for (const fs::path& path : texts)
    EXPECT_EQ(vague_phrases(*read_text_file(path)), Texts()) << path << ": name the noun instead";
}

}  // namespace
}  // namespace brume::house
