#include "grids/files/slice_atlas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <variant>

#include "core/file.hpp"
#include "grids/dense_grid.hpp"
#include "grids/files/grid_files.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"
#include "tests/grids/child.hpp"
#include "tests/grids/sample_grids.hpp"

namespace brume::grids {
namespace {

namespace fs = std::filesystem;

constexpr Box<double> kUnitBox{glm::dvec3(0), glm::dvec3(1)};
constexpr AtlasDepth kDepths[] = {AtlasDepth::unorm8, AtlasDepth::unorm16, AtlasDepth::half,
                                  AtlasDepth::float32};

std::vector<AtlasAxes> all_axes() {
  std::vector<AtlasAxes> all;
  for (int order = 0; order < 27; ++order) {
    const int x = order % 3, y = order / 3 % 3, z = order / 9;
    if (x == y || y == z || x == z) continue;
    for (int signs = 0; signs < 8; ++signs)
      all.push_back({{{x, (signs & 1) != 0}, {y, (signs & 2) != 0}, {z, (signs & 4) != 0}}});
  }
  return all;
}

DenseGrid random_dense(const std::string& name, glm::uvec3 size, std::uint32_t seed, float low, float high) {
  DenseGrid grid{name, size, {glm::dvec3(-1, 0, 2), glm::dvec3(3, 0.5, 2.25)}, {}};
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(low, high);
  grid.values.resize(std::size_t{size.x} * size.y * size.z);
  for (float& one : grid.values) one = value(random);
  return grid;
}

/// The texel of a tile that one around it shows: the first beyond the rim is that at the rim.
int mirror(int at, int edge) {
  return at < 0 ? -at - 1 : at >= edge ? 2 * edge - at - 1 : at;
}

class SliceAtlasFiles : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  SliceAtlas reloaded(const SliceAtlas& atlas, std::uint32_t levels = 1) const {
    save_slice_atlas(path("a.json"), atlas, levels).value_or_throw();
    return load_slice_atlas(path("a.json")).value_or_throw();
  }
  ChildProgram child_;
  std::vector<std::byte> image_bytes(AtlasDepth depth) const {
    return read_file(atlas_image_path(path("a.json"), depth, 0)).value_or_throw();
  }
  WorkFolder folder_;
};

TEST(SliceLayout, ReadsAndWritesAxes) {
  for (const AtlasAxes& axes : all_axes()) EXPECT_EQ(parse_axes(to_text(axes)), axes);
  EXPECT_EQ(all_axes().size(), 48u);
  for (const char* text : {"", "+x -y", "+x -y +y", "x y z", "+x,-y,+z", "+x -y +w", "+x -y +z "})
    EXPECT_FALSE(parse_axes(text)) << text;
}

TEST(SliceLayout, IsTheSourcesStrip) {
  SliceLayout layout{glm::uvec3(64, 64, 32), kUprightAxes, 32, 0};
  EXPECT_EQ(layout.image_size(), glm::uvec2(2048, 64));
  EXPECT_EQ(layout.voxel(0, {0, 0}), glm::uvec3(0, 63, 0)) << "y is up";
  EXPECT_EQ(layout.voxel(31, {63, 63}), glm::uvec3(63, 0, 31));
  EXPECT_EQ(level_count(layout), 7u);
  EXPECT_EQ(level_of(layout, 6).image_size(), glm::uvec2(32, 1));
  EXPECT_EQ(near_square_columns(layout, true), 4u) << "256 x 512: 8 columns are as far from a square";
}

TEST(SliceLayout, NamesItsFaults) {
  SliceLayout layout{glm::uvec3(4, 4, 4), kUprightAxes, 4, 0};
  EXPECT_FALSE(fault_of(layout));
  layout.columns = 0;
  EXPECT_TRUE(fault_of(layout));
  layout.columns = 5;
  EXPECT_TRUE(fault_of(layout));
  layout = {glm::uvec3(4, 0, 4), kUprightAxes, 4, 0};
  EXPECT_TRUE(fault_of(layout));
  layout = {glm::uvec3(16384, 16384, 16384), kUprightAxes, 1, 0};
  EXPECT_TRUE(fault_of(layout));
  layout = {glm::uvec3(4, 4, 4), kUprightAxes, 4, 0x7fffffffu};
  EXPECT_TRUE(fault_of(layout)) << "64 bits";
}

// Texels in every layout are where the projection of shaders looks for them: the reference walks the image.
TEST_F(SliceAtlasFiles, PutsVoxelsWhereTheAxesSay) {
  const glm::uvec3 size(3, 4, 5);
  for (const AtlasAxes& axes : all_axes()) {
    SliceAtlas atlas{{size, axes, 1, 2}, AtlasDepth::unorm8, glm::dmat4(1), {}, {{0, 255}}};
    atlas.layout.columns = std::min(2u, atlas.layout.tiles());
    DenseGrid grid{"n", size, kUnitBox, {}};
    for (std::uint32_t i = 0; i < 60; ++i) grid.values.push_back(static_cast<float>(i));
    atlas.channels = {grid};
    save_slice_atlas(path("a.json"), atlas).value_or_throw();
    const auto image = image::decode_png_numbers(image_bytes(AtlasDepth::unorm8), "a.png").value_or_throw();
    const glm::ivec2 tile(atlas.layout.tile()), place = tile + 4;
    for (int y = 0; y < static_cast<int>(image.height); ++y)
      for (int x = 0; x < static_cast<int>(image.width); ++x) {
        const int slice = x / place.x + 2 * (y / place.y);
        const std::size_t at =
            static_cast<std::size_t>(x) + std::size_t{image.width} * static_cast<std::size_t>(y);
        if (slice >= static_cast<int>(atlas.layout.tiles())) {
          EXPECT_EQ(image.values[at], 0u);
          continue;
        }
        const int along[3] = {mirror(x % place.x - 2, tile.x), mirror(y % place.y - 2, tile.y), slice};
        glm::ivec3 voxel(0);
        for (std::size_t i = 0; i < 3; ++i) {
          const int edge = static_cast<int>(size[axes[i].axis]);
          voxel[axes[i].axis] = axes[i].reversed ? edge - 1 - along[i] : along[i];
        }
        EXPECT_EQ(image.values[at], voxel.x + 3 * (voxel.y + 4 * voxel.z))
            << to_text(axes) << " " << x << "," << y;
      }
  }
}

// From a description and image back to the same bytes, at every depth, in every layout.
TEST_F(SliceAtlasFiles, AreLossless) {
  std::uint32_t seed = 0;
  for (const AtlasDepth depth : kDepths)
    for (const glm::uvec3 size :
         {glm::uvec3(1), glm::uvec3(7, 1, 3), glm::uvec3(33, 17, 5), glm::uvec3(8, 8, 32)})
      for (const std::uint32_t columns : {1u, 3u, 64u})
        for (const std::uint32_t padding : {0u, 1u, 4u}) {
          const AtlasAxes axes = all_axes()[seed % 48];
          SliceAtlas atlas{{size, axes, 1, padding}, depth, glm::dmat4(1), {}, {}};
          atlas.layout.columns = std::min(columns, atlas.layout.tiles());
          for (std::uint32_t channel = 0; channel < 1 + seed % 4; ++channel) {
            atlas.channels.push_back(random_dense("c" + std::to_string(channel), size, ++seed, -3.7f, 11.3f));
            atlas.ranges.push_back(range_of(atlas.channels.back()));
          }
          ++seed;
          const SliceAtlas once = reloaded(atlas);
          const std::vector<std::byte> first = image_bytes(depth);
          const std::string text = read_text_file(path("a.json")).value_or_throw();
          const SliceAtlas twice = reloaded(once);
          EXPECT_EQ(image_bytes(depth), first) << name_of(depth) << " " << seed;
          EXPECT_EQ(read_text_file(path("a.json")).value_or_throw(), text);
          EXPECT_EQ(once.layout, atlas.layout);
          for (std::size_t i = 0; i < atlas.channels.size(); ++i) {
            EXPECT_EQ(once.channels[i].name, atlas.channels[i].name);
            EXPECT_EQ(once.channels[i].box, atlas.channels[i].box);
            EXPECT_EQ(once.channels[i].values, twice.channels[i].values);
            EXPECT_EQ(once.ranges[i], atlas.ranges[i]);
          }
        }
}

// All codes of 16 bits, in a range that floats represent badly.
// Readers of colours refuse images of two.
TEST_F(SliceAtlasFiles, TwoChannelsAreThreeInTheImage) {
  for (const AtlasDepth depth : kDepths) {
    SCOPED_TRACE(name_of(depth));
    SliceAtlas atlas{{glm::uvec3(3, 4, 5), kUprightAxes, 2, 1}, depth, glm::dmat4(1), {}, {{0, 1}, {0, 1}}};
    atlas.channels = {random_dense("first", atlas.layout.size, 1, 0, 1),
                      random_dense("second", atlas.layout.size, 2, 0, 1)};
    EXPECT_EQ(reloaded(atlas).channels.size(), 2u);
    const auto bytes = image_bytes(depth);
    if (depth == AtlasDepth::unorm8 || depth == AtlasDepth::unorm16) {
      EXPECT_EQ(image::decode_png_numbers(bytes, "a.png").value_or_throw().channels, 3u);
      continue;
    }
    const image::LayeredImage image = image::decode_exr(bytes, "a.exr").value_or_throw();
    ASSERT_EQ(image.layers.size(), 3u);
    EXPECT_EQ(image.layers[0].name, "B");
    std::visit(
        [](const auto& values) { EXPECT_EQ(std::ranges::count(values, 0), std::ranges::ssize(values)); },
        image.layers[0].values);
  }
}

TEST_F(SliceAtlasFiles, KeepEveryCode) {
  const glm::uvec3 size(256, 16, 16);
  for (const auto& [low, high] : {std::pair(0.0f, 1.0f), std::pair(-0.1f, 0.7f), std::pair(3.0f, 3.0625f)}) {
    SliceAtlas atlas{{size, kUprightAxes, 4, 0}, AtlasDepth::unorm16, glm::dmat4(1), {}, {{low, high}}};
    DenseGrid grid{"all", size, kUnitBox, {}};
    for (std::uint32_t code = 0; code < 65536; ++code)
      grid.values.push_back(static_cast<float>(double{low} + (double{high} - double{low}) * code / 65535));
    atlas.channels = {grid};
    EXPECT_EQ(reloaded(atlas).channels[0].values, grid.values);
  }
}

TEST_F(SliceAtlasFiles, AreWithinHalfAStepOfAVolume) {
  for (const AtlasDepth depth : {AtlasDepth::unorm8, AtlasDepth::unorm16}) {
    const Grid grid = smoke_grid("smoke", 9);
    GridFile file{{grid}, {}};
    save_grid_file(path("in.vdb"), file).value_or_throw();
    const GridFile read = load_grid_file(path("in.vdb")).value_or_throw();
    const Grid* const only = read.grids.data();
    const GridBox box = box_of(std::span(&only, 1)).value_or_throw();
    const DenseGrid dense = resample(*only, box).value_or_throw();
    SliceAtlas atlas{{box.size, kUprightAxes, 3, 1}, depth, box.world_from_box, {dense}, {range_of(dense)}};
    save_grid_file(path("out.vdb"), to_grids(reloaded(atlas))).value_or_throw();
    const GridFile back = load_grid_file(path("out.vdb")).value_or_throw();

    // The same voxels at the same place.
    const Grid* const other = back.grids.data();
    const GridBox again = box_of(std::span(&other, 1)).value_or_throw();
    EXPECT_EQ(again.size, box.size);
    EXPECT_LT(glm::length(again.box.low - box.box.low), 1e-12);
    const DenseGrid values = resample(*other, again).value_or_throw();
    const double step = (double{atlas.ranges[0].high} - double{atlas.ranges[0].low}) /
                        (depth == AtlasDepth::unorm8 ? 255 : 65535);
    ASSERT_EQ(values.values.size(), dense.values.size());
    for (std::size_t i = 0; i < values.values.size(); ++i)
      // And half a unit of a float.
      ASSERT_NEAR(double{values.values[i]}, double{dense.values[i]}, 0.5 * step + 1e-7);
  }
}

TEST_F(SliceAtlasFiles, KeepARotatedPlace) {
  const glm::dmat4 place({0, 0.5, 0, 0}, {-0.25, 0, 0.1, 0}, {0, 0.2, 3, 0}, {7, 8, 9, 1});
  const DenseGrid grid = random_dense("d", {4, 5, 6}, 1, 0, 1);
  const SliceAtlas atlas{{grid.size, kUprightAxes, 2, 0}, AtlasDepth::half, place, {grid}, {{0, 1}}};
  EXPECT_EQ(reloaded(atlas).world_from_box, place);
  const Grid back = to_grids(atlas).grids[0];
  const glm::dvec4 middle(grid.box.low + 0.5 * grid.voxel_size(), 1);
  EXPECT_LT(glm::length(back.world_from_index * glm::dvec4(0, 0, 0, 1) - place * middle), 1e-12);
}

// A texel of a level is the mean of what it covers, and of nothing else: tiles of one value stay of one
// value.
TEST_F(SliceAtlasFiles, HalveTilesWithinThemselves) {
  const glm::uvec3 size(16, 8, 5);
  DenseGrid grid{"d", size, kUnitBox, {}};
  for (std::uint32_t i = 0; i < 16 * 8 * 5; ++i) grid.values.push_back(static_cast<float>(i / 128) * 51);
  SliceAtlas atlas{{size, kUprightAxes, 2, 4}, AtlasDepth::unorm8, glm::dmat4(1), {grid}, {{0, 255}}};
  ASSERT_EQ(level_count(atlas.layout), 3u) << "16 x 8 + 4, 8 x 4 + 2, 4 x 2 + 1";
  save_slice_atlas(path("a.json"), atlas, 3).value_or_throw();
  for (std::uint32_t level = 0; level < 3; ++level) {
    const fs::path file = atlas_image_path(path("a.json"), atlas.depth, level);
    const auto image =
        image::decode_png_numbers(read_file(file).value_or_throw(), file.string()).value_or_throw();
    const glm::uvec2 place = (glm::uvec2(16, 8) >> level) + (8u >> level);
    ASSERT_EQ(glm::uvec2(image.width, image.height), place * glm::uvec2(2, 3));
    for (std::uint32_t y = 0; y < image.height; ++y)
      for (std::uint32_t x = 0; x < image.width; ++x) {
        const std::uint32_t tile = x / place.x + 2 * (y / place.y);
        EXPECT_EQ(image.values[x + std::size_t{image.width} * y], tile < 5 ? tile * 51 : 0);
      }
  }
}

TEST_F(SliceAtlasFiles, ClampValuesBeyondTheRange) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  DenseGrid grid{"d", {5, 1, 1}, kUnitBox, {-kInfinity, -1, std::nanf(""), 0.5f, kInfinity}};
  const SliceAtlas atlas{
      {grid.size, kUprightAxes, 1, 0}, AtlasDepth::unorm8, glm::dmat4(1), {grid}, {{0, 1}}};
  const std::vector<float> values = reloaded(atlas).channels[0].values;
  EXPECT_EQ(values, (std::vector<float>{0, 0, 0, 128 / 255.0f, 1}));
}

