#include "tests/house/words.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/house/sources.hpp"

namespace brume::house {
namespace {

using Lines = std::vector<std::size_t>;

constexpr std::size_t kLongBody = 25;  // lines; CONTRIBUTING.md

std::string body(std::size_t lines, const std::string& inside) {
  std::string text = "// A title before it does not count.\nint f() {\n" + inside + "\n";
  for (std::size_t i = 3; i < lines; ++i) text += "  ++a;\n";
  return text + "}\n";
}

TEST(Words, LongBodiesHaveAComment) {
  EXPECT_EQ(uncommented_functions(body(26, "  ++a;"), 25).size(), 1u);
  EXPECT_TRUE(uncommented_functions(body(25, "  ++a;"), 25).empty());
  EXPECT_TRUE(uncommented_functions(body(26, "  // A step."), 25).empty());
  EXPECT_TRUE(uncommented_functions(body(26, "  ++a;  // a reason"), 25).empty());
  EXPECT_EQ(uncommented_functions(body(26, "  f(\"http://a\");"), 25).size(), 1u);
}

TEST(Words, CommentsHaveANoun) {
  EXPECT_EQ(nounless_comments("/// Of the frame.\nint a;  ///< Those of lights.\n// That of b.\n"),
            (Lines{1, 2, 3}));
  EXPECT_EQ(nounless_comments("// A list\n// of lights. Fine.\n// Of lights.\n"), Lines{3});
  EXPECT_TRUE(nounless_comments("/// Lists of lights.\nf(\"// Of\");  // Offsets\n").empty());
}

TEST(Words, NothingIsNamedOf) {
  EXPECT_EQ(lines_with_of("f(of);\nconst auto& of = a;\nof.b();\n"), (Lines{1, 2, 3}));
  EXPECT_TRUE(lines_with_of("name_of(a);\n// of a\n\"of\";\nstd::of(a);\n").empty());
}

TEST(House, WordsOfCommentsAndNames) {
  for (const char* root : {"src", "apps"})
    for_each_source(kRoot / root, [](const std::filesystem::path& path, const std::string& text) {
      const std::string file = std::filesystem::relative(path, kRoot).string() + ":";
      for (const Length& function : uncommented_functions(text, kLongBody))
        ADD_FAILURE() << file << function.line << ": a long body without a comment";
      for (const std::size_t line : nounless_comments(text))
        ADD_FAILURE() << file << line << ": a comment without a noun";
      for (const std::size_t line : lines_with_of(text)) ADD_FAILURE() << file << line << ": a name `of`";
    });
}

}  // namespace
}  // namespace brume::house
