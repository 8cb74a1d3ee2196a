#include "vxl/file.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

#include "core/checked.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"
#include "voxel/voxelize.hpp"

namespace brume::vxl {
namespace {

using voxel::BitGrid;
using voxel::GridLayout;
using voxel::kBrickSize;
using voxel::kMaxPlanes;
using voxel::Plane;
using voxel::RoleGrids;
using voxel::Solids;
using voxel::SurfacePlanes;

using glm::ivec3;

static_assert(std::endian::native == std::endian::little, "the format is the layout in memory");

constexpr std::array<char, 8> kMagic = {'B', 'R', 'U', 'M', 'E', 'V', 'X', 'L'};
constexpr int kCompressionLevel = 3;
constexpr std::uint64_t kMaxPayload = std::uint64_t{8} << 30;
// zstd's densest block expands 4 bytes to 128 KiB: the maximum growth of a payload.
constexpr std::uint64_t kMaxGrowth = 32768;

struct Header {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t bricks;
  std::uint64_t key;
  std::uint64_t triangles;
  ivec3 size;
  float voxel_size;
  glm::vec3 origin_world;
  std::uint32_t cells;
  std::uint64_t planes;
  std::uint64_t compressed_bytes;
};
static_assert(sizeof(Header) == 80 && std::is_trivially_copyable_v<Header>);

/// Follows the header from version 2 on: bricks with glass, and with grilles.
struct RoleCounts {
  std::uint32_t glass = 0, grilles = 0;
};
static_assert(sizeof(RoleCounts) == 8);

/// The bytes before the payload.
std::size_t head_bytes(std::uint32_t version) {
  return sizeof(Header) + (version == kRolesVersion ? sizeof(RoleCounts) : 0);
}
static_assert(sizeof(Plane) == 16 && sizeof(BitGrid::Brick) == 64);

constexpr std::uint64_t kBrickBytes = sizeof(std::uint32_t) + sizeof(BitGrid::Brick);
constexpr std::uint64_t kCellBytes = sizeof(std::uint64_t) + 1;
constexpr std::size_t kChecksumBytes = sizeof(std::uint64_t);

Failure damaged(const std::string& what) {
  return {ErrorCode::bad_input, what};
}

template <typename T>
void append(std::vector<std::byte>& bytes, std::span<const T> values) {
  const auto raw = std::as_bytes(values);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

// Removes values from the front. The caller has checked the size.
template <typename T>
void take(std::span<const std::byte>& bytes, std::span<T> values) {
  BRUME_ASSERT(bytes.size() >= values.size_bytes(), std::to_string(bytes.size()));
  if (values.empty()) return;
  std::memcpy(values.data(), bytes.data(), values.size_bytes());
  bytes = bytes.subspan(values.size_bytes());
}

ivec3 brick_count(ivec3 size) {
  return (size + (kBrickSize - 1)) / kBrickSize;
}

struct NumberedBrick {
  std::uint32_t number;  // x + nx (y + ny z)
  const BitGrid::Brick* brick;
};

std::vector<NumberedBrick> numbered_bricks(const BitGrid& grid) {
  const ivec3 n = brick_count(grid.size());
  std::vector<NumberedBrick> bricks;
  grid.for_each_brick([&](ivec3 at, const BitGrid::Brick& brick) {
    if (brick != BitGrid::Brick{})
      bricks.push_back({static_cast<std::uint32_t>(at.x + n.x * (at.y + n.y * at.z)), &brick});
  });
  std::sort(bricks.begin(), bricks.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  return bricks;
}

void append_bricks(std::vector<std::byte>& payload, const std::vector<NumberedBrick>& bricks) {
  for (const NumberedBrick& b : bricks) append(payload, std::span(&b.number, 1));
  for (const NumberedBrick& b : bricks) append(payload, std::span<const std::uint64_t>(*b.brick));
}

std::vector<std::byte> encode_payload(const std::vector<NumberedBrick>& bricks, const SurfacePlanes& planes) {
  std::vector<std::byte> payload;
  payload.reserve(bricks.size() * kBrickBytes + planes.cell_count() * kCellBytes +
                  planes.plane_count() * sizeof(Plane));
  append_bricks(payload, bricks);
  std::uint64_t last = 0;
  for (const std::uint64_t key : planes.keys()) {
    const std::uint64_t difference = key - last;
    append(payload, std::span(&difference, 1));
    last = key;
  }
  for (std::size_t i = 0; i < planes.cell_count(); ++i)
    payload.push_back(static_cast<std::byte>(planes.count(i)));
  append(payload, planes.planes());
  return payload;
}

// The bits of a brick inside the grid.
BitGrid::Brick bits_in_grid(ivec3 size, ivec3 brick) {
  BitGrid::Brick mask{};
  const ivec3 inside = glm::min(size - brick * kBrickSize, ivec3(kBrickSize));
  const std::uint64_t row = (std::uint64_t{1} << inside.x) - 1;
  for (int z = 0; z < inside.z; ++z)
    for (int y = 0; y < inside.y; ++y) mask[static_cast<unsigned>(z)] |= row << (8 * y);
  return mask;
}

Result<void> decode_bricks(std::span<const std::byte>& payload, std::uint32_t count, BitGrid& grid) {
  const ivec3 n = brick_count(grid.size());
  std::vector<std::uint32_t> numbers(count);
  take(payload, std::span(numbers));
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto number = static_cast<std::int64_t>(numbers[i]);
    if (number >= std::int64_t{n.x} * n.y * n.z) return damaged("a brick lies outside of the grid");
    if (i > 0 && numbers[i] <= numbers[i - 1]) return damaged("the bricks are not in order");
    const auto at = static_cast<int>(number);
    const ivec3 brick(at % n.x, at / n.x % n.y, at / n.x / n.y);
    BitGrid::Brick bits;
    take(payload, std::span<std::uint64_t>(bits));
    const BitGrid::Brick inside = bits_in_grid(grid.size(), brick);
    for (unsigned z = 0; z < bits.size(); ++z)
      if (bits[z] & ~inside[z]) return damaged("a voxel lies outside of the grid");
    grid.ensure_brick(brick) = bits;
  }
  return {};
}

Result<SurfacePlanes> decode_planes(std::span<const std::byte>& payload, const Header& header) {
  std::vector<std::uint64_t> keys(header.cells);
  take(payload, std::span(keys));
  for (std::size_t i = 1; i < keys.size(); ++i) keys[i] += keys[i - 1];
  std::vector<std::uint8_t> counts(header.cells);
  take(payload, std::span(counts));
  std::vector<Plane> planes(header.planes);
  take(payload, std::span(planes));
  auto result = SurfacePlanes::from_parts(header.size, std::move(keys), counts, std::move(planes));
  if (!result) return damaged("the surface planes are inconsistent");
  return std::move(*result);
}

/// The grids of roles: the payload has the voxels of glass and of grilles.
Result<RoleGrids> decode_roles(std::span<const std::byte>& payload, const RoleCounts& counts,
                               const BitGrid& grid) {
  BitGrid glass(grid.layout()), grilles(grid.layout());
  if (auto decoded = decode_bricks(payload, counts.glass, glass); !decoded) return decoded.failure();
  if (auto decoded = decode_bricks(payload, counts.grilles, grilles); !decoded) return decoded.failure();
  if (without(glass, grid).count_solid() > 0) return damaged("glass lies in a free voxel");
  if (without(grilles, grid).count_solid() != grilles.count_solid())
    return damaged("a grille lies in a solid voxel");
  RoleGrids roles;
  if (counts.glass > 0) roles.sight = without(grid, glass);
  if (counts.grilles > 0) roles.bodies = united(grid, grilles);
  return roles;
}

// The expected length of the payload; nothing when the counts are impossible for the grid or the file.
std::optional<std::uint64_t> payload_bytes(const Header& header, const RoleCounts& roles) {
  const glm::u64vec3 size(header.size), n(brick_count(header.size));
  const std::uint64_t cells = (size.x + 1) * (size.y + 1) * (size.z + 1);  // At most 4097^3.
  for (const std::uint32_t bricks : {header.bricks, roles.glass, roles.grilles})
    if (bricks > n.x * n.y * n.z) return std::nullopt;
  if (header.cells > cells) return std::nullopt;
  if (header.planes > std::uint64_t{header.cells} * kMaxPlanes) return std::nullopt;
  const std::uint64_t bricks = std::uint64_t{header.bricks} + roles.glass + roles.grilles;
  const std::uint64_t bytes =
      bricks * kBrickBytes + header.cells * kCellBytes + header.planes * sizeof(Plane);
  if (bytes > kMaxPayload || bytes / kMaxGrowth > header.compressed_bytes) return std::nullopt;
  return bytes;
}

}  // namespace

std::vector<std::byte> encode(const Contents& contents, std::uint64_t key) {
  const GridLayout& layout = contents.grid.layout();
  const auto bricks = numbered_bricks(contents.grid);
  auto payload = encode_payload(bricks, contents.planes);
  // Panes and grilles are where grids of what stops sight or bodies differ from the grid of smoke.
  const Solids solids(contents.grid, contents.roles);
  const BitGrid glass = without(solids.smoke, solids.sight), grilles = without(solids.bodies, solids.smoke);
  const auto glass_bricks = numbered_bricks(glass), grille_bricks = numbered_bricks(grilles);
  append_bricks(payload, glass_bricks);
  append_bricks(payload, grille_bricks);
  const RoleCounts roles{static_cast<std::uint32_t>(glass_bricks.size()),
                         static_cast<std::uint32_t>(grille_bricks.size())};
  // Files without them keep the older version, which older programs read.
  const std::uint32_t version = roles.glass + roles.grilles > 0 ? kRolesVersion : kVersion;
  const std::size_t head = head_bytes(version);
  Header header{kMagic,
                version,
                static_cast<std::uint32_t>(bricks.size()),
                key,
                contents.triangles,
                layout.size,
                layout.voxel_size,
                layout.origin_world,
                static_cast<std::uint32_t>(contents.planes.cell_count()),
                contents.planes.plane_count(),
                0};
  // Compress behind the head, then fill it in.
  std::vector<std::byte> bytes(head + ZSTD_compressBound(payload.size()));
  const std::size_t compressed = ZSTD_compress(bytes.data() + head, bytes.size() - head, payload.data(),
                                               payload.size(), kCompressionLevel);
  if (ZSTD_isError(compressed))
    throw Error(ErrorCode::internal, std::string("zstd: ") + ZSTD_getErrorName(compressed));
  header.compressed_bytes = compressed;
  std::memcpy(bytes.data(), &header, sizeof header);
  if (head > sizeof header) std::memcpy(bytes.data() + sizeof header, &roles, sizeof roles);
  bytes.resize(head + compressed);
  // The checksum covers all before it.
  const std::uint64_t checksum = hash_bytes(bytes);
  append(bytes, std::span(&checksum, 1));
  return bytes;
}

Result<std::optional<Contents>> decode(std::span<const std::byte> bytes,
                                       std::optional<std::uint64_t> expected_key) {
  // Signature, version, length, checksum and key.
  Header header;
  if (bytes.size() < sizeof(Header) + kChecksumBytes) return damaged("not a voxel cache, or truncated");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != kMagic) return damaged("not a voxel cache");
  if (header.version != kVersion && header.version != kRolesVersion)
    return damaged("a voxel cache of version " + std::to_string(header.version) + ", not " +
                   std::to_string(kVersion) + " or " + std::to_string(kRolesVersion));
  const std::size_t head = head_bytes(header.version);
  if (bytes.size() < head + kChecksumBytes || header.compressed_bytes != bytes.size() - head - kChecksumBytes)
    return damaged("a voxel cache that is truncated or too long");
  RoleCounts role_counts;
  if (head > sizeof header) std::memcpy(&role_counts, bytes.data() + sizeof header, sizeof role_counts);
  std::uint64_t checksum = 0;
  std::memcpy(&checksum, bytes.data() + bytes.size() - kChecksumBytes, kChecksumBytes);
  if (checksum != hash_bytes(bytes.first(bytes.size() - kChecksumBytes)))
    return damaged("a damaged voxel cache: its checksum is wrong");
  if (expected_key && header.key != *expected_key) return std::optional<Contents>();

