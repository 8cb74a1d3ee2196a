// Invalid images and texts for shots: the error is one line that names the position of the event or value,
// the expectation and the fix, with the exit code of docs/reference/command-line.md.
#include <gtest/gtest.h>

#include "image/png.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

/// A room, and a timeline whose one event begins on line 4 and ends, from line 9 on, with lines from the
/// test.
class MaskErrors : public RoomTest {
 protected:
  void expect_event_fails(const std::string& type, const std::string& lines, int exit_code,
                          const std::vector<std::string>& parts) const {
    folder_.write("a.toml", "version = 1\nscene = \"room.obj\"\nduration = 1.0\n[[event]]\ntype = \"" + type +
                                "\"\ntime = 0.1\nfrom = [0, 1, 1]\ntoward = [0, 1, -1]\n" + lines + "\n");
    expect_failure(folder_, {"render", "a.toml", "-o", "a.png", "--size", "16x9"}, exit_code, parts);
  }
  void expect_mask_fails(const std::string& file, int exit_code,
                         const std::vector<std::string>& parts) const {
    expect_event_fails("shot", "shape = \"mask\"\nmask = \"" + file + "\"", exit_code,
                       joined({"a.toml:4:1: ", file}, parts));
  }
  void write_picture(const std::string& name, std::uint32_t width, std::uint32_t height) const {
    const image::Image8 picture{width, height,
                                std::vector<std::uint8_t>(std::size_t{4} * width * height, 255)};
    ASSERT_TRUE(image::save_png(folder_.path() / name, picture));
  }
  /// Writes only the header of a PNG file (PNG specification, 11.2.2); `sum` is its CRC.
  void write_head(const std::string& name, const std::string& size, const std::string& sum) const {
    using namespace std::string_literals;
    folder_.write(name, "\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s + size + "\x08\0\0\0\0"s + sum);
  }
};

TEST_F(MaskErrors, InvalidImages) {
  expect_mask_fails("none.png", 3, {"No such file", "check the path"});
  folder_.write("words.png", "not a picture");
  expect_mask_fails("words.png", 3, {"none of PNG, JPEG, WebP, TGA and BMP", "convert it"});
  folder_.write("empty.png", "");
  expect_mask_fails("empty.png", 3, {"none of PNG, JPEG, WebP, TGA and BMP", "convert it"});
  std::filesystem::create_directory(folder_.path() / "folder.png");
  expect_mask_fails("folder.png", 3, {"not a regular file", "check the path"});
  // A truncated file.
  write_picture("cut.png", 64, 64);
  const auto cut = folder_.path() / "cut.png";
  std::filesystem::resize_file(cut, std::filesystem::file_size(cut) - 20);
  expect_mask_fails("cut.png", 3, {"PNG", "save it again"});
}

TEST_F(MaskErrors, ImagesOfAbsurdSizes) {
  using namespace std::string_literals;
  write_picture("wide.png", 4095, 1);
  expect_mask_fails("wide.png", 4, {"4095 x 1", "at most 4094", "make it smaller"});
  // Headers of 100,000 x 100,000, 16,000 x 16,000 and 0 x 4 texels without data.
  write_head("huge.png", "\0\x01\x86\xa0\0\x01\x86\xa0"s, "\x8d\x39\x54\x14"s);
  expect_mask_fails("huge.png", 4, {"100000x100000", "at most 16384", "scale it down"});
  write_head("lies.png", "\0\0\x3e\x80\0\0\x3e\x80"s, "\x64\x15\x80\x02"s);
  expect_mask_fails("lies.png", 3, {"too short", "save it again"});
  write_head("none.png", "\0\0\0\0\0\0\0\x04"s, "\x85\x71\x61\xd8"s);
  expect_mask_fails("none.png", 3, {"width", "save it again"});
}

TEST_F(MaskErrors, TooManyImages) {
  std::string lines = "shape = \"mask\"\nmask = \"0.png\"";
  write_picture("0.png", 2000, 2000);
  for (int i = 1; i < 5; ++i) {
    const std::string name = std::to_string(i) + ".png";
    write_picture(name, 2000, 2000 - i);  // equal images would share a mask
    lines +=
        "\n[[event]]\ntype = \"shot\"\ntime = 0.1\nfrom = [0, 1, 1]\ntoward = [0, 1, -1]\nshape = "
        "\"mask\"\nmask = \"" +
        name + "\"";
  }
  expect_event_fails("shot", lines, 4, {"a.toml:32:1: ", "masks: 5", "4096 x 4096", "fewer or smaller"});
}

TEST_F(MaskErrors, InvalidShots) {
  const auto fails = [&](const std::string& lines, const std::vector<std::string>& parts) {
    expect_event_fails("shot", lines, 3, parts);
  };
  fails("shape = \"mask\"", {"a.toml:4:1: ", "lacks the key \"mask\""});
  fails("shape = \"mask\"\nmask = \"\"", {"a.toml:10:8: ", "\"mask\": expected the name of a picture"});
  fails("shape = \"mask\"\nmask = 3", {"a.toml:10:", "\"mask\": expected a string in quotes"});
  fails("mask = \"a.png\"", {"a.toml:9:8: ", "belongs to shape = \"mask\""});
  fails("shape = \"star\"", {"a.toml:9:9: ", "expected \"cylinder\", \"box\" or \"mask\""});
  for (const char* name : {"../a.png", "/a.png"})
    fails("shape = \"mask\"\nmask = \"" + std::string(name) + "\"",
          {"a.toml:10:8: ", "below the folder of this file"});
  fails("radius = 0", {"a.toml:9:10: ", "from 0.01 to 10", "found 0"});
  fails("radius = nan", {"a.toml:9:10: ", "from 0.01 to 10", "found nan"});
  fails("roll = 400", {"a.toml:9:8: ", "from -360 to 360", "found 400"});
  fails("stay = -1", {"a.toml:9:8: ", "from 0 to 600", "found -1"});
}

TEST_F(MaskErrors, InvalidTexts) {
  const auto fails = [&](const std::string& lines, const std::vector<std::string>& parts) {
    expect_event_fails("text", lines, 3, parts);
  };
  fails("", {"a.toml:4:1: ", "lacks the key \"text\""});
  fails("text = \"\"", {"a.toml:9:8: ", "expected 1 to 1024 bytes"});
  fails("text = \"" + std::string(1025, 'A') + "\"", {"a.toml:9:8: ", "expected 1 to 1024 bytes"});
  fails("text = \"  \"", {"a.toml:4:1: ", "no visible letter", "expected at least one"});
  fails("text = 5", {"a.toml:9:8: ", "expected a string in quotes"});
  fails("text = \"A\\tB\"", {"a.toml:4:1: ", "U+0009", "expected one line of letters"});
  fails("text = \"\xff\xfe\"", {"a.toml:9:", "utf-8"});
  fails("text = \"\xe6\xbc\xa2\"", {"a.toml:4:1: ", "no glyph for U+6F22", "choose another"});
}

TEST_F(MaskErrors, InvalidFonts) {
  const auto fails = [&](const std::string& font, const std::vector<std::string>& parts) {
    expect_event_fails("text", "text = \"A\"\nfont = \"" + font + "\"", 3, parts);
  };
  fails("none.ttf", {"a.toml:4:1: ", "none.ttf: ", "No such file", "check the path"});
  folder_.write("words.ttf", "not a font");
  fails("words.ttf", {"a.toml:4:1: ", "words.ttf: ", "expected a TrueType or OpenType file"});
  fails("../a.ttf", {"a.toml:10:8: ", "below the folder of this file"});
}

TEST_F(MaskErrors, TextsOfAbsurdSizes) {
  const auto fails = [&](const std::string& lines, const std::vector<std::string>& parts) {
    expect_event_fails("text", "text = \"A\"\n" + lines, 3, parts);
  };
  for (const char* size : {"0", "1000", "inf", "nan"})
    fails("size = " + std::string(size), {"a.toml:10:8: ", "from 0.02 to 10", std::string("found ") + size});
  fails("spacing = -3", {"a.toml:10:11: ", "from -0.5 to 10", "found -3"});
  fails("interval = -1", {"a.toml:10:12: ", "from 0 to 10", "found -1"});
  fails("roll = 999", {"a.toml:10:8: ", "from -360 to 360", "found 999"});
  // Each value is valid, but the resulting row is not.
  expect_event_fails("text", "text = \"" + std::string(1024, 'A') + "\"\nsize = 10\nspacing = 10", 3,
                     {"a.toml:4:1: ", "expected the muzzle within 16384 m"});
}

}  // namespace
}  // namespace brume::cli
