// brume palettes: lists, searches, draws and reads palettes.
#include <gtest/gtest.h>

#include <algorithm>

#include "palettes/sample.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

class PalettesTest : public CommandTest {
 protected:
  Json json(const Arguments& more) const { return json_of({"palettes"}, more); }
};

TEST_F(PalettesTest, ListsWhatTheProgramHolds) {
  const Outcome run = run_well({"palettes"});
  EXPECT_EQ(run.error, "");
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'),
            static_cast<std::ptrdiff_t>(palettes::built_in().size()));
  EXPECT_EQ(run.out.find('\x1b'), std::string::npos) << "no colours in a pipe";
}

TEST_F(PalettesTest, Searches) {
  const Json found = json({"viridis", "matplotlib"});
  ASSERT_EQ(found.at("found"), 1);
  const Json& palette = found.at("palettes").at(0);
  EXPECT_EQ(palette.at("name"), "viridis");
  EXPECT_EQ(palette.at("collection"), "matplotlib");
  EXPECT_EQ(palette.at("kind"), "gradient");
  EXPECT_EQ(palette.at("colors").at(0), "#440154") << "as Matplotlib has it";
  EXPECT_EQ(palette.at("colors").size(), palettes::find("viridis")->colors.size());

  const Json few = json({"--colors", "5", "--limit", "3"});
  EXPECT_EQ(few.at("palettes").size(), 3u);
  EXPECT_GT(few.at("found"), 3);
  for (const Json& each : few.at("palettes")) EXPECT_EQ(each.at("colors").size(), 5u);
  for (const Json& each : json({"--hue", "0"}).at("palettes")) {
    const double hue = each.at("hue");
    EXPECT_TRUE(hue <= 20 || hue >= 340) << hue;
  }
}

TEST_F(PalettesTest, ThatAreNotFoundReplaceNothing) {
  run_well({"palettes", "viridis", "-o", "sheet.png"});
  const auto before = read_file(folder_.path() / "sheet.png").value_or_throw();
  expect_failure(folder_, {"palettes", "no-such-word"}, 2, {"none of ", " palettes matches"});
  expect_failure(folder_, {"palettes", "no-such-word", "-o", "sheet.png"}, 2, {"none of "});
  expect_failure(folder_, {"palettes", "no-such-word", "-o", "new.png"}, 2, {"none of "});
  EXPECT_EQ(read_file(folder_.path() / "sheet.png").value_or_throw(), before);
}

TEST_F(PalettesTest, DrawsTheColoursOfEachPalette) {
  folder_.write("two.json", R"({"kind": "qualitative", "colors": ["#ff0000", "#0000ff"]})");
  const Outcome run = run_well({"palettes", "two.json", "-o", "sheet.png"});
  EXPECT_EQ(run.out.substr(0, 4), "two ");
  const image::Image8 sheet = png("sheet.png");
  std::size_t red = 0, blue = 0, other = 0;
  for (std::size_t i = 0; i < sheet.rgba.size(); i += 4) {
    const std::uint8_t* const c = &sheet.rgba[i];
    red += c[0] == 255 && c[1] == 0 && c[2] == 0;
    blue += c[0] == 0 && c[1] == 0 && c[2] == 255;
    other += c[0] == c[1] && c[1] == c[2];
  }
  EXPECT_GT(red, 1000u);
  EXPECT_EQ(red, blue) << "halves";
  EXPECT_EQ(red + blue + other, sheet.rgba.size() / 4) << "paper and letters are grey";
}

TEST_F(PalettesTest, RefusesWhatIsWrong) {
  folder_.write("bad.gpl", "GIMP Palette\n1 2 3\n4 5\n");
  expect_failure(folder_, {"palettes", "bad.gpl"}, 3, {"bad.gpl:3: expected a colour"});
  expect_failure(folder_, {"palettes", "none.gpl"}, 3, {"none.gpl"});
  for (const char* counts : {"7-3", "a", "3-", "-3-4", "3-5000", "3-4-5"})
    expect_failure(folder_, {"palettes", "--colors=" + std::string(counts)}, 2, {"--colors", "such as 3-12"});
  expect_failure(folder_, {"palettes", "--hue", "400"}, 2, {"--hue", "from 0 to 360"});
  expect_failure(folder_, {"palettes", "-o", "a.jpg"}, 2, {"-o", ".png"});
}

}  // namespace
}  // namespace brume::cli
