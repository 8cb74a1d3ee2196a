#include "python/grid_arrays.hpp"

#include <algorithm>
#include <cstring>

#include "python/bytes.hpp"

namespace brume::python {
namespace {

using grids::ValueType;

constexpr std::array kTypes{ValueType::float32, ValueType::float64, ValueType::int32,
                            ValueType::int64,   ValueType::boolean, ValueType::mask,
                            ValueType::vec3f,   ValueType::vec3d,   ValueType::vec3i};

/// The data type of one component.
const char* dtype_of(ValueType type) {
  switch (type) {
    case ValueType::float32:
    case ValueType::vec3f:
      return "float32";
    case ValueType::float64:
    case ValueType::vec3d:
      return "float64";
    case ValueType::int32:
    case ValueType::vec3i:
      return "int32";
    case ValueType::int64:
      return "int64";
    default:
      return "bool";
  }
}

bool is_vector(ValueType type) {
  return type == ValueType::vec3f || type == ValueType::vec3d || type == ValueType::vec3i;
}

bool is_background(const grids::Grid& grid, const std::byte* value) {
  return std::memcmp(value, grid.background.data(), grids::bytes_of(grid.type)) == 0;
}

/// Calls visit(voxel, is_active, value) for every stored voxel of a brick that is not background.
template <typename Visit>
void for_each_voxel(const grids::Grid& grid, std::size_t brick, const Visit& visit) {
  const std::size_t bytes = grids::bytes_of(grid.type);
  const std::byte* values = grid.values_of(brick).data();
  for (std::size_t i = 0; i < grids::kBrickVoxels; ++i) {
    const bool is_active = grid.bricks[brick].is_active(i);
    if (!is_active && is_background(grid, values + i * bytes)) continue;
    const glm::ivec3 local(static_cast<int>(i % 8), static_cast<int>(i / 8 % 8), static_cast<int>(i / 64));
    visit(grid.bricks[brick].origin + local, is_active, values + i * bytes);
  }
}

bool is_stored(const grids::Grid& grid, const grids::Tile& tile) {
  return tile.active || !is_background(grid, tile.value.data());
}

Box<int> bounds_of(const grids::Grid& grid) {
  Box<int> box{glm::ivec3(INT32_MAX), glm::ivec3(INT32_MIN)};
  const auto add = [&](glm::ivec3 low, glm::ivec3 high) { box = united(box, {low, high}); };
  for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
    const glm::ivec3 origin = grid.bricks[i].origin;
    if (box.contains({origin, origin + grids::kBrickEdge})) continue;
    for_each_voxel(grid, i, [&](glm::ivec3 v, bool, const std::byte*) { add(v, v + 1); });
  }
  for (const grids::Tile& tile : grid.tiles)
    if (is_stored(grid, tile)) add(tile.origin, tile.origin + static_cast<int>(tile.edge));
  return box.empty() ? Box<int>{} : box;
}

void check_size(const grids::Grid& grid, const Box<int>& box) {
  const glm::dvec3 size = glm::dvec3(box.high) - glm::dvec3(box.low);
  if (size.x * size.y * size.z > static_cast<double>(kMaxArrayVoxels))
    throw Error(ErrorCode::resource_limit,
                "grid \"" + grid.name + "\": an array of it has more than 2^30 voxels; use convert()");
}

/// Sums of coordinates and edges of tiles must fit.
void check_places(const grids::Grid& grid) {
  const auto check = [&](glm::ivec3 origin) {
    if (glm::any(glm::greaterThan(glm::abs(glm::dvec3(origin)), glm::dvec3(1 << 30))))
      throw Error(ErrorCode::resource_limit, "grid \"" + grid.name + "\": has voxels beyond index 2^30");
  };
  for (const grids::Brick& brick : grid.bricks) check(brick.origin);
  for (const grids::Tile& tile : grid.tiles) check(tile.origin);
}

/// The arrays of a grid.
struct Dense {
  Box<int> box;
  std::byte* values;
  bool* active;
  std::size_t bytes;  // size of a value

