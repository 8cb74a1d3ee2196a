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
  const auto palette = parse_json(kJson, "a.json").value_or_throw();
  EXPECT_EQ(palette.name, "Sea of \"ice\"");
  EXPECT_EQ(palette.kind, Kind::qualitative);
  EXPECT_EQ(palette.colors, (Colors{{0, 10, 255}, {255, 255, 255}}));
  const auto list = parse_json(" [\"#010203\" , \"#040506\"] ", "a.json");
  ASSERT_TRUE(list);
  EXPECT_EQ(list->colors, (Colors{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(list->kind, Kind::unknown);
}

TEST(Json, HasEscapesOtherKeysAndShortColours) {
  const auto read = [](const std::string& text) { return parse_json(text, "a.json").value_or_throw(); };
  const std::string colors = R"("colors": ["#f80", "#FfA"])";
  const Palette palette = read(R"({"name": "\u00c4\u20ac\ud83d\uDE00\n\t\/", )" + colors + "}");
  EXPECT_EQ(palette.name, "\u00c4\u20ac\U0001f600\n\t/");
  EXPECT_EQ(palette.colors, (Colors{{255, 136, 0}, {255, 255, 170}}));
  const std::string others =
      R"("author": "A", "year": 2.5e3, "tags": ["sea", {"deep": [true, null, -1]}, [], {}], "\u0063olors2": {},)";
  EXPECT_EQ(read("{" + others + colors + "}").colors, palette.colors);
  EXPECT_EQ(read("{" + colors + R"(, "license": "CC0"})").colors, palette.colors);
  EXPECT_EQ(read(R"({"\u0063olors": ["#f80", "#FfA"]})").colors, palette.colors);
}

TEST(Json, SaysWhatIsMissingOrWrong) {
  const auto expect_fault = [](const std::string& text, const std::string& message) {
    const auto palette = parse_json(text, "a.json");
    ASSERT_FALSE(palette) << text;
    EXPECT_EQ(palette.failure().message.substr(0, 10 + message.size()), "a.json:1: " + message) << text;
  };
  expect_fault("{}", "\"colors\" is missing; expected {\"colors\": [\"#rrggbb\", ...]}");
  expect_fault(R"({"colours": ["#f80", "#ffa"]})", "\"colors\" is missing");
  expect_fault(R"({"colors": "#f80"})", "\"colors\": expected a list");
  expect_fault(R"({"colors": [1, 2]})", "expected a colour such as");
  expect_fault(R"({"colors": ["#f8", "#ffa"]})", "expected a colour such as");
  expect_fault(R"({"colors": ["#+80", "#ffa"]})", "expected a colour such as");
  expect_fault(R"({"name": 7})", "\"name\": expected a text");
  expect_fault(R"({"kind": 7})", "\"kind\": expected \"gradient\" or \"qualitative\"");
  for (const char* name : {"\\ud83d", "\\ud83dx", "\\ud83d\\u0041", "\\ude00", "\\ude00\\ud83d"})
    expect_fault(std::string("{\"name\": \"") + name + "\"}", "expected a pair of surrogates");
  for (const char* name : {"\\u12", "\\u12g4", "\\u-123"})
    expect_fault(std::string("{\"name\": \"") + name + "\"}", "expected four hexadecimal digits");
  expect_fault(R"({"name": "\x41"})", "unknown escape");
  for (const char* value : {"", "tru", "+1", "-", "1x", "nan", "}"})
    expect_fault(std::string("{\"other\": ") + value, "expected a value");
  expect_fault("{\"other\": " + std::string(100'000, '['), "values lie too deep");
}

TEST(PaletteFiles, MayBeginWithAByteOrderMark) {
  EXPECT_TRUE(parse_gpl("\xef\xbb\xbf" + kGpl, "a.gpl"));
  EXPECT_TRUE(parse_json("\xef\xbb\xbf" + kJson, "a.json"));
  EXPECT_FALSE(parse_gpl("\xef\xbb\xbf\xef\xbb\xbf" + kGpl, "a.gpl"));
}

TEST(PaletteFiles, ThatAChoiceNamesHaveNoRange) {
  EXPECT_EQ(file_of_choice("a/b.json"), "a/b.json");
  EXPECT_EQ(file_of_choice("a/b.GPL:0.2-0.6"), "a/b.GPL");
  EXPECT_EQ(file_of_choice("c:d/b.json"), "c:d/b.json");
  EXPECT_EQ(file_of_choice("viridis:0-1"), "");
  EXPECT_EQ(file_of_choice(""), "");
}

TEST(PaletteFiles, LongNamesAreShortenedInMessages) {
  const std::string name(500, 'x');
  for (const std::string& text : {name, name + ":5"}) {
    const auto choice = parse_palette_choice(text);
    ASSERT_FALSE(choice);
    EXPECT_LT(choice.failure().message.size(), 200u) << choice.failure().message;
  }
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
  const auto part = parse_palette_choice(gpl + ":0.2-0.6").value_or_throw();
  EXPECT_EQ(part.palette.name, "Sea of ice");
  EXPECT_EQ(part.low, 0.2);
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
