#include "scenario/vxl_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <random>

#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/log.hpp"

namespace brume::scenario {
namespace {

using glm::ivec3;
using glm::vec3;
using voxel::BitGrid;
using voxel::GridLayout;
using voxel::Plane;

constexpr std::uint64_t kKey = 42;

// A room: a floor, a slanted roof, one loose triangle.
scene::Scene small_scene() {
  scene::Scene scene;
  scene::Mesh mesh;
  for (const vec3 p : {vec3(-1, 0.1f, -1), vec3(2, 0.1f, -1), vec3(2, 0.1f, 2), vec3(-1, 0.1f, 2),
                       vec3(0, 1.5f, 0), vec3(1, 2, 0.5f), vec3(0.2f, 1.1f, 1)})
    mesh.vertices.emplace_back().position = p;
  mesh.indices = {0, 2, 1, 0, 3, 2, 4, 5, 6};
  scene.meshes.push_back(mesh);
  scene.objects.emplace_back().mesh = 0;
  return scene;
}

const GridLayout kFrame{{11, 7, 9}, 0.4f, vec3(-1.3f, -0.4f, -1.1f)};

VxlContents small_contents() {
  auto voxels = load_or_voxelize(small_scene(), kFrame, {});
  return {std::move(voxels->grid), std::move(voxels->planes), voxels->triangles};
}

void expect_same(const BitGrid& a, const BitGrid& b) {
  ASSERT_EQ(a.layout(), b.layout());
  for (int z = 0; z < a.size().z; ++z)
    for (int y = 0; y < a.size().y; ++y)
      for (int x = 0; x < a.size().x; ++x) ASSERT_EQ(a.solid({x, y, z}), b.solid({x, y, z}));
}

// Counts warnings in a scope.
class Warnings {
 public:
  Warnings() {
    set_log_callback([this](LogLevel level, const std::string& line) {
      if (level == LogLevel::warning) ++count, last = line;
    });
  }
  ~Warnings() { set_log_callback({}); }
  int count = 0;
  std::string last;
};

class VxlFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / ("brume_vxl_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    path_ = folder_ / "scene.vxl";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_, path_;
};

TEST(VxlCodec, RoundTrips) {
  const VxlContents contents = small_contents();
  ASSERT_GT(contents.planes.plane_count(), 10u);
  const auto bytes = encode_vxl(contents, kKey);
  const auto decoded = decode_vxl(bytes, kKey);
  ASSERT_TRUE(decoded) << decoded.failure().message;
  ASSERT_TRUE(*decoded);
  expect_same((*decoded)->grid, contents.grid);
  EXPECT_EQ((*decoded)->planes, contents.planes);
  EXPECT_EQ((*decoded)->triangles, 3u);
  EXPECT_EQ(encode_vxl(**decoded, kKey), bytes);
  EXPECT_FALSE(*decode_vxl(bytes, kKey + 1));
  EXPECT_TRUE(*decode_vxl(bytes, std::nullopt));
}

TEST(VxlCodec, RoundTripsAnEmptyGrid) {
  const auto bytes = encode_vxl({BitGrid({{1, 1, 1}, 1, vec3(0)}), {}, 0}, kKey);
  const auto decoded = decode_vxl(bytes, kKey);
  ASSERT_TRUE(decoded && *decoded);
  EXPECT_EQ((*decoded)->grid.count_solid(), 0u);
}

TEST(VxlCodec, RejectsEveryTruncation) {
  const auto bytes = encode_vxl(small_contents(), kKey);
  for (std::size_t length = 0; length < bytes.size(); ++length)
    ASSERT_FALSE(decode_vxl(std::span(bytes).first(length), kKey)) << length;
}

TEST(VxlCodec, RejectsEveryFlippedBit) {
  auto bytes = encode_vxl(small_contents(), kKey);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto mask = static_cast<std::byte>(1u << bit % 8);
    bytes[bit / 8] ^= mask;
    ASSERT_FALSE(decode_vxl(bytes, kKey)) << bit;
    bytes[bit / 8] ^= mask;
  }
}

TEST(VxlCodec, SurvivesFlippedBitsWithAMatchingChecksum) {
  // Damage with a matching checksum: either rejected or another valid grid.
  auto bytes = encode_vxl(small_contents(), kKey);
  int refused = 0;
  for (std::size_t bit = 0; bit < 8 * (bytes.size() - 8); ++bit) {
    auto damaged = bytes;
    damaged[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    const std::uint64_t checksum = hash_bytes(std::span(damaged).first(damaged.size() - 8));
    std::memcpy(damaged.data() + damaged.size() - 8, &checksum, 8);
    const auto decoded = decode_vxl(damaged, std::nullopt);
    refused += !decoded;
    if (!decoded || !*decoded) continue;
    // No voxel outside of the grid: every counted one can be queried.
    std::uint64_t inside = 0;
    (*decoded)->grid.for_each_brick([&](ivec3 at, const BitGrid::Brick&) {
      for (int i = 0; i < 512; ++i)
        inside += (*decoded)->grid.solid(8 * at + ivec3(i & 7, i >> 3 & 7, i >> 6));
    });
    ASSERT_EQ((*decoded)->grid.count_solid(), inside);
    for (const Plane& plane : (*decoded)->planes.planes()) ASSERT_NEAR(glm::length(plane.normal), 1, 1e-3);
  }
  EXPECT_GT(refused, 0);
}

TEST_F(VxlFile, SecondRunLoadsTheCache) {
  const Warnings warnings;
  const auto first = load_or_voxelize(small_scene(), kFrame, path_);
  const auto second = load_or_voxelize(small_scene(), kFrame, path_);
  ASSERT_TRUE(first && second);
  EXPECT_FALSE(first->cached);
  EXPECT_TRUE(second->cached);
  EXPECT_EQ(second->milliseconds, 0);
  EXPECT_EQ(second->triangles, 3u);
  expect_same(first->grid, second->grid);
  EXPECT_EQ(first->planes, second->planes);
  EXPECT_EQ(warnings.count, 0);
}

TEST_F(VxlFile, RebuildsWhenAVertexObjectOrGridMoves) {
  const Warnings warnings;
  const auto cached = [&](const scene::Scene& scene, const GridLayout& layout) {
    const auto voxels = load_or_voxelize(scene, layout, path_);
    return voxels && voxels->cached;
  };
  scene::Scene scene = small_scene();
  GridLayout layout = kFrame;
  EXPECT_FALSE(cached(scene, layout));
  EXPECT_TRUE(cached(scene, layout));
  scene.meshes[0].vertices[4].position.x += 0.001f;
  EXPECT_FALSE(cached(scene, layout));
  EXPECT_TRUE(cached(scene, layout));
  scene.objects[0].world_from_mesh[3].y += 0.001f;
  EXPECT_FALSE(cached(scene, layout));
  layout.size.x += 1;
  EXPECT_FALSE(cached(scene, layout));
  layout.voxel_size = 0.41f;
  EXPECT_FALSE(cached(scene, layout));
  layout.origin_world.z += 0.1f;
  EXPECT_FALSE(cached(scene, layout));
  EXPECT_TRUE(cached(scene, layout));
  EXPECT_EQ(warnings.count, 0);
}

TEST_F(VxlFile, RebuildsDamagedAndForeignFilesWithOneWarning) {
  ASSERT_TRUE(load_or_voxelize(small_scene(), kFrame, path_));
  const auto whole = read_file(path_);
  ASSERT_TRUE(whole);
  std::vector<std::vector<std::byte>> bad(4, *whole);
  bad[0].resize(bad[0].size() / 2);
  bad[1][100] ^= std::byte{4};
  bad[2].clear();
  bad[3].assign(500, std::byte{'x'});
  for (const auto& bytes : bad) {
    ASSERT_TRUE(write_file_atomic(path_, bytes));
    const Warnings warnings;
    const auto voxels = load_or_voxelize(small_scene(), kFrame, path_);
    ASSERT_TRUE(voxels);
    EXPECT_FALSE(voxels->cached);
    EXPECT_EQ(warnings.count, 1);
    EXPECT_NE(warnings.last.find("scene.vxl"), std::string::npos);
    EXPECT_EQ(*read_file(path_), *whole);
  }
}

TEST_F(VxlFile, FailsWhereTheCacheCannotBeWritten) {
  const auto voxels = load_or_voxelize(small_scene(), kFrame, folder_ / "none" / "scene.vxl");
  ASSERT_FALSE(voxels);
  EXPECT_NE(voxels.failure().message.find("none"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace brume::scenario