  // The payload, as long as grid and counts allow.
  const GridLayout layout{header.size, header.voxel_size, header.origin_world};
  if (!check_frame(layout)) return damaged("a voxel cache with an impossible grid");
  const auto length = payload_bytes(header, role_counts);
  if (!length) return damaged("a voxel cache with impossible counts");
  std::vector<std::byte> payload(*length);
  const std::size_t got =
      ZSTD_decompress(payload.data(), payload.size(), bytes.data() + head, header.compressed_bytes);
  if (ZSTD_isError(got) || got != payload.size()) return damaged("a voxel cache that does not unpack");

  // Bricks, planes and roles.
  Contents contents{BitGrid(layout), {}, header.triangles};
  std::span<const std::byte> rest(payload);
  if (auto decoded = decode_bricks(rest, header.bricks, contents.grid); !decoded) return decoded.failure();
  auto planes = decode_planes(rest, header);
  if (!planes) return planes.failure();
  contents.planes = std::move(*planes);
  auto roles = decode_roles(rest, role_counts, contents.grid);
  if (!roles) return roles.failure();
  contents.roles = std::move(*roles);
  return std::optional<Contents>(std::move(contents));
}

Result<std::optional<Contents>> load(const std::filesystem::path& path,
                                     std::optional<std::uint64_t> expected_key) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.failure();
  auto contents = decode(*bytes, expected_key);
  if (!contents) return Failure{contents.failure().code, path.string() + ": " + contents.failure().message};
  return contents;
}

Result<void> save(const std::filesystem::path& path, const Contents& contents, std::uint64_t key) {
  return write_file_atomic(path, encode(contents, key));
}

}  // namespace brume::vxl
