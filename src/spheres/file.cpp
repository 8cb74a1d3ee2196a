#include "spheres/file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "core/file.hpp"
#include "core/hash.hpp"

namespace brume::spheres {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is the layout in memory");

constexpr std::array<char, 8> kMagic = {'B', 'R', 'U', 'M', 'E', 'S', 'P', 'H'};
constexpr std::uint32_t kVersion = 1;

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t count = 0;
  std::array<std::uint32_t, 3> size{};
  float voxel = 0;
};
static_assert(sizeof(Header) == 32);

constexpr std::uint64_t kSphereBytes = sizeof(Sphere) + sizeof(Color), kChecksumBytes = 8;

Failure refuse_tank(const std::string& name, const std::string& why, ErrorCode code = ErrorCode::bad_input) {
  return {code, name + ": " + why};
}

}  // namespace

bool is_tank_file(const std::filesystem::path& path) {
  std::string suffix = path.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return suffix == ".spheres";
}

Result<Tank> parse_tank(std::span<const std::byte> bytes, const std::string& name) {
  // Signature, version and limits.
  Header header;
  if (bytes.size() < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
    return refuse_tank(name, "not a .spheres file");
  if (bytes.size() < sizeof header + kChecksumBytes) return refuse_tank(name, "the file is truncated");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.version != kVersion)
    return refuse_tank(name, "a .spheres file of version " + std::to_string(header.version) + ", not " +
                                 std::to_string(kVersion));
  const glm::uvec3 size(header.size[0], header.size[1], header.size[2]);
  if (const auto fits = check_tank_size(size, header.count); !fits)
    return refuse_tank(name, fits.failure().message, fits.failure().code);

  // Length and checksum.
  const std::uint64_t length = sizeof header + header.count * kSphereBytes + kChecksumBytes;
  if (bytes.size() != length)
    return refuse_tank(name, "the file is " + std::string(bytes.size() < length ? "truncated" : "too long") +
                                 ": " + std::to_string(bytes.size()) + " bytes of " + std::to_string(length));
  const auto contents = bytes.first(bytes.size() - kChecksumBytes);
  std::uint64_t checksum = 0;
  std::memcpy(&checksum, bytes.data() + contents.size(), kChecksumBytes);
  if (hash_bytes(contents) != checksum)
    return refuse_tank(name, "the file is damaged: its checksum is wrong");

  // The tank and its spheres.
  Tank tank{size, header.voxel, {}, {}};
  tank.spheres.resize(header.count);
  tank.colors.resize(header.count);
  if (header.count > 0) {
    std::memcpy(tank.spheres.data(), bytes.data() + sizeof header, header.count * sizeof(Sphere));
    std::memcpy(tank.colors.data(), bytes.data() + sizeof header + header.count * sizeof(Sphere),
                header.count * sizeof(Color));
  }
  if (const auto valid = check_tank(tank); !valid)
    return refuse_tank(name, "the file is damaged: " + valid.failure().message);
  return tank;
}

Result<Tank> load_tank(const std::filesystem::path& path) {
  constexpr std::uint64_t kLongest = sizeof(Header) + kMostSpheres * kSphereBytes + kChecksumBytes;
  const auto bytes = read_file(path, kLongest);
  if (!bytes) return bytes.failure();
  return parse_tank(*bytes, path.string());
}

std::vector<std::byte> tank_bytes(const Tank& tank) {
  BRUME_ASSERT(tank.spheres.size() == tank.colors.size() && tank.spheres.size() <= kMostSpheres,
               std::to_string(tank.spheres.size()));
  Header header;
  header.count = static_cast<std::uint32_t>(tank.spheres.size());
  header.size = {tank.size.x, tank.size.y, tank.size.z};
  header.voxel = tank.voxel;
  std::vector<std::byte> bytes;
  bytes.reserve(sizeof header + header.count * kSphereBytes + kChecksumBytes);
  const auto append = [&](std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
  append(std::as_bytes(std::span(&header, 1)));
  append(std::as_bytes(std::span(tank.spheres)));
  append(std::as_bytes(std::span(tank.colors)));
  const std::uint64_t checksum = hash_bytes(bytes);
  append(std::as_bytes(std::span(&checksum, 1)));
  return bytes;
}

Result<void> save_tank(const std::filesystem::path& path, const Tank& tank) {
  return write_file_atomic(path, tank_bytes(tank));
}

}  // namespace brume::spheres
