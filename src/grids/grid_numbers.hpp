// The values of a grid as the numbers that are rendered: at the file's resolution without a copy, or halved.
// brick_volume.hpp makes bricks of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/box.hpp"
#include "grids/grid.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::grids {

/// How values below 0 are stored: less `offset`, so that all are above 0; those below `least` count as it.
/// offset < least. Where a grid has no voxels, it has its background.
struct ValueShift {
  float least = 0, offset = 0;
};

using BrickNumbers = std::array<float, kBrickVoxels>;

/// Reads values of a grid as numbers >= 0: the length of vectors; of a level set a fog (brick_volume.hpp).
/// What is infinite, beyond kLargest, or far beyond nearly all others, is the largest other number.
class NumberReader {
 public:
  explicit NumberReader(const Grid& grid, const std::optional<ValueShift>& shift = {});
  float at(const std::byte* values, std::size_t index) const {
    if (!is_plain_) return converted(values + index * bytes_);
    float value = 0;
    std::memcpy(&value, values + index * sizeof value, sizeof value);
    return value > 0 ? std::min(value, most_) : 0.0f;
  }
  /// Voxels and tiles whose value is NaN, infinite, beyond kLargest or far beyond the others.
  std::uint64_t odd() const { return odd_; }

  static constexpr float kLargest = 1e30f;

 private:
  void find_most(const Grid& grid);
  float converted(const std::byte* at) const;
  double number(const std::byte* at) const;

  ValueType type_;
  std::size_t bytes_;
  bool level_set_;
  bool is_plain_;  // float32, as they are: most grids
  double ramp_ = 1;
  float most_ = kLargest;
  std::uint64_t odd_ = 0;
  std::optional<ValueShift> shift_;
};

/// Bricks and cubes of numbers, without any of zeros.
class GridNumbers {
 public:
  /// The numbers of a grid, which must outlive it. With a shift, also bricks of the background between them,
  /// as far as they are few.
  explicit GridNumbers(const Grid& grid, const std::optional<ValueShift>& shift = {});

  /// The stored halves of a volume of one channel, which must outlive it; with `only_presence` 1 throughout
  /// each of its bricks.
  GridNumbers(const volume::SparseVolume& volume, bool only_presence);

  /// The number of the voxels beyond bricks and tiles; the grid must be the constructor's.
  float background(const Grid& grid) const { return reader_.at(grid.background.data(), 0); }

  /// NumberReader::odd of the grid.
  std::uint64_t odd() const { return reader_.odd(); }

  /// Means over 2^3 voxels; with `by_power` of fourth powers, whose fourth root is taken. Adds the squares of
  /// what they lose to `square_error`.
  GridNumbers halved(bool by_power, double& square_error) const;

  /// Moves all bricks by a number of them.
  void move(const glm::ivec3& bricks);

  /// Number of bricks, all cubes divided into bricks.
  std::uint64_t brick_count() const;
  /// Around all of them [bricks]; empty without any.
  Box<int> brick_box() const;
  /// The median along each axis of its bricks and of the middles of its cubes; 0 without any.
  glm::ivec3 middle_brick() const;
  /// Cubes become bricks, in their order behind the others. brick_count() of them must fit the memory.
  void expand_cubes();

  // Functions of bricks, after expand_cubes.
  std::size_t size() const { return at_.size(); }
  /// Its coordinate: origin / 8.
  glm::ivec3 brick(std::size_t i) const { return at_[i]; }
  /// Whether all its numbers are equal.
  bool is_uniform(std::size_t i) const;
  float at(std::size_t i, std::size_t voxel) const {
    const Source& source = sources_[i];
    if (source.values) return reader_.at(source.values, voxel);
    if (source.halves) return half_at(source.halves, voxel);
    return source.numbers ? (*source.numbers)[voxel] : source.constant;
  }

 private:
  /// Where the numbers of a brick are: in the grid, in a volume's texels, in `owned_`, or one for all voxels.
  struct Source {
    const std::byte* values = nullptr;
    const std::uint16_t* halves = nullptr;
    const BrickNumbers* numbers = nullptr;
    float constant = 0;
  };
  /// A cube of one number, of an edge of 16 or more.
  struct Cube {
    glm::ivec3 origin{0};  // [bricks]
    int edge = 0;          // [bricks]
    float number = 0;
  };

  explicit GridNumbers(const NumberReader& reader) : reader_(reader) {}
  static float half_at(const std::uint16_t* texels, std::size_t voxel);
  void add_cube(const Cube& cube);
  void add_background(const Grid& grid);

  NumberReader reader_;
  std::vector<glm::ivec3> at_;
  std::vector<Source> sources_;
  std::vector<std::unique_ptr<BrickNumbers>> owned_;
  std::vector<Cube> cubes_;
};

}  // namespace brume::grids