  std::size_t index(glm::ivec3 v) const {
    const glm::u64vec3 at(v - box.low), size(box.high - box.low);
    return (at.x * size.y + at.y) * size.z + at.z;
  }
  void set(glm::ivec3 v, bool is_active, const std::byte* value) const {
    const std::size_t i = index(v);
    std::memcpy(values + i * bytes, value, bytes);
    active[i] = is_active;
  }
};

void fill_arrays(const grids::Grid& grid, const Dense& dense) {
  const std::size_t count = dense.box.empty() ? 0 : dense.index(dense.box.high - 1) + 1;
  std::fill_n(dense.active, count, false);
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(dense.values + i * dense.bytes, grid.background.data(), dense.bytes);
  for (const grids::Tile& tile : grid.tiles)
    if (is_stored(grid, tile))
      for_each_in(Box<int>{tile.origin, tile.origin + static_cast<int>(tile.edge)},
                  [&](glm::ivec3 v) { dense.set(v, tile.active, tile.value.data()); });
  for (std::size_t i = 0; i < grid.bricks.size(); ++i)
    for_each_voxel(grid, i, [&](glm::ivec3 v, bool is_active, const std::byte* value) {
      dense.set(v, is_active, value);
    });
}

/// Bricks of an array, without those that are background.
void add_bricks(const Dense& dense, grids::Grid& grid) {
  const glm::ivec3 first = dense.box.low >> 3, end = (dense.box.high + 7) >> 3;
  std::array<std::byte, grids::kMaxValueBytes * grids::kBrickVoxels> values;
  const auto add = [&](glm::ivec3 origin) {
    grids::Brick brick{origin, {}};
    bool is_empty = true;
    for (std::size_t i = 0; i < grids::kBrickVoxels; ++i)
      std::memcpy(values.data() + i * dense.bytes, grid.background.data(), dense.bytes);
    for_each_in(intersection(dense.box, {origin, origin + grids::kBrickEdge}), [&](glm::ivec3 v) {
      const glm::ivec3 local = v - origin;
      const auto i = static_cast<std::size_t>(local.x + 8 * (local.y + 8 * local.z));
      const std::byte* value = dense.values + dense.index(v) * dense.bytes;
      const bool is_active = dense.active[dense.index(v)];
      if (is_active) brick.active[i / 64] |= std::uint64_t{1} << (i % 64);
      std::memcpy(values.data() + i * dense.bytes, value, dense.bytes);
      is_empty &= !is_active && is_background(grid, value);
    });
    if (is_empty) return;
    grid.bricks.push_back(brick);
    grid.values.insert(grid.values.end(), values.begin(),
                       values.begin() + static_cast<std::ptrdiff_t>(grids::kBrickVoxels * dense.bytes));
  };
  for (int z = first.z; z < end.z; ++z)
    for (int y = first.y; y < end.y; ++y)
      for (int x = first.x; x < end.x; ++x) add(glm::ivec3(x, y, z) * 8);
}

py::array matrix_array(const glm::dmat4& m) {
  py::array_t<double> result({4, 4});
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) result.mutable_at(row, column) = m[column][row];
  return result;
}

glm::dmat4 matrix_of(const py::object& value) {
  const auto numbers = Doubles::ensure(numbers_of("matrix", value));
  if (!numbers) throw py::error_already_set();
  if (numbers.ndim() != 2 || numbers.shape(0) != 4 || numbers.shape(1) != 4)
    refuse("matrix", "expected the shape (4, 4), got " + shape_text(numbers));
  glm::dmat4 m;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) m[column][row] = numbers.at(row, column);
  return m;
}

template <typename Enum, std::size_t N>
Enum named(const char* argument, const std::array<Enum, N>& all, const std::string& name) {
  for (const Enum one : all)
    if (name == grids::name_of(one)) return one;
  refuse(argument, "is not '" + name + "'");
}

/// The array of a grid's values or activity, converted by Python before.
py::array checked(const py::dict& dict, const char* key, const char* dtype, const Box<int>& box,
                  bool vectors) {
  const auto array = py::array::ensure(dict[key], py::array::c_style);
  if (!array || !array.dtype().equal(py::dtype(dtype)) || array.ndim() != (vectors ? 4 : 3))
    throw py::type_error(std::string(key) + ": expected an array of " + dtype);
  for (int axis = 0; axis < 3; ++axis)
    if (array.shape(axis) != box.high[axis] - box.low[axis]) refuse(key, "has another shape than values");
  if (vectors && array.shape(3) != 3) refuse(key, "expected three components");
  return array;
}

