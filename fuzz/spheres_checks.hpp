// What the reader of .spheres files guarantees for arbitrary bytes: used by the fuzzer and by the tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/hash.hpp"
#include "spheres/file.hpp"

namespace brume::spheres {

/// Reads a file; whether it is accepted. What is refused has one line of a reason, what is accepted is a tank
/// within its limits that is written as the same bytes.
inline bool check_tank_bytes(std::span<const std::byte> bytes) {
  const auto tank = parse_tank(bytes, "input");
  if (!tank) {
    const Failure& failure = tank.failure();
    BRUME_ASSERT(failure.code == ErrorCode::bad_input || failure.code == ErrorCode::resource_limit,
                 failure.message);
    BRUME_ASSERT(failure.message.starts_with("input: ") && failure.message.find('\n') == std::string::npos,
                 failure.message);
    return false;
  }
  const glm::dvec3 size(tank->size);
  BRUME_ASSERT(size.x * size.y * size.z <= double{kMostVoxels} && size.x * size.y * size.z >= 1, "size");
  BRUME_ASSERT(tank->voxel > 0 && std::isfinite(tank->voxel), "voxel");
  BRUME_ASSERT(tank->spheres.size() == tank->colors.size() && tank->spheres.size() <= kMostSpheres, "count");
  for (const Sphere& sphere : tank->spheres) {
    const glm::dvec3 at(sphere.center);
    const auto radius = double{sphere.radius};
    BRUME_ASSERT(radius > 0 && std::min({at.x, at.y, at.z}) >= radius, "low sides");
    BRUME_ASSERT(at.x <= size.x - radius && at.y <= size.y - radius && at.z <= size.z - radius, "high sides");
  }
  const std::vector<std::byte> again = tank_bytes(*tank);
  BRUME_ASSERT(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()), "bytes change");
  return true;
}

/// An input of the fuzzer: as it is, and with magic, version, count and checksum that fit its length: without
/// them, nothing beyond would be reached. Whether one is accepted.
inline bool check_tank_input(std::span<const std::byte> bytes) {
  constexpr std::size_t kHeader = 32, kSphere = 20, kChecksum = 8;
  const bool accepted = check_tank_bytes(bytes);
  if (bytes.size() < kHeader + kChecksum) return accepted;
  std::vector<std::byte> forged(bytes.begin(), bytes.end());
  const auto count = static_cast<std::uint32_t>((bytes.size() - kHeader - kChecksum) / kSphere);
  forged.resize(kHeader + count * kSphere + kChecksum);
  const std::uint32_t version = 1;
  std::memcpy(forged.data(), "BRUMESPH", 8);
  std::memcpy(forged.data() + 8, &version, sizeof version);
  std::memcpy(forged.data() + 12, &count, sizeof count);
  const std::uint64_t checksum = hash_bytes(std::span(forged).first(forged.size() - kChecksum));
  std::memcpy(forged.data() + forged.size() - kChecksum, &checksum, sizeof checksum);
  return check_tank_bytes(forged) || accepted;
}

}  // namespace brume::spheres
