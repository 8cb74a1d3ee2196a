// Volumes whose voxels all differ, written as files, and what an atlas of them holds.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "grids/dense_grid.hpp"

namespace brume::engines {

inline constexpr glm::uvec3 kVolumeSize{5, 3, 4};  // 4 tiles in 2 rows; no side is as long as another

/// Grids "r", "g", "b", "a" of one box that lies around no axis. The voxels of a grid all differ, and those
/// of different grids at one place, too.
std::vector<grids::DenseGrid> volume_of_codes(std::size_t channels);
/// What volume_of_codes holds, in [1, 255]: value * 255.
std::uint32_t code_at(glm::uvec3 voxel, std::size_t channel);

/// The same places with halves below 0 and above 1.
std::vector<grids::DenseGrid> volume_of_halves(std::size_t channels);

/// Writes a .brv file.
void save_volume(const std::filesystem::path& path, const std::vector<grids::DenseGrid>& channels);

}  // namespace brume::engines
