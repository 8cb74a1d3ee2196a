#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "api/objects.hpp"
#include "sim/walk.hpp"
#include "voxel/voxelize.hpp"

namespace brume::api {

// The sizes of 0.1 and 0.2.
template <>
inline constexpr std::array kEarlierSizes<brume_voxels_params>{
    std::uint32_t{offsetof(brume_voxels_params, glass_bits)}};
template <>
inline constexpr std::array kEarlierSizes<brume_triangles_params>{
    std::uint32_t{offsetof(brume_triangles_params, roles)}};

namespace {

static_assert(static_cast<int>(Role::glass) == BRUME_ROLE_GLASS &&
              static_cast<int>(Role::grille) == BRUME_ROLE_GRILLE &&
              static_cast<int>(Role::ghost) == BRUME_ROLE_GHOST);

using voxel::BitGrid;
using voxel::GridLayout;

constexpr std::uint32_t kMaxMargin = 256;

GridLayout grid_layout_of(const brume_layout& layout) {
  return {to_ivec3(layout.size), layout.voxel_size, {layout.origin.x, layout.origin.y, layout.origin.z}};
}

/// Throws a CallFailure unless worlds accept the layout.
void check_layout(const GridLayout& layout) {
  unwrap(voxel::check_frame(layout));
  (void)sim::VoxelRuler(layout);
}

/// Eight bits of a bit string, from bit `first`; those at or after `end` are 0.
unsigned eight_bits(const std::uint8_t* bits, std::uint64_t first, std::uint64_t end) {
  unsigned pair = bits[first / 8];
  if (first / 8 + 1 <= (end - 1) / 8) pair |= unsigned{bits[first / 8 + 1]} << 8;
  const unsigned mask = end - first >= 8 ? 0xffu : (1u << (end - first)) - 1;
  return pair >> (first % 8) & mask;
}

/// Makes the voxels of a brick solid whose bits are set.
void copy_brick(const std::uint8_t* bits, glm::ivec3 at, BitGrid& grid) {
  const glm::ivec3 size = grid.size(), low = at * voxel::kBrickSize;
  const glm::ivec3 high = glm::min(low + voxel::kBrickSize, size);
  BitGrid::Brick brick{};
  std::uint64_t any = 0;
  for (int z = low.z; z < high.z; ++z)
    for (int y = low.y; y < high.y; ++y) {
      const auto row = static_cast<std::uint64_t>(size.x) *
                       (static_cast<std::uint64_t>(y) +
                        static_cast<std::uint64_t>(size.y) * static_cast<std::uint64_t>(z));
      const std::uint64_t eight =
          eight_bits(bits, row + static_cast<std::uint64_t>(low.x), row + static_cast<std::uint64_t>(high.x));
      brick[static_cast<std::size_t>(z - low.z)] |= eight << (8 * (y - low.y));
      any |= eight;
    }
  if (any != 0) grid.ensure_brick(at) = brick;
}

BitGrid grid_of(const std::uint8_t* bits, const GridLayout& layout) {
  BitGrid grid(layout);
  const glm::ivec3 bricks = (layout.size + voxel::kBrickSize - 1) / voxel::kBrickSize;
  for (int z = 0; z < bricks.z; ++z)
    for (int y = 0; y < bricks.y; ++y)
      for (int x = 0; x < bricks.x; ++x) copy_brick(bits, {x, y, z}, grid);
  return grid;
}

LevelData level_of(const brume_voxels_params& params) {
  const GridLayout layout = grid_layout_of(params.layout);
  check_layout(layout);
  const glm::u64vec3 size(layout.size);
  const std::uint64_t bytes = (size.x * size.y * size.z + 7) / 8;
  if (params.byte_count != bytes)
    refuse("`byte_count` is " + std::to_string(params.byte_count) + ", expected " + std::to_string(bytes));
  required(params.bits, "bits");
  BitGrid grid = grid_of(params.bits, layout);
  voxel::RoleGrids roles;
  if (params.glass_bits) roles.sight = voxel::without(grid, grid_of(params.glass_bits, layout));
  if (params.grille_bits) roles.bodies = voxel::united(grid, grid_of(params.grille_bits, layout));
  return {std::move(grid), {}, std::move(roles)};
}

/// The role of a triangle in params.roles. Throws a CallFailure for a number that is no role.
Role role_of(const brume_triangles_params& params, std::size_t triangle) {
  const unsigned role = params.roles[triangle];
  if (role > BRUME_ROLE_GHOST)
    refuse("role " + std::to_string(triangle) + " is " + std::to_string(role) + ", expected a brume_role");
  return static_cast<Role>(role);
}

std::vector<voxel::Triangle> triangles_of(const brume_triangles_params& params) {
  require(params.index_count % 3 == 0, "`index_count` must be a multiple of 3");
  require(params.index_count <= BRUME_MAX_QUERIES && params.point_count <= BRUME_MAX_QUERIES,
          "at most 2^28 points and indices");
  if (params.index_count > 0) required(params.indices, "indices");
  if (params.point_count > 0) required(params.points, "points");
  const auto point = [&](std::size_t i) {
    const std::uint32_t number = params.indices[i];
    if (number >= params.point_count)
      refuse("index " + std::to_string(i) + " is " + std::to_string(number) + ", but there are " +
             std::to_string(params.point_count) + " points");
    const brume_point& p = params.points[number];
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
      refuse("point " + std::to_string(number) + " is not finite");
    return glm::vec3(p.x, p.y, p.z);
  };
  std::vector<voxel::Triangle> triangles(params.index_count / 3);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    triangles[i] = {point(3 * i), point(3 * i + 1), point(3 * i + 2)};
  return triangles;
}

LevelData level_of(const brume_triangles_params& params) {
  require(params.margin <= kMaxMargin, "`margin` must be at most 256 voxels");
  const std::vector<voxel::Triangle> triangles = triangles_of(params);
  GridLayout layout = grid_layout_of(params.layout);
  if (layout.size == glm::ivec3(0)) {
    require(!triangles.empty(), "a level without size must have triangles");
    glm::vec3 low = triangles.front().a, high = low;
    for (const voxel::Triangle& t : triangles)
      for (const glm::vec3& corner : {t.a, t.b, t.c}) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
      }
    layout = unwrap(voxel::layout_around(low, high, layout.voxel_size, static_cast<int>(params.margin)));
  }
  check_layout(layout);
  voxel::TrianglesByRole by_role;
  if (params.roles)
    for (std::size_t i = 0; i < triangles.size(); ++i)
      by_role.add(role_of(params, i), std::span(triangles).subspan(i, 1));
  const std::vector<voxel::Triangle>& solid = params.roles ? by_role.smoke : triangles;
  BitGrid grid = unwrap(voxel::voxelize(solid, layout));
  voxel::SurfacePlanes planes = voxel::SurfacePlanes::build(solid, grid);
  voxel::RoleGrids roles = unwrap(voxel::voxelize_roles(by_role, grid));
  return {std::move(grid), std::move(planes), std::move(roles)};
}

void read_solid(const BitGrid& grid, glm::ivec3 low, glm::ivec3 high, std::uint8_t* solid) {
  for (int z = low.z; z < high.z; ++z)
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) *solid++ = grid.solid({x, y, z}) ? 1 : 0;
}

