// NumPy arrays and numbers as the library takes them. What does not fit raises TypeError (the kind of value)
// or ValueError (its shape or size).
#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/box.hpp"
#include "python/calls.hpp"
#include "voxel/solids.hpp"

namespace brume::python {

/// Most voxels of an array that a function returns: 4 GiB of float32.
constexpr std::uint64_t kMaxArrayVoxels = 1ull << 30;

constexpr int kAligned = 0x0100;  ///< NPY_ARRAY_ALIGNED

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast | kAligned>;
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast | kAligned>;

/// An array, or a list that makes one, of real numbers. It is not copied.
py::array numbers_of(const char* argument, const py::object& value);

/// Points (..., 3) as float32: not copied where they are that, aligned and in order.
struct Points {
  Floats array;
  std::size_t count = 0;
  bool is_single() const { return array.ndim() == 1; }  ///< One point: the shape (3,).
  const float* data() const { return array.data(); }
};
Points points_of(const char* argument, const py::object& value);

/// Two ends of lines: equally many, or one end that all lines have in common.
struct Lines {
  Points a, b;
  std::size_t count = 0;
  std::vector<py::ssize_t> shape;  ///< Shape of the result: (...).
  bool is_single() const { return shape.empty(); }
};
Lines lines_of(const py::object& a, const char* a_name, const py::object& b, const char* b_name);

/// Three finite numbers.
glm::dvec3 vector_of(const char* argument, const py::object& value);
/// Three whole numbers that fit 32 bits.
glm::ivec3 whole_of(const char* argument, const py::object& value);

py::tuple tuple_of(glm::vec3 v);
py::tuple tuple_of(glm::ivec3 v);

/// "(2, 3)"
std::string shape_text(const py::array& array);

/// The box [low, high) of voxels, None: that of the whole grid. Not empty, inside of the grid, and at most
/// kMaxArrayVoxels.
Box<int> voxel_box(const voxel::GridLayout& layout, const py::object& low, const py::object& high);

/// Which voxels are solid, as bool (x, y, z).
py::array_t<bool> solid_array(const voxel::BitGrid& grid);
/// The role of each voxel, as uint8 (x, y, z): the number of the Role.
py::array_t<std::uint8_t> role_array(const voxel::Solids& solids);

}  // namespace brume::python
