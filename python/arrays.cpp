#include "python/arrays.hpp"

#include <algorithm>
#include <cmath>

namespace brume::python {
namespace {

[[noreturn]] void refuse_type(const char* argument, const std::string& what) {
  throw py::type_error(std::string(argument) + ": " + what);
}

/// Finite numbers of the shape (3,).
Doubles three_of(const char* argument, const py::object& value) {
  const py::array array = numbers_of(argument, value);
  if (array.ndim() != 1 || array.shape(0) != 3)
    refuse(argument, "expected three numbers, got the shape " + shape_text(array));
  auto numbers = Doubles::ensure(array);
  if (!numbers) throw py::error_already_set();
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(numbers.at(i))) refuse(argument, "is not finite");
  return numbers;
}

}  // namespace

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  return text + (array.ndim() == 1 ? ",)" : ")");
}

py::array numbers_of(const char* argument, const py::object& value) {
  const py::array array = py::array::ensure(value);
  if (!array) refuse_type(argument, "expected an array of numbers");
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u')
    refuse_type(argument,
                "expected an array of numbers, got the dtype " + py::str(array.dtype()).cast<std::string>());
  return array;
}

Points points_of(const char* argument, const py::object& value) {
  const py::array array = numbers_of(argument, value);
  if (array.ndim() == 0 || array.shape(array.ndim() - 1) != 3)
    refuse(argument, "expected the shape (..., 3), got " + shape_text(array));
  auto points = Floats::ensure(array);
  if (!points) throw py::error_already_set();
  const auto count = static_cast<std::size_t>(points.size()) / 3;
  return {std::move(points), count};
}

Lines lines_of(const py::object& a, const char* a_name, const py::object& b, const char* b_name) {
  Lines lines{points_of(a_name, a), points_of(b_name, b), 0, {}};
  const py::array& shaped = lines.a.is_single() ? lines.b.array : lines.a.array;
  const auto same = [&] {
    const py::array &p = lines.a.array, &q = lines.b.array;
    return p.ndim() == q.ndim() && std::equal(p.shape(), p.shape() + p.ndim(), q.shape());
  };
  if (!lines.a.is_single() && !lines.b.is_single() && !same())
    refuse(b_name, "expected the shape of " + std::string(a_name) + ", " + shape_text(lines.a.array) +
                       ", or (3,), got " + shape_text(lines.b.array));
  lines.shape.assign(shaped.shape(), shaped.shape() + shaped.ndim() - 1);
  lines.count = static_cast<std::size_t>(shaped.size()) / 3;
  return lines;
}

glm::dvec3 vector_of(const char* argument, const py::object& value) {
  const Doubles numbers = three_of(argument, value);
  return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

glm::ivec3 whole_of(const char* argument, const py::object& value) {
  const Doubles numbers = three_of(argument, value);
  glm::ivec3 result;
  for (int i = 0; i < 3; ++i) {
    const double number = numbers.at(i);
    if (number != std::floor(number) || std::abs(number) > 1e9)
      refuse(argument, "expected three whole numbers");
    result[i] = static_cast<int>(number);
  }
  return result;
}

py::tuple tuple_of(glm::vec3 v) {
  return py::make_tuple(v.x, v.y, v.z);
}
py::tuple tuple_of(glm::ivec3 v) {
  return py::make_tuple(v.x, v.y, v.z);
}

Box<int> voxel_box(const voxel::GridLayout& layout, const py::object& low, const py::object& high) {
  const Box<int> box{low.is_none() ? glm::ivec3(0) : whole_of("low", low),
                     high.is_none() ? layout.size : whole_of("high", high)};
  if (box.empty()) refuse("low, high", "the box of voxels is empty");
  if (!Box<int>{glm::ivec3(0), layout.size}.contains(box))
    refuse("low, high", "the box of voxels reaches out of the grid of " + std::to_string(layout.size.x) +
                            " x " + std::to_string(layout.size.y) + " x " + std::to_string(layout.size.z));
  const glm::u64vec3 size(box.high - box.low);
  if (size.x * size.y * size.z > kMaxArrayVoxels)
    throw Error(ErrorCode::resource_limit,
                "low, high: the box has more than 2^30 voxels; take a smaller one");
  return box;
}

namespace {

/// Writes a value for each solid voxel into an array (x, y, z).
template <typename Value>
void write_solid(const voxel::BitGrid& grid, Value value, Value* out) {
  const glm::ivec3 size = grid.size();
  grid.for_each_brick([&](glm::ivec3 brick, const voxel::BitGrid::Brick& words) {
    for (int z = 0; z < 8; ++z)
      for (int bit = 0; bit < 64; ++bit) {
        const glm::ivec3 v = brick * 8 + glm::ivec3(bit & 7, bit >> 3, z);
        if ((words[static_cast<std::size_t>(z)] >> bit & 1) != 0 && grid.contains(v))
          out[(std::size_t(v.x) * std::size_t(size.y) + std::size_t(v.y)) * std::size_t(size.z) +
              std::size_t(v.z)] = value;
      }
  });
}

}  // namespace

py::array_t<bool> solid_array(const voxel::BitGrid& grid) {
  const glm::ivec3 size = voxel_box(grid.layout(), py::none(), py::none()).high;
  py::array_t<bool> result({size.x, size.y, size.z});
  bool* const out = result.mutable_data();
  released([&] {
    std::fill_n(out, result.size(), false);
    write_solid(grid, true, out);
  });
  return result;
}

py::array_t<std::uint8_t> role_array(const voxel::Solids& solids) {
  const glm::ivec3 size = voxel_box(solids.smoke.layout(), py::none(), py::none()).high;
  py::array_t<std::uint8_t> result({size.x, size.y, size.z});
  std::uint8_t* const out = result.mutable_data();
  released([&] {
    const auto number = [](Role role) { return static_cast<std::uint8_t>(role); };
    std::fill_n(out, result.size(), number(Role::ghost));
    // Each is within the one before.
    write_solid(solids.bodies, number(Role::grille), out);
    write_solid(solids.smoke, number(Role::glass), out);
    write_solid(solids.sight, number(Role::wall), out);
  });
  return result;
}

}  // namespace brume::python