void read_roles(const voxel::Solids& solids, glm::ivec3 low, glm::ivec3 high, std::uint8_t* roles) {
  for (int z = low.z; z < high.z; ++z)
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) *roles++ = static_cast<std::uint8_t>(solids.role({x, y, z}));
}

template <typename Params>
brume_result create_level(const char* function, brume_context* context, const Params* params,
                          brume_level** level) noexcept {
  return Call(function).run([&](Call& call) {
    const brume_context& owner = call.handle(context);
    required(level, "level");
    create(level, owner.settings, level_of(required_params(params)));
  });
}

}  // namespace

glm::ivec3 to_ivec3(const brume_voxel& v) {
  return {v.x, v.y, v.z};
}

bool is_in_world(const brume_point& p) {
  constexpr float kMostMetres = 16384;
  const auto within = [](float c) { return std::abs(c) <= kMostMetres; };  // false for NaN
  return within(p.x) && within(p.y) && within(p.z);
}

std::size_t checked_box(const GridLayout& layout, const brume_voxel& low, const brume_voxel& high,
                        std::size_t count) {
  const glm::ivec3 from = to_ivec3(low), to = to_ivec3(high);
  require(glm::all(glm::greaterThanEqual(from, glm::ivec3(0))) && glm::all(glm::lessThan(from, to)) &&
              glm::all(glm::lessThanEqual(to, layout.size)),
          "the box must lie in the level and have a voxel");
  const glm::u64vec3 size(to - from);
  const std::uint64_t voxels = size.x * size.y * size.z;
  if (count != voxels)
    refuse("`count` is " + std::to_string(count) + ", but the box has " + std::to_string(voxels) + " voxels");
  return count;
}

}  // namespace brume::api

using namespace brume::api;

extern "C" {

brume_result brume_level_create_from_voxels(brume_context* context, const brume_voxels_params* params,
                                            brume_level** level) BRUME_NOEXCEPT {
  return create_level(__func__, context, params, level);
}

brume_result brume_level_create_from_triangles(brume_context* context, const brume_triangles_params* params,
                                               brume_level** level) BRUME_NOEXCEPT {
  return create_level(__func__, context, params, level);
}

brume_result brume_level_destroy(brume_level* level) BRUME_NOEXCEPT {
  return destroy(__func__, level);
}

brume_result brume_level_layout(const brume_level* level, brume_layout* layout) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const GridLayout& from = call.handle(level).data->grid.layout();
    required(layout, "layout") = {{from.size.x, from.size.y, from.size.z},
                                  from.voxel_size,
                                  {from.origin_world.x, from.origin_world.y, from.origin_world.z}};
  });
}

brume_result brume_level_hash(const brume_level* level, uint64_t* hash) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_level& object = call.handle(level);
    required(hash, "hash") = object.data->hash;
  });
}

brume_result brume_level_solid(const brume_level* level, brume_voxel low, brume_voxel high, uint8_t* solid,
                               size_t count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const BitGrid& grid = call.handle(level).data->grid;
    checked_box(grid.layout(), low, high, count);
    read_solid(grid, to_ivec3(low), to_ivec3(high), &required(solid, "solid"));
  });
}

brume_result brume_level_roles(const brume_level* level, brume_voxel low, brume_voxel high, uint8_t* roles,
                               size_t count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const LevelData& data = *call.handle(level).data;
    checked_box(data.grid.layout(), low, high, count);
    read_roles(data.solids(), to_ivec3(low), to_ivec3(high), &required(roles, "roles"));
  });
}

}  // extern "C"