TEST_F(SliceAtlasFiles, RefuseARangeThatFloatsCannotDivide) {
  DenseGrid grid{"d", {1, 1, 1}, kUnitBox, {1000}};
  SliceAtlas atlas{
      {grid.size, kUprightAxes, 1, 0}, AtlasDepth::unorm16, glm::dmat4(1), {grid}, {{1000, 1001}}};
  const auto saved = save_slice_atlas(path("a.json"), atlas);
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.failure().message.find(".exr"), std::string::npos) << saved.failure().message;
  EXPECT_FALSE(fs::exists(path("a.png")));
  atlas.depth = AtlasDepth::float32;
  EXPECT_TRUE(save_slice_atlas(path("a.json"), atlas));
}

TEST_F(SliceAtlasFiles, OpenAsVolumes) {
  const DenseGrid grid = random_dense("smoke", {9, 4, 6}, 5, 0, 1);
  save_slice_atlas(path("a.json"),
                   {{grid.size, kUprightAxes, 2, 0}, AtlasDepth::unorm8, glm::dmat4(1), {grid}, {{0, 1}}})
      .value_or_throw();
  for (const char* name : {"a.json", "a.png"}) {
    EXPECT_TRUE(is_grid_file(path(name))) << name;
    const GridFile file = load_grid_file(path(name)).value_or_throw();
    EXPECT_EQ(file.grids[0].name, "smoke");
    EXPECT_EQ(count_active(file.grids[0]), 9u * 4 * 6);
    EXPECT_EQ(files_of(path(name)).value_or_throw(), (std::vector{path("a.json"), path("a.png")}));
  }
  EXPECT_FALSE(is_grid_file(path("b.png")));
  // What is missing is what was named.
  for (const auto& failure : {load_grid_file(path("b.png")).failure(), files_of(path("b.png")).failure()})
    EXPECT_NE(failure.message.find("b.png: cannot open"), std::string::npos) << failure.message;
}

