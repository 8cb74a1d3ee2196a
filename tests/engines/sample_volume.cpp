#include "tests/engines/sample_volume.hpp"

#include "grids/files/grid_files.hpp"

namespace brume::engines {
namespace {

constexpr const char* kNames[] = {"r", "g", "b", "a"};

template <typename Value>
std::vector<grids::DenseGrid> volume_of(std::size_t channels, const Value& value_at) {
  std::vector<grids::DenseGrid> grids;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    grids::DenseGrid grid{kNames[channel], kVolumeSize, {glm::dvec3(-1, 2, 5), glm::dvec3(1.5, 3.5, 7)}, {}};
    for (glm::uvec3 at(0); at.z < kVolumeSize.z; ++at.z)
      for (at.y = 0; at.y < kVolumeSize.y; ++at.y)
        for (at.x = 0; at.x < kVolumeSize.x; ++at.x) grid.values.push_back(value_at(at, channel));
    grids.push_back(grid);
  }
  return grids;
}

std::uint32_t number_of(glm::uvec3 voxel) {
  return voxel.x + kVolumeSize.x * (voxel.y + kVolumeSize.y * voxel.z);
}

}  // namespace

std::uint32_t code_at(glm::uvec3 voxel, std::size_t channel) {
  return 1 + (4 * number_of(voxel) + static_cast<std::uint32_t>(channel)) % 255;
}

std::vector<grids::DenseGrid> volume_of_codes(std::size_t channels) {
  return volume_of(channels, [](glm::uvec3 at, std::size_t channel) {
    return static_cast<float>(code_at(at, channel) / 255.0);
  });
}

// Multiples of 1/16 from -3.75 on.
std::vector<grids::DenseGrid> volume_of_halves(std::size_t channels) {
  return volume_of(channels, [](glm::uvec3 at, std::size_t channel) {
    return 0.125f * static_cast<float>(number_of(at)) + 0.0625f * static_cast<float>(channel) - 3.71875f;
  });
}

void save_volume(const std::filesystem::path& path, const std::vector<grids::DenseGrid>& channels) {
  grids::GridFile file;
  for (const grids::DenseGrid& channel : channels) file.grids.push_back(grids::to_grid(channel));
  grids::save_grid_file(path, file).value_or_throw();
}

}  // namespace brume::engines
