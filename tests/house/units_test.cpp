#include "tests/house/units.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/house/house_rules.hpp"
#include "tests/house/sources.hpp"

namespace brume::house {
namespace {

using Groups = std::vector<std::vector<std::string>>;

constexpr std::size_t kMostUnitLines = 700, kMostInterfaceLines = 1000, kMostShaderLines = 199;

// Groups of units that still need each other. A line may only be removed.
const Groups kKnownCircles{{"python/density", "python/smoke"}};

Units units_of(std::initializer_list<std::pair<const char*, const char*>> files) {
  Units units;
  for (const auto& [path, text] : files) add_file(units, path, text);
  return units;
}

TEST(Units, AreAHeaderAndItsSource) {
  const Units units = units_of({{"src/a/b.hpp", "1\n2\n"}, {"src/a/b.cpp", "#include \"a/c.hpp\"\n"}});
  ASSERT_EQ(units.size(), 1u);
  EXPECT_EQ(units.at("src/a/b").lines, 3u);
  EXPECT_EQ(units.at("src/a/b").included, std::set<std::string>{"a/c.hpp"});
}

TEST(Units, OfAPairThatNeedsEachOtherAreACircle) {
  const Units units = units_of({{"src/a/b.cpp", "#include \"a/b.hpp\"\n#include \"a/c.hpp\"\n"},
                                {"src/a/c.hpp", "#include \"a/b.hpp\"\n"},
                                {"src/a/d.hpp", "#include \"a/b.hpp\"\n"}});
  EXPECT_EQ(circles(units), (Groups{{"src/a/b", "src/a/c"}}));
}

TEST(Units, AreFoundInLongCirclesToo) {
  const Units units = units_of({{"src/a/b.cpp", "#include \"a/c.hpp\"\n"},
                                {"src/a/c.hpp", "#include \"apps/d.hpp\"\n"},
                                {"apps/d.hpp", "#include \"a/b.hpp\"\n"},
                                {"src/a/b.hpp", ""}});
  EXPECT_EQ(circles(units), (Groups{{"apps/d", "src/a/b", "src/a/c"}}));
}

TEST(Units, WithoutACircleAreFine) {
  EXPECT_TRUE(circles(units_of({{"src/a/b.cpp", "#include \"a/b.hpp\"\n#include \"a/c.hpp\"\n"},
                                {"src/a/c.hpp", "#include \"a/d.hpp\"\n"},
                                {"src/a/d.hpp", ""}}))
                  .empty());
}

Units units_in(std::initializer_list<const char*> folders) {
  Units units;
  for (const char* folder : folders)
    for_each_source(kRoot / folder, [&](const std::filesystem::path& path, const std::string& text) {
      add_file(units, std::filesystem::relative(path, kRoot).string(), text);
    });
  return units;
}

TEST(House, UnitsAreNotTooLong) {
  const Units units = units_in({"src", "apps", "bench", "tests", "examples", "fuzz", "python"});
  EXPECT_GT(units.size(), 300u);
  for (const auto& [name, unit] : units)
    EXPECT_LE(unit.lines, kMostUnitLines) << name << ": a second thing in it deserves a unit of its own";
  for_each_source(kRoot / "shaders", [](const auto& path, const std::string& text) {
    // Exported shaders are files to be copied: one rather than five.
    const bool exported = path.parent_path().filename() == "export";
    EXPECT_LE(line_count(text), exported ? 2 * kMostShaderLines : kMostShaderLines) << path;
  });
  for_each_source(kRoot / "include", [](const auto& path, const std::string& text) {
    EXPECT_LE(line_count(text), kMostInterfaceLines) << path;
  });
}

TEST(House, UnitsDoNotNeedEachOther) {
  const Groups found = circles(units_in({"src", "apps", "bench", "python"}));
  for (const auto& group : found)
    if (std::find(kKnownCircles.begin(), kKnownCircles.end(), group) == kKnownCircles.end())
      ADD_FAILURE() << "include each other: " << ::testing::PrintToString(group);
  for (const auto& group : kKnownCircles)
    if (std::find(found.begin(), found.end(), group) == found.end())
      ADD_FAILURE() << "no longer a circle, remove it from kKnownCircles: "
                    << ::testing::PrintToString(group);
}

}  // namespace
}  // namespace brume::house
