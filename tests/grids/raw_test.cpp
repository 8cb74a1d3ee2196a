#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "core/file.hpp"
#include "grids/files/raw_file.hpp"
#include "tests/grids/child.hpp"
#include "tests/grids/sample_grids.hpp"

namespace brume::grids {
namespace {

namespace fs = std::filesystem;

class Raw : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  std::string error_of(const std::string& json, const GridLimits& limits = {}) const {
    const auto file = load_raw(path(folder_.write("a.json", json)), limits);
    return file ? "" : file.failure().message;
  }
  WorkFolder folder_;
};

TEST_F(Raw, KeepsFloatsAndTheirPlace) {
  Grid grid = smoke_grid("smoke", 11);
  grid.saved_as_half = false;
  grid.world_from_index = {
      {0.1, 0.0173, 0, 0}, {-0.02, 1.0 / 3, 0, 0}, {0.3, 0, -0.2, 0}, {1e5 / 7, -3, 0.1, 1}};
  save_raw(path("a.json"), grid).value_or_throw();
  EXPECT_EQ(fs::file_size(path("a.raw")), 21u * 21 * 21 * 4);
  expect_same(load_raw(path("a.json")).value_or_throw(), {{grid}, {}});
}

TEST_F(Raw, WritesTheBoxOfActiveVoxelsXFirst) {
  Grid grid;
  grid.background = {};
  Brick brick{glm::ivec3(-8, 0, 8)};
  std::vector<float> values(kBrickVoxels);
  // Voxels (-7, 1, 8) and (-6, 1, 9).
  brick.active[0] = 1ull << 9;
  brick.active[1] = 1ull << 10;
  values[9] = 2;
  values[64 + 10] = 3;
  grid.bricks.push_back(brick);
  const auto bytes = std::as_bytes(std::span(values));
  grid.values.assign(bytes.begin(), bytes.end());
  save_raw(path("a.json"), grid).value_or_throw();
  const auto array = *read_file(path("a.raw"));
  const std::vector<float> expected{2, 0, 0, 3};
  ASSERT_EQ(array.size(), 16u);
  EXPECT_EQ(std::memcmp(array.data(), expected.data(), 16), 0);
  const std::string text = *read_text_file(path("a.json"));
  EXPECT_NE(text.find("\"raw\": \"a.raw\""), std::string::npos);
}

TEST_F(Raw, FillsTiles) {
  Grid grid;
  const float seven = 7;
  Tile tile{glm::ivec3(-8), 8, true, {}};
  std::memcpy(tile.value.data(), &seven, sizeof seven);
  grid.tiles.push_back(tile);
  save_raw(path("a.json"), grid).value_or_throw();
  const GridFile again = load_raw(path("a.json")).value_or_throw();
  EXPECT_EQ(count_active(again.grids[0]), 512u);
  EXPECT_EQ(active_bounds(again.grids[0]).low, glm::dvec3(-8.5));
}

TEST_F(Raw, RefusesGridsThatItCannotHold) {
  EXPECT_FALSE(save_raw(path("a.json"), random_grid(ValueType::vec3f, 1)));
  EXPECT_FALSE(save_raw(path("a.json"), Grid{}));
  const auto huge = save_raw(path("a.json"), huge_tile());
  ASSERT_FALSE(huge);
  EXPECT_EQ(huge.failure().code, ErrorCode::resource_limit);
  EXPECT_FALSE(fs::exists(path("a.raw")));
}

TEST_F(Raw, NamesWhatIsWrongInADescription) {
  folder_.write("b.raw", std::string(32, '\0'));
  const std::string head = R"({"format": "brume raw volume", "version": 1, )";
  EXPECT_EQ(error_of(head + R"("raw": "b.raw", "size": [2, 2, 2]})"), "");
  for (
      const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
          {"", "not a JSON object"},
          {"[1]", "not a JSON object"},
          {std::string(100, '['), "not a JSON object"},
          {"{}", "\"format\" is missing"},
          {R"({"format": "x"})", "describes no volume, but a file of the format \"x\""},
          {head + R"("raw": "b.raw"})", "\"size\" is missing"},
          {head + R"("size": [2, 2, 2]})", "\"raw\" is missing"},
          {head + R"("raw": "../b.raw", "size": [2, 2, 2]})", "\"raw\""},
          {head + R"("raw": "/etc/passwd", "size": [2, 2, 2]})", "\"raw\""},
          {head + R"("raw": "none.raw", "size": [2, 2, 2]})", "none.raw"},
          {head + R"("raw": "b.raw", "size": [2, 2, 3]})", "b.raw: has 32 bytes"},
          {head + R"("raw": "b.raw", "size": [2, 2, 0]})", "\"size\""},
          {head + R"("raw": "b.raw", "size": [2, 2, 2.5]})", "\"size\""},
          {head + R"("raw": "b.raw", "size": [2, 2, 18446744073709551615]})", "\"size\""},
          {head + R"("raw": "b.raw", "size": [1000000000, 1000000000, 1000000000]})",
           "larger than the limit"},
          {head + R"("raw": "b.raw", "size": [2, 2, 2], "sise": 1})", "\"sise\""},
          {head + R"("raw": "b.raw", "size": [2, 2, 2], "background": 1e300})", "\"background\""},
          {head +
               R"("raw": "b.raw", "size": [2, 2, 2], "world_from_index": [[0,0,0],[0,0,0],[0,0,0],[0,0,0]]})",
           "transform"}})
    EXPECT_NE(error_of(text).find(part), std::string::npos) << text << "\n" << error_of(text);
  EXPECT_NE(error_of(head + R"("raw": "b.raw", "size": [2, 2, 2], "background": 1})", {.bytes = 1000})
                .find("limit"),
            std::string::npos);
}

}  // namespace
}  // namespace brume::grids
