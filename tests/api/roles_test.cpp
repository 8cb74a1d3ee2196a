// Roles through the C interface.
#include <gtest/gtest.h>
#include <brume/brume.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace brume::api {
namespace {

constexpr float kWalls = std::numeric_limits<float>::infinity();

/// A square across the z axis, two triangles, of a role; corners at +-2 m.
struct Panes {
  std::vector<brume_point> points;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint8_t> roles;

  void add(float z, std::uint8_t role) {
    const auto first = static_cast<std::uint32_t>(points.size());
    for (const auto& [x, y] : {std::pair(-2.0f, -2.0f), {2.0f, -2.0f}, {2.0f, 2.0f}, {-2.0f, 2.0f}})
      points.push_back({x, y, z});
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + i);
    roles.insert(roles.end(), {role, role});
  }
  brume_triangles_params params() const {
    brume_triangles_params params = brume_triangles_defaults();
    params.layout = {{8, 8, 16}, 0.5f, {-2, -2, -4}};
    params.points = points.data();
    params.point_count = points.size();
    params.indices = indices.data();
    params.index_count = indices.size();
    params.roles = roles.data();
    return params;
  }
};

class ApiRoles : public testing::Test {
 protected:
  bool sees(const Field& field, float from_z, float to_z) {
    const brume_segment segment{{0.1f, 0.1f, from_z}, {0.1f, 0.1f, to_z}};
    std::uint8_t visible = 2;
    EXPECT_EQ(brume_field_visible(field.get(), &segment, 1, kWalls, &visible), BRUME_OK);
    brume_wall wall{};
    EXPECT_EQ(brume_field_first_walls(field.get(), &segment, 1, &wall), BRUME_OK);
    EXPECT_EQ(visible, 1 - wall.hit);
    return visible == 1;
  }
  Context context_;
};

TEST_F(ApiRoles, OfTriangles) {
  Panes panes;
  panes.add(-2.25f, BRUME_ROLE_GLASS);
  panes.add(-0.25f, BRUME_ROLE_GRILLE);
  panes.add(0.75f, BRUME_ROLE_GHOST);
  panes.add(1.75f, BRUME_ROLE_WALL);
  const Level level(context_, panes.params());
  const Bytes roles = level.roles({0, 0, 0}, {8, 8, 16}), solid = level.solid({0, 0, 0}, {8, 8, 16});
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const std::size_t z = i / 64;  // the middle of layer z is at -3.75 + z / 2
    const auto expected = static_cast<std::uint8_t>(z == 3    ? BRUME_ROLE_GLASS
                                                    : z == 7  ? BRUME_ROLE_GRILLE
                                                    : z == 11 ? BRUME_ROLE_WALL
                                                              : BRUME_ROLE_GHOST);
    ASSERT_EQ(roles[i], expected) << z;
    ASSERT_EQ(solid[i], expected <= BRUME_ROLE_GLASS ? 1 : 0) << z;
  }
  const Field field(level);
  EXPECT_TRUE(sees(field, -3.7f, 1)) << "through glass, grille and ghost";
  EXPECT_FALSE(sees(field, -3.7f, 3)) << "through the wall";
}

// Smoke that goes off behind glass stays there; through a grille it comes to the eye.
TEST_F(ApiRoles, OfSmokeAndGrenades) {
  for (const std::uint8_t role : {BRUME_ROLE_WALL, BRUME_ROLE_GLASS, BRUME_ROLE_GRILLE, BRUME_ROLE_GHOST}) {
    Panes panes;
    panes.add(-0.25f, role);
    const Level level(context_, panes.params());
    World world(level);
    brume_event event{};
    event.struct_size = sizeof event;
    event.kind = BRUME_EVENT_SMOKE;
    event.u.smoke = {position(0.1, 0.1, 3.5), position(0.1, 0.1, -3.5), 400, 64, 1152, 192};
    world.append(event);
    world.advance_to(200);
    const std::vector<brume_cloud> clouds = world.state().clouds();
    ASSERT_EQ(clouds.size(), 1u);
    // Before what stops it: layer 8 of the grid; else at the end of its path.
    EXPECT_EQ(clouds[0].source.z, role == BRUME_ROLE_GHOST ? 1 : 8) << int{role};
    Field field(level);
    field.update(world.state());
    const Bytes behind = field.densities({0, 0, 0}, {8, 8, 7});
    const bool any = std::ranges::any_of(behind, [](std::uint8_t density) { return density > 0; });
    EXPECT_EQ(any, role >= BRUME_ROLE_GRILLE) << int{role};
  }
}

