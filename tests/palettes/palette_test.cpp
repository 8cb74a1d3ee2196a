#include "palettes/palette.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/file.hpp"
#include "palettes/choice.hpp"

namespace brume::palettes {
namespace {

/// What docs/guides/spheres.md promises.
constexpr std::size_t kLeastPalettes = 2500;

Palette palette_of(std::initializer_list<glm::u8vec3> colors) {
  Palette palette;
  palette.colors = colors;
  return palette;
}

TEST(Palettes, AreManyWithUniqueNamesAndColours) {
  const auto all = built_in();
  EXPECT_GE(all.size(), kLeastPalettes);
  std::set<std::vector<std::uint32_t>> seen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Palette& palette = all[i];
    if (i > 0) {
      EXPECT_LT(all[i - 1].name, palette.name) << "sorted, and unique";
    }
    // What --palette splits at, and what blanks would do to a command line.
    EXPECT_EQ(palette.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-/"), std::string::npos)
        << palette.name;
    EXPECT_GE(palette.colors.size(), kLeastColors);
    EXPECT_LE(palette.colors.size(), kMostColors);
    std::vector<std::uint32_t> colors;
    for (const glm::u8vec3& c : palette.colors) colors.push_back(c.x | c.y << 8u | c.z << 16u);
    std::sort(colors.begin(), colors.end());
    colors.erase(std::unique(colors.begin(), colors.end()), colors.end());
    EXPECT_TRUE(seen.insert(colors).second) << palette.name << " has the colours of another palette";
  }
}

TEST(Palettes, OfEveryCollectionAreCountedInPalettesMd) {
  std::map<std::string, std::size_t> counts;
  for (const Palette& palette : built_in()) ++counts[palette.collection];
  const auto page = read_text_file(BRUME_SOURCE_DIR "/data/palettes/PALETTES.md");
  const auto licences = read_text_file(BRUME_SOURCE_DIR "/data/palettes/LICENSES.txt");
  ASSERT_TRUE(page && licences);
  for (const auto& [collection, count] : counts) {
    EXPECT_NE(page->find("| " + collection + " | " + std::to_string(count) + " |"), std::string::npos)
        << collection << ": " << count;
    EXPECT_NE(licences->find(collection), std::string::npos) << collection << " has no licence";
  }
}

TEST(Palettes, AreFoundByNameInAnyCase) {
  ASSERT_NE(find("viridis"), nullptr);
  EXPECT_EQ(find("Viridis"), find("viridis"));
  EXPECT_EQ(find("matplotlib/viridis"), find("viridis")) << "the collection may be named";
  EXPECT_EQ(find("crameri/viridis"), nullptr);
  EXPECT_EQ(find(""), nullptr);
  EXPECT_EQ(find("/"), nullptr);
  EXPECT_EQ(suggestion_for("virids"), "; did you mean \"viridis\"?");
  for (const Palette& palette : built_in()) EXPECT_EQ(find(palette.name), &palette);
}

TEST(Palettes, AreReadFromLines) {
  const auto read = parse_list("# comment\n\nb two g 000000ffffff\r\na one q 0102030a0b0c\n");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 2u);
  EXPECT_EQ((*read)[0].name, "a");
  EXPECT_EQ((*read)[0].collection, "one");
  EXPECT_EQ((*read)[0].kind, Kind::qualitative);
  EXPECT_EQ((*read)[0].colors, (std::vector<glm::u8vec3>{{1, 2, 3}, {10, 11, 12}}));
  for (const char* bad : {"a b x 000000ffffff", "a b g 000000", "a b g 000000fffff", "a b g 00000gffffff",
                          "a", "a b", " b g 000000ffffff", "a b g -00001ffffff", "a b g 000000 ffffff"}) {
    const auto none = parse_list(std::string("ok k g 000000ffffff\n") + bad);
    ASSERT_FALSE(none) << bad;
    EXPECT_NE(none.failure().message.find("palettes.txt:2: "), std::string::npos) << bad;
  }
}

TEST(Palettes, HaveTheMainHueOfTheirColours) {
  EXPECT_NEAR(*main_hue(palette_of({{255, 0, 0}, {255, 0, 0}})), 0, 1e-9);
  EXPECT_NEAR(*main_hue(palette_of({{0, 255, 0}, {0, 80, 0}})), 120, 1e-9);
  EXPECT_NEAR(*main_hue(palette_of({{0, 0, 200}, {128, 128, 255}})), 240, 1e-9);
  EXPECT_NEAR(*main_hue(palette_of({{255, 0, 255}, {255, 255, 255}})), 300, 1e-9);
  // Vectors at 0 and 60 degrees of equal length.
  EXPECT_NEAR(*main_hue(palette_of({{255, 0, 0}, {255, 255, 0}})), 30, 1e-9);
  EXPECT_FALSE(main_hue(palette_of({{10, 10, 10}, {200, 200, 200}}))) << "grey";
  EXPECT_FALSE(main_hue(palette_of({{255, 0, 0}, {0, 255, 0}, {0, 0, 255}}))) << "all around";
}

Filter filter_of(const std::string& words, std::size_t least = 0, std::size_t most = kMostColors) {
  Filter filter;
  filter.words = words;
  filter.least_colors = least;
  filter.most_colors = most;
  return filter;
}

TEST(Palettes, AreSearchedByWordsNumberOfColoursAndHue) {
  std::vector<Palette> list;
  const auto add = [&](const char* name, const char* collection, glm::u8vec3 a, glm::u8vec3 b) {
    list.push_back({name, collection, Kind::unknown, {a, b}});
  };
  add("deep-sea", "ocean", {0, 0, 90}, {0, 0, 255});
  add("sea-red", "films", {90, 0, 0}, {255, 0, 0});
  add("pink", "films", {255, 0, 60}, {255, 40, 90});
  list.push_back({"grey", "ocean", Kind::gradient, {{0, 0, 0}, {9, 9, 9}, {20, 20, 20}}});
  using Indices = std::vector<std::uint32_t>;
  EXPECT_EQ(search(list, {}), (Indices{0, 1, 2, 3}));
  EXPECT_EQ(search(list, filter_of("SEA")), (Indices{0, 1}));
  EXPECT_EQ(search(list, filter_of(" sea  films ")), (Indices{1}));
  EXPECT_EQ(search(list, filter_of("none")), (Indices{}));
  EXPECT_EQ(search(list, filter_of("", 3)), (Indices{3}));
  EXPECT_EQ(search(list, filter_of("", 0, 2)), (Indices{0, 1, 2}));
  Filter near_red;
  near_red.hue = 350;
  EXPECT_EQ(search(list, near_red), (Indices{2, 1})) << "the nearest first, around the circle";
  near_red.hue = 710;
  EXPECT_EQ(search(list, near_red), (Indices{2, 1}));
  near_red.hue_tolerance = 5;
  EXPECT_EQ(search(list, near_red), (Indices{2}));
}

TEST(Choices, AreAPaletteAndARange) {
  const auto whole = parse_palette_choice("Viridis");
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->palette.name, "viridis");
  EXPECT_EQ(whole->low, 0);
  EXPECT_EQ(whole->high, 1);
  const auto part = parse_palette_choice("viridis:0.25-.75");
  ASSERT_TRUE(part);
  EXPECT_EQ(part->low, 0.25);
  EXPECT_EQ(part->high, 0.75);
  const auto backwards = parse_palette_choice("matplotlib/viridis:1-0");
  ASSERT_TRUE(backwards);
  EXPECT_EQ(backwards->low, 1);
  EXPECT_EQ(backwards->high, 0);
  EXPECT_TRUE(parse_palette_choice("viridis:0.5-0.5"));
}

