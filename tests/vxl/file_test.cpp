#include "vxl/file.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "core/file.hpp"
#include "core/hash.hpp"
#include "tests/work_folder.hpp"
#include "voxel/voxelize.hpp"

namespace brume::vxl {
namespace {

using voxel::BitGrid;
using voxel::Plane;
using voxel::Solids;
using voxel::SurfacePlanes;
using voxel::Triangle;
using voxel::TrianglesByRole;
using voxel::voxelize;

using glm::ivec3;
using glm::vec3;

constexpr std::uint64_t kKey = 42;

// A floor and one loose triangle.
Contents small_contents() {
  const vec3 a(-1, 0.1f, -1), b(2, 0.1f, -1), c(2, 0.1f, 2), d(-1, 0.1f, 2);
  const std::vector<Triangle> triangles{
      {a, c, b}, {a, d, c}, {vec3(0, 1.5f, 0), vec3(1, 2, 0.5f), vec3(0.2f, 1.1f, 1)}};
  Contents contents{
      *voxelize(triangles, {{11, 7, 9}, 0.4f, vec3(-1.3f, -0.4f, -1.1f)}), {}, triangles.size()};
  contents.planes = SurfacePlanes::build(triangles, contents.grid);
  return contents;
}

void expect_same(const BitGrid& a, const BitGrid& b) {
  ASSERT_EQ(a.layout(), b.layout());
  for (int z = 0; z < a.size().z; ++z)
    for (int y = 0; y < a.size().y; ++y)
      for (int x = 0; x < a.size().x; ++x) ASSERT_EQ(a.solid({x, y, z}), b.solid({x, y, z}));
}

TEST(VxlCodec, RoundTrips) {
  const Contents contents = small_contents();
  ASSERT_GT(contents.planes.plane_count(), 10u);
  const auto bytes = encode(contents, kKey);
  const auto decoded = decode(bytes, kKey);
  ASSERT_TRUE(decoded) << decoded.failure().message;
  ASSERT_TRUE(*decoded);
  expect_same((*decoded)->grid, contents.grid);
  EXPECT_EQ((*decoded)->planes, contents.planes);
  EXPECT_EQ((*decoded)->triangles, 3u);
  EXPECT_EQ(encode(**decoded, kKey), bytes);
  EXPECT_FALSE(*decode(bytes, kKey + 1));
  EXPECT_TRUE(*decode(bytes, std::nullopt));
}

/// The same with a pane of glass across it, and a grille above.
Contents contents_with_roles(bool glass, bool grille) {
  const vec3 a(0.5f, -1, -1), b(0.5f, 2, -1), c(0.5f, 2, 2), d(-1, 1.9f, -1), e(-1, 1.9f, 2);
  Contents contents = small_contents();
  TrianglesByRole triangles;
  if (glass) triangles.add(Role::glass, std::vector<Triangle>{{a, b, c}});
  if (glass) contents.grid = united(contents.grid, *voxelize(triangles.smoke, contents.grid.layout()));
  if (glass) contents.roles.sight = small_contents().grid;
  if (grille)
    contents.roles.bodies =
        united(contents.grid, *voxelize(std::vector<Triangle>{{b, d, e}}, contents.grid.layout()));
  return contents;
}

TEST(VxlCodec, RoundTripsRoles) {
  for (const auto& [glass, grille] : {std::pair(true, false), {false, true}, {true, true}}) {
    const Contents contents = contents_with_roles(glass, grille);
    const auto bytes = encode(contents, kKey);
    const auto decoded = decode(bytes, kKey);
    ASSERT_TRUE(decoded) << decoded.failure().message;
    const Contents& back = **decoded;
    EXPECT_EQ(encode(back, kKey), bytes);
    EXPECT_EQ(back.roles.sight.has_value(), glass);
    EXPECT_EQ(back.roles.bodies.has_value(), grille);
    const Solids expected(contents.grid, contents.roles), got(back.grid, back.roles);
    int glasses = 0, grilles = 0;
    for_each_in(Box<int>{ivec3(0), contents.grid.size()}, [&](ivec3 v) {
      ASSERT_EQ(got.role(v), expected.role(v));
      glasses += got.role(v) == Role::glass;
      grilles += got.role(v) == Role::grille;
    });
    EXPECT_EQ(glasses > 0, glass);
    EXPECT_EQ(grilles > 0, grille);
    for (std::size_t length = 0; length < bytes.size(); ++length)
      ASSERT_FALSE(decode(std::span(bytes).first(length), kKey)) << length;
  }
}

TEST(VxlCodec, WallsAloneAreAFileOfTheFirstVersion) {
  Contents contents = small_contents();
  const auto bytes = encode(contents, kKey);
  std::uint32_t version = 0;
  std::memcpy(&version, bytes.data() + 8, sizeof version);
  EXPECT_EQ(version, kVersion);
  contents.roles = {contents.grid, contents.grid};  // as if glass and grilles lay in walls
  EXPECT_EQ(encode(contents, kKey), bytes);
}

TEST(VxlCodec, RoundTripsAnEmptyGrid) {
  const auto bytes = encode({BitGrid({{1, 1, 1}, 1, vec3(0)}), {}, 0}, kKey);
  const auto decoded = decode(bytes, kKey);
  ASSERT_TRUE(decoded && *decoded);
  EXPECT_EQ((*decoded)->grid.count_solid(), 0u);
}

TEST(VxlCodec, RejectsEveryTruncation) {
  const auto bytes = encode(small_contents(), kKey);
  for (std::size_t length = 0; length < bytes.size(); ++length)
    ASSERT_FALSE(decode(std::span(bytes).first(length), kKey)) << length;
}

TEST(VxlCodec, RejectsEveryFlippedBit) {
  auto bytes = encode(small_contents(), kKey);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto mask = static_cast<std::byte>(1u << bit % 8);
    bytes[bit / 8] ^= mask;
    ASSERT_FALSE(decode(bytes, kKey)) << bit;
    bytes[bit / 8] ^= mask;
  }
}

class VxlDamage : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Roles, VxlDamage, testing::Bool());

TEST_P(VxlDamage, SurvivesFlippedBitsWithAMatchingChecksum) {
  // Damage with a matching checksum: either rejected or another valid grid.
  auto bytes = encode(GetParam() ? contents_with_roles(true, true) : small_contents(), kKey);
  int refused = 0;
  for (std::size_t bit = 0; bit < 8 * (bytes.size() - 8); ++bit) {
    auto damaged = bytes;
    damaged[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    const std::uint64_t checksum = hash_bytes(std::span(damaged).first(damaged.size() - 8));
    std::memcpy(damaged.data() + damaged.size() - 8, &checksum, 8);
    const auto decoded = decode(damaged, std::nullopt);
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

TEST(VxlFile, LoadsWhatWasSavedAndNamesAFileThatIsDamaged) {
  const cli::WorkFolder folder;
  const auto path = folder.path() / "room.vxl";
  const Contents contents = small_contents();
  ASSERT_TRUE(save(path, contents, kKey));
  EXPECT_EQ(*read_file(path), encode(contents, kKey));
  const auto loaded = load(path, kKey);
  ASSERT_TRUE(loaded && *loaded);
  EXPECT_EQ((*loaded)->planes, contents.planes);

  ASSERT_TRUE(write_file_atomic(path, std::string("no voxels")));
  const auto damaged = load(path, kKey);
  ASSERT_FALSE(damaged);
  EXPECT_NE(damaged.failure().message.find("room.vxl: "), std::string::npos) << damaged.failure().message;
}

}  // namespace
}  // namespace brume::vxl