// One line that names the place; nothing is read beyond what is checked.
TEST_F(SliceAtlasFiles, RefuseDescriptionsThatLie) {
  const DenseGrid grid = random_dense("d", {8, 4, 6}, 5, 0, 1);
  save_slice_atlas(path("a.json"),
                   {{grid.size, kUprightAxes, 3, 1}, AtlasDepth::unorm8, glm::dmat4(1), {grid}, {{0, 1}}})
      .value_or_throw();
  const std::string good = read_text_file(path("a.json")).value_or_throw();
  ASSERT_TRUE(load_slice_atlas(path("a.json")));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    write_file_atomic(path("a.json"), text).value_or_throw();
    const auto loaded = load_slice_atlas(path("a.json"));
    EXPECT_FALSE(loaded) << to;
    const std::string message = loaded ? "" : loaded.failure().message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  };
  EXPECT_NE(with("\"tiles\": 6", "\"tiles\": 7").find("\"tiles\""), std::string::npos);
  for (const char* tiles : {"0", "-1", "1e9", "\"6\"", "99999999999999999999"})
    with("\"tiles\": 6", std::string("\"tiles\": ") + tiles);
  for (const char* columns : {"0", "7", "-3", "4294967297"})
    with("\"columns\": 3", std::string("\"columns\": ") + columns);
  with("\"padding\": 1", "\"padding\": 2");
  with("\"padding\": 1", "\"padding\": 4294967295");
  with("+x -y +z", "+x -y -y");
  with("\"depth\": \"unorm8\"", "\"depth\": \"unorm16\"");
  with("\"depth\": \"unorm8\"", "\"depth\": \"half\"");
  with("\"a.png\"", "\"../a.png\"");
  with("\"a.png\"", "\"missing.png\"");
  with("\"images\": [", "\"images\": [\"b.png\", \"c.png\", \"d.png\", \"e.png\", ");
  with("\"version\": 1", "\"version\": 2");
  with("\"box\": {", "\"box\": {\"middle\": 1,");
  with("\"in\": \"R\"", "\"in\": \"G\"");
  with("\"name\": \"d\"", "\"name\": 7");
  with("\"low\": [", "\"low\": [null, 0, 0], \"old\": [");
  with("1.0\n", "0.0\n");
  with("{", "{\"unknown\": 1,");
  with("{", "[");
  // An image of another size than all agree on.
  std::string text = good;
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"\"columns\": 3", "\"columns\": 2"}}) {
    text.replace(text.find(from), from.size(), to);
    const std::size_t size = text.find("\"image_size\"");
    text.replace(size, text.find(']', size) + 1 - size, "\"image_size\": [20, 18]");
  }
  write_file_atomic(path("a.json"), text).value_or_throw();
  const auto loaded = load_slice_atlas(path("a.json"));
  ASSERT_FALSE(loaded);
  EXPECT_NE(loaded.failure().message.find("a.png: has 30 x 12 texels"), std::string::npos)
      << loaded.failure().message;
}

}  // namespace
}  // namespace brume::grids