TEST(Choices, RefuseOtherRangesAndNames) {
  for (const char* range : {"", "0.2", "-", "0.2-", "-0.2-0.6", "0.2-1.1", "0.2--0.6", "0.2-0.6x", "0.2 -0.6",
                            "nan-1", "0-inf", "1e-1-1", "0x0-1", "0.2-0.6-0.7", "+0-1"}) {
    const auto none = parse_palette_choice(std::string("viridis:") + range);
    ASSERT_FALSE(none) << range;
    EXPECT_EQ(none.failure().code, ErrorCode::usage);
    EXPECT_NE(none.failure().message.find("viridis:0.2-0.6"), std::string::npos) << none.failure().message;
  }
  for (const char* name : {"", ":0-1", "virids", "virids:0.2-0.6"}) {
    const auto none = parse_palette_choice(name);
    ASSERT_FALSE(none) << name;
    EXPECT_EQ(none.failure().code, ErrorCode::usage);
    EXPECT_EQ(none.failure().message.find('\n'), std::string::npos);
  }
  EXPECT_NE(parse_palette_choice("virids:0.2-0.6").failure().message.find("did you mean \"viridis\"?"),
            std::string::npos);
  const auto missing = parse_palette_choice("/no/such.gpl:0.2-0.6");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.failure().code, ErrorCode::bad_input);
}

TEST(Choices, AreWrittenAsTheyAreRead) {
  EXPECT_EQ(choice_text("a", 0, 1), "a");
  EXPECT_EQ(choice_text("a", 0.2, 0.6), "a:0.2-0.6");
  EXPECT_EQ(choice_text("a", 1, 0.125), "a:1-0.125");
  const auto read = parse_palette_choice(choice_text("viridis", 0.3126, 0.9));
  ASSERT_TRUE(read);
  EXPECT_NEAR(read->low, 0.3126, 0.000501) << "three digits";
  EXPECT_EQ(read->high, 0.9);
}

}  // namespace
}  // namespace brume::palettes