Box<int> box_of(const py::dict& dict) {
  const auto values = dict["values"].cast<py::array>();
  if (values.ndim() < 3)
    refuse("values", "expected three axes (x, y, z), got the shape " + shape_text(values));
  Box<int> box{whole_of("low", dict["low"]), {}};
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(box.low[axis]) > 1 << 29 || values.shape(axis) > 1 << 29)
      refuse("low", "the voxels are beyond 2^29");
    box.high[axis] = box.low[axis] + static_cast<int>(values.shape(axis));
  }
  return box;
}

std::vector<grids::Metadata> metadata_of(const py::handle& list) {
  std::vector<grids::Metadata> metadata;
  for (const py::handle& entry : list) {
    const auto parts = entry.cast<std::tuple<std::string, std::string, py::bytes>>();
    metadata.push_back({std::get<0>(parts), std::get<1>(parts), copy_of(std::get<2>(parts))});
  }
  return metadata;
}

py::list list_of(const std::vector<grids::Metadata>& metadata) {
  py::list list;
  for (const grids::Metadata& entry : metadata)
    list.append(py::make_tuple(py::bytes(entry.name), py::bytes(entry.type), bytes_of(entry.bytes)));
  return list;
}

}  // namespace

py::dict dict_of(const grids::Grid& grid) {
  check_places(grid);
  const Box<int> box = released([&] { return bounds_of(grid); });
  check_size(grid, box);
  const glm::ivec3 size = box.high - box.low;
  std::vector<py::ssize_t> shape{size.x, size.y, size.z};
  py::array_t<bool> active(shape);
  if (is_vector(grid.type)) shape.push_back(3);
  py::array values(py::dtype(dtype_of(grid.type)), shape);
  py::array background(py::dtype(dtype_of(grid.type)),
                       std::vector<py::ssize_t>{is_vector(grid.type) ? 3 : 1});
  const bool is_mask = grid.type == ValueType::mask;
  const Dense dense{box, static_cast<std::byte*>(values.mutable_data()), active.mutable_data(),
                    grids::bytes_of(grid.type)};
  released([&] { fill_arrays(grid, dense); });
  if (is_mask) std::copy_n(active.data(), active.size(), static_cast<bool*>(values.mutable_data()));
  std::memset(background.mutable_data(), 0, static_cast<std::size_t>(background.nbytes()));
  std::memcpy(background.mutable_data(), grid.background.data(), grids::bytes_of(grid.type));

  py::dict dict;
  dict["name"] = py::bytes(grid.name);
  dict["type"] = grids::name_of(grid.type);
  dict["grid_class"] = grids::name_of(grid.grid_class);
  dict["half"] = grid.saved_as_half;
  dict["matrix"] = matrix_array(grid.world_from_index);
  dict["background"] = background;
  dict["low"] = tuple_of(box.low);
  dict["values"] = values;
  dict["active"] = active;
  dict["metadata"] = list_of(grid.metadata);
  return dict;
}

grids::Grid grid_of(const py::dict& dict) {
  constexpr std::array kClasses{grids::GridClass::unknown, grids::GridClass::level_set,
                                grids::GridClass::fog_volume, grids::GridClass::staggered};
  grids::Grid grid;
  grid.name = dict["name"].cast<std::string>();
  grid.type = named("type", kTypes, dict["type"].cast<std::string>());
  grid.grid_class = named("grid_class", kClasses, dict["grid_class"].cast<std::string>());
  grid.saved_as_half = dict["half"].cast<bool>();
  grid.world_from_index = matrix_of(dict["matrix"]);
  grid.metadata = metadata_of(dict["metadata"]);

  const Box<int> box = box_of(dict);
  check_size(grid, box);
  const char* const dtype = dtype_of(grid.type);
  py::array values = checked(dict, "values", dtype, box, is_vector(grid.type));
  py::array active = checked(dict, "active", "bool", box, false);
  const auto background = dict["background"].cast<py::array>();
  const std::size_t bytes = grids::bytes_of(grid.type);
  if (!background.dtype().equal(py::dtype(dtype)) ||
      background.nbytes() != static_cast<py::ssize_t>(grid.type == ValueType::mask ? 1 : bytes))
    throw py::type_error("background: expected a value of " + std::string(dtype));
  std::memcpy(grid.background.data(), background.data(), bytes);
  // The bricks only read.
  const Dense dense{box, const_cast<std::byte*>(static_cast<const std::byte*>(values.data())),
                    const_cast<bool*>(static_cast<const bool*>(active.data())), bytes};
  released([&] {
    if (!box.empty()) add_bricks(dense, grid);
  });
  return grid;
}

}  // namespace brume::python
