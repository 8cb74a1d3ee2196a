#include "tests/house/words.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <map>
#include <sstream>

#include "core/file.hpp"
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

// What a folder still has of each; the numbers of words.txt.
using Counts = std::array<std::size_t, 3>;
constexpr std::array kNames{"long bodies without a comment", "comments without a noun",
                            "lines with a name `of`"};

std::map<std::string, Counts> read_limits() {
  std::istringstream file(*read_text_file(kRoot / "tests/house/words.txt"));
  std::map<std::string, Counts> limits;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    std::istringstream words(line);
    std::string folder;
    words >> folder;
    for (std::size_t& count : limits[folder]) words >> count;
    EXPECT_FALSE(words.fail()) << line;
  }
  return limits;
}

TEST(House, WordsOfCommentsAndNames) {
  std::map<std::string, Counts> found;
  std::map<std::string, std::array<std::string, 3>> places;
  for (const char* root : {"src", "apps"})
    for_each_source(kRoot / root, [&](const std::filesystem::path& path, const std::string& text) {
      const std::string file = std::filesystem::relative(path, kRoot).string();
      const std::string folder = room_of(path);
      const auto add = [&](std::size_t kind, std::size_t line) {
        ++found[folder][kind];
        places[folder][kind] += "\n  " + file + ":" + std::to_string(line);
      };
      for (const Length& function : uncommented_functions(text, kLongBody)) add(0, function.line);
      for (const std::size_t line : nounless_comments(text)) add(1, line);
      for (const std::size_t line : lines_with_of(text)) add(2, line);
    });

  // Folders that words.txt does not name have none.
  std::map<std::string, Counts> limits = read_limits();
  for (const auto& [folder, counts] : found) limits.try_emplace(folder);
  for (const auto& [folder, most] : limits) {
    const Counts& counts = found[folder];
    for (std::size_t kind = 0; kind < counts.size(); ++kind) {
      EXPECT_LE(counts[kind], most[kind]) << folder << ": " << kNames[kind] << places[folder][kind];
      EXPECT_GE(counts[kind], most[kind])
          << folder << ": " << kNames[kind] << ": fewer than words.txt allows, so lower it there";
    }
  }
}

}  // namespace
}  // namespace brume::house
