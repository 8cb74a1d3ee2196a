#include "palettes/file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "palettes/choice.hpp"
#include "tests/sanitized.hpp"

namespace brume::palettes {
namespace {

const std::string kGpl =
    "GIMP Palette\nName: Sea of ice\nColumns: 2\n#\n  0  10 255\tdeep\n255 255 255\n\n1 2 3 x y\n";
const std::string kJson =
    "{\n  \"name\": \"Sea of \\\"ice\\\"\",\n  \"kind\": \"qualitative\",\n  \"colors\": [\"#000aff\",\n    "
    "\"#FFffFF\"]\n}\n";
using Colors = std::vector<glm::u8vec3>;

TEST(Gpl, IsRead) {
  const auto palette = parse_gpl(kGpl, "a.gpl");
  ASSERT_TRUE(palette);
  EXPECT_EQ(palette->name, "Sea of ice");
  EXPECT_EQ(palette->colors, (Colors{{0, 10, 255}, {255, 255, 255}, {1, 2, 3}}));
  EXPECT_TRUE(parse_gpl("GIMP Palette\r\n1 2 3\r\n4 5 6\r\n", "a.gpl")) << "lines of other systems";
}

TEST(Gpl, NamesTheLineOfAFault) {
  const auto expect_fault = [](const std::string& text, const std::string& place) {
    const auto palette = parse_gpl(text, "a.gpl");
    ASSERT_FALSE(palette) << text;
    EXPECT_TRUE(palette.failure().message.starts_with(place)) << palette.failure().message;
    EXPECT_EQ(palette.failure().code, ErrorCode::bad_input);
  };
  expect_fault("", "a.gpl:1: ");
  expect_fault("GIMP\n1 2 3\n4 5 6", "a.gpl:1: ");
  expect_fault("GIMP Palette\n", "a.gpl:1: ");
  expect_fault("GIMP Palette\n1 2 3\n", "a.gpl:2: expected at least two colours");
  for (const char* line : {"1 2", "1 2 256", "-1 2 3", "1 2 3x", "1,2,3", "a b c", "1.5 2 3", "+1 2 3",
                           "99999999999999999999 1 1"})
    expect_fault(std::string("GIMP Palette\n1 2 3\n") + line + "\n4 5 6\n", "a.gpl:3: ");
  expect_fault("GIMP Palette\nName: \xff\n1 2 3\n4 5 6", "a.gpl:2: ");
}

TEST(Json, IsRead) {
  const auto palette = parse_json(kJson, "a.json");
  ASSERT_TRUE(palette) << palette.failure().message;
  EXPECT_EQ(palette->name, "Sea of \"ice\"");
  EXPECT_EQ(palette->kind, Kind::qualitative);
  EXPECT_EQ(palette->colors, (Colors{{0, 10, 255}, {255, 255, 255}}));
  const auto list = parse_json(" [\"#010203\" , \"#040506\"] ", "a.json");
  ASSERT_TRUE(list);
  EXPECT_EQ(list->colors, (Colors{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(list->kind, Kind::unknown);
}

TEST(Json, NamesTheLineOfAFault) {
  for (const char* text : {"",
                           "7",
                           "[",
                           "[]",
                           "[\"#010203\"]",
                           "[\"#010203\" \"#040506\"]",
                           "[\"#010203\",]",
                           "[\"#01020\",\"#040506\"]",
                           "[\"010203\",\"#040506\"]",
                           "[\"#010203\",\"#040506\"] x",
                           "{}",
                           "{\"colors\": 7}",
                           "{\"colours\": []}",
                           "{\"colors\": [\"#010203\",\"#040506\"], \"colors\": []}",
                           "{\"kind\": \"other\"}",
                           "[\"#010203\",\"#040506\"",
                           "{\"name\": \"\\u0041\"}",
                           "{\"name\": \"\xff\"}",
                           "{\"name\": \"a\tb\"}",
                           "[[[[[[",
                           "[\"#-10203\",\"#040506\"]"}) {
    const auto palette = parse_json(std::string("\n\n") + text, "a.json");
    ASSERT_FALSE(palette) << text;
    EXPECT_TRUE(palette.failure().message.starts_with("a.json:3: ")) << palette.failure().message;
    EXPECT_EQ(palette.failure().code, ErrorCode::bad_input);
  }
}

TEST(PaletteFiles, HaveLimits) {
  std::string gpl = "GIMP Palette\n", json = "[\"#000000\"";
  for (std::size_t i = 0; i < kMostColors; ++i) gpl += "1 2 3\n";
  for (std::size_t i = 1; i < kMostColors; ++i) json += ",\"#000000\"";
  EXPECT_TRUE(parse_gpl(gpl, "a.gpl"));
  EXPECT_TRUE(parse_json(json + "]", "a.json"));
  const auto more_gpl = parse_gpl(gpl + "1 2 3\n", "a.gpl");
  const auto more_json = parse_json(json + ",\"#000000\"]", "a.json");
  ASSERT_FALSE(more_gpl);
  ASSERT_FALSE(more_json);
  EXPECT_EQ(more_gpl.failure().code, ErrorCode::resource_limit);
  EXPECT_EQ(more_json.failure().code, ErrorCode::resource_limit);
  EXPECT_TRUE(more_gpl.failure().message.starts_with("a.gpl:4098: ")) << more_gpl.failure().message;
}

TEST(PaletteFiles, AreChosenByTheirPath) {
  const std::string folder = ::testing::TempDir();
  const std::string gpl = folder + "/palette_test.GPL", json = folder + "/palette_test.json";
  std::ofstream(gpl) << kGpl;
  std::ofstream(json) << "[\"#010203\",\"#040506\"]";
  const auto part = parse_palette_choice(gpl + ":0.2-0.6");
  ASSERT_TRUE(part) << part.failure().message;
  EXPECT_EQ(part->palette.name, "Sea of ice");
  EXPECT_EQ(part->low, 0.2);
  const auto whole = parse_palette_choice(json);
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->palette.name, "palette_test") << "that of the file";
  std::ofstream(json) << std::string(kMostFileBytes + 1, ' ');
  const auto large = load_palette(json);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.failure().code, ErrorCode::resource_limit);
  EXPECT_FALSE(load_palette(folder + "/palette.txt"));
  EXPECT_FALSE(load_palette(folder)) << "a folder";
}

/// Bytes of a valid file with some changed, removed, repeated or inserted.
std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t count) { return random() % count; };
  for (std::size_t changes = 1 + below(6); changes > 0 && !text.empty(); --changes) {
    const std::size_t at = below(text.size()), length = 1 + below(8);
    switch (below(5)) {
      case 0:
        text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 3:
        text.insert(at, 1, "\"\\[]{}:,#\n\t 09"[below(14)]);
        break;
      default:
        text.resize(at);
    }
  }
  return text;
}

TEST(PaletteFiles, WithAnyBytesAreReadOrRefusedInOneLine) {
  std::mt19937 random(7);
  const int count = kSanitized ? 20'000 : 200'000;
  int read = 0;
  for (int i = 0; i < count; ++i) {
    const bool is_gpl = i % 2 == 0;
    const std::string text = mutated(is_gpl ? kGpl : kJson, random);
    const auto palette = is_gpl ? parse_gpl(text, "f") : parse_json(text, "f");
    if (palette) {
      ++read;
      EXPECT_GE(palette->colors.size(), kLeastColors);
      EXPECT_LE(palette->colors.size(), kMostColors);
    } else {
      EXPECT_TRUE(palette.failure().message.starts_with("f:")) << palette.failure().message;
      EXPECT_EQ(palette.failure().message.find('\n'), std::string::npos);
    }
  }
  // Changes within names and comments leave a file valid, most others do not.
  EXPECT_GT(read, count / 100);
  EXPECT_LT(read, count);
}

}  // namespace
}  // namespace brume::palettes