// An edit is a wall, or nothing, also for those who receive states alone.
TEST_F(ApiRoles, EditsReplaceThem) {
  Panes panes;
  panes.add(-0.25f, BRUME_ROLE_GLASS);
  const Level level(context_, panes.params());
  World world(level);
  Field field(level);
  EXPECT_TRUE(sees(field, -3, 3));
  const auto edit = [&](std::uint32_t tick, std::uint32_t solid) {
    brume_event event{};
    event.struct_size = sizeof event;
    event.kind = BRUME_EVENT_EDIT;
    event.tick = tick;
    event.u.edit = {{0, 0, 7}, {8, 8, 8}, solid};
    world.append(event);
    world.advance_to(tick);
    const State sent(context_, world.state().save());
    EXPECT_EQ(sent.hash(), world.hash());
    field.update(sent);
  };
  edit(1, 1);
  EXPECT_FALSE(sees(field, -3, 3)) << "bricked up";
  edit(2, 0);
  EXPECT_TRUE(sees(field, -3, 3));
  edit(3, 1);
  EXPECT_FALSE(sees(field, -3, 3));
  World earlier(level);
  field.update(earlier.state());
  EXPECT_TRUE(sees(field, -3, 3)) << "as loaded";
}

TEST_F(ApiRoles, OfVoxels) {
  Bytes solid(8, 0), glass(8, 0), grille(8, 0);  // a grid of 4 x 4 x 4: two bytes a layer
  solid[2] = solid[6] = 0xff, glass[2] = 0x0f, glass[4] = 0xff, grille[4] = 0x33, grille[6] = 0xff;
  brume_voxels_params params = brume_voxels_defaults();
  params.layout = {{4, 4, 4}, 0.5f, {0, 0, 0}};
  params.bits = solid.data();
  params.byte_count = solid.size();
  params.glass_bits = glass.data();
  params.grille_bits = grille.data();
  const Level level(context_, params);
  const Bytes roles = level.roles({0, 0, 0}, {4, 4, 4});
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const auto bit = [&](const Bytes& bits) { return (bits[i / 8] >> (i % 8) & 1) != 0; };
    const int expected = bit(solid)    ? (bit(glass) ? BRUME_ROLE_GLASS : BRUME_ROLE_WALL)
                         : bit(grille) ? BRUME_ROLE_GRILLE
                                       : BRUME_ROLE_GHOST;
    EXPECT_EQ(int{roles[i]}, expected) << i;
  }
}

TEST_F(ApiRoles, StructsOfEarlierHeadersHaveWalls) {
  Panes panes;
  panes.add(-0.25f, BRUME_ROLE_GLASS);
  brume_triangles_params params = panes.params();
  params.struct_size = offsetof(brume_triangles_params, roles);
  const Level level(context_, params);
  EXPECT_EQ(level.roles({3, 3, 7}, {4, 4, 8}), Bytes{BRUME_ROLE_WALL});
  brume_voxels_params voxels = brume_voxels_defaults();
  const Bytes bits(8, 0xff);
  voxels.layout = {{4, 4, 4}, 0.5f, {0, 0, 0}};
  voxels.bits = voxels.glass_bits = bits.data();
  voxels.byte_count = bits.size();
  voxels.struct_size = offsetof(brume_voxels_params, glass_bits);
  EXPECT_EQ(Level(context_, voxels).roles({0, 0, 0}, {1, 1, 1}), Bytes{BRUME_ROLE_WALL});
}

TEST_F(ApiRoles, ANumberThatIsNoneIsRefused) {
  Panes panes;
  panes.add(0, BRUME_ROLE_WALL);
  panes.roles[1] = 4;
  const brume_triangles_params params = panes.params();
  brume_level* level = nullptr;
  EXPECT_EQ(brume_level_create_from_triangles(context_.get(), &params, &level), BRUME_ERROR_ARGUMENT);
  EXPECT_STREQ(brume_last_error(), "brume_level_create_from_triangles: role 1 is 4, expected a brume_role");
  EXPECT_EQ(level, nullptr);
}

}  // namespace
}  // namespace brume::api
