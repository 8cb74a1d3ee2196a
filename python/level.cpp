#include "python/level.hpp"

#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>

#include "python/arrays.hpp"
#include "scenario/world_triangles.hpp"
#include "scene/files/load.hpp"
#include "voxel/voxelize.hpp"
#include "vxl/file.hpp"

namespace brume::python {
namespace {

namespace fs = std::filesystem;

Level level_of(scenario::Voxels voxels) {
  return {std::make_shared<const scenario::Voxels>(std::move(voxels))};
}

Level from_array(const py::array& solid, float voxel_size, const py::object& origin) {
  if (solid.dtype().kind() != 'b')
    throw py::type_error("solid: expected an array of bool, got the dtype " +
                         py::str(solid.dtype()).cast<std::string>());
  if (solid.ndim() != 3) refuse("solid", "expected three axes (x, y, z), got the shape " + shape_text(solid));
  voxel::GridLayout layout;
  for (int axis = 0; axis < 3; ++axis)
    layout.size[axis] = static_cast<int>(std::min<py::ssize_t>(solid.shape(axis), 1 << 30));
  layout.voxel_size = voxel_size;
  layout.origin_world = glm::vec3(vector_of("origin", origin));
  voxel::check_frame(layout).value_or_throw();
  const auto values = py::array_t<bool, py::array::c_style>::ensure(solid);
  if (!values) throw py::error_already_set();

  return released([&] {
    scenario::Voxels voxels{voxel::BitGrid(layout), {}};
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (int x = 0; x < layout.size.x; ++x)
      for (int y = 0; y < layout.size.y; ++y)
        for (int z = 0; z < layout.size.z; ++z)
          if (*bytes++ != 0) voxels.grid.set({x, y, z}, true);
    return level_of(std::move(voxels));
  });
}

std::vector<voxel::Triangle> triangles_of(const py::object& value) {
  const py::array array = numbers_of("triangles", value);
  if (array.ndim() != 3 || array.shape(1) != 3 || array.shape(2) != 3)
    refuse("triangles", "expected the shape (N, 3, 3), got " + shape_text(array));
  const auto numbers = Floats::ensure(array);
  if (!numbers) throw py::error_already_set();
  for (py::ssize_t i = 0; i < numbers.size(); ++i)
    if (!std::isfinite(numbers.data()[i]))
      refuse("triangles", "corner " + std::to_string(i / 3 % 3) + " of triangle " + std::to_string(i / 9) +
                              " is not finite");
  std::vector<voxel::Triangle> triangles(static_cast<std::size_t>(numbers.shape(0)));
  if (!triangles.empty())
    std::memcpy(static_cast<void*>(triangles.data()), numbers.data(),
                sizeof(voxel::Triangle) * triangles.size());
  return triangles;
}

/// By the number of each triangle's Role; None: all are walls.
voxel::TrianglesByRole by_role(std::vector<voxel::Triangle> triangles, const py::object& value) {
  if (value.is_none()) return {std::move(triangles), {}, {}};
  const py::array array = numbers_of("roles", value);
  if (array.ndim() != 1 || array.size() != static_cast<py::ssize_t>(triangles.size()))
    refuse("roles", "expected the shape (N,), one for each triangle, got " + shape_text(array));
  const auto numbers = Doubles::ensure(array);
  if (!numbers) throw py::error_already_set();
  voxel::TrianglesByRole result;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const double number = numbers.data()[i];
    if (number != 0 && number != 1 && number != 2 && number != 3)
      refuse("roles", "expected 0 (wall), 1 (glass), 2 (grille) or 3 (ghost) at " + std::to_string(i));
    result.add(static_cast<Role>(static_cast<int>(number)), std::span(triangles).subspan(i, 1));
  }
  return result;
}

voxel::GridLayout layout_around(std::span<const voxel::Triangle> triangles, float voxel_size, int margin) {
  if (triangles.empty()) refuse("triangles", "are none; give size and origin for an empty level");
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const voxel::Triangle& t : triangles) {
    low = glm::min(low, glm::min(t.a, glm::min(t.b, t.c)));
    high = glm::max(high, glm::max(t.a, glm::max(t.b, t.c)));
  }
  return voxel::layout_around(low, high, voxel_size, margin).value_or_throw();
}

Level voxelized(const voxel::TrianglesByRole& triangles, const voxel::GridLayout& layout) {
  voxel::BitGrid grid = voxel::voxelize(triangles.smoke, layout).value_or_throw();
  voxel::SurfacePlanes planes = voxel::SurfacePlanes::build(triangles.smoke, grid);
  voxel::RoleGrids roles = voxel::voxelize_roles(triangles, grid).value_or_throw();
  return level_of({std::move(grid), std::move(planes), false, 0, triangles.smoke.size(), std::move(roles)});
}

Level from_triangles(const py::object& value, float voxel_size, const py::object& size,
                     const py::object& origin, int margin, const py::object& roles) {
  const std::vector<voxel::Triangle> triangles = triangles_of(value);
  const voxel::TrianglesByRole sorted = by_role(triangles, roles);
  if (size.is_none() != origin.is_none())
    refuse(size.is_none() ? "origin" : "size", "requires both size and origin");
  std::optional<voxel::GridLayout> layout;
  if (!size.is_none()) layout = {whole_of("size", size), voxel_size, glm::vec3(vector_of("origin", origin))};
  return released(
      [&] { return voxelized(sorted, layout ? *layout : layout_around(triangles, voxel_size, margin)); });
}

Level load_level(const fs::path& path, float voxel_size, int margin) {
  return released([&] {
    if (scene::lower_extension(path) == ".vxl") {
      auto contents = of_file(vxl::load(path, std::nullopt), path);
      return level_of({std::move(contents->grid), std::move(contents->planes), true, 0, contents->triangles,
                       std::move(contents->roles)});
    }
    const scene::Scene scene = of_file(scene::load_scene(path), path);
    const std::vector<voxel::Triangle> all = scenario::world_triangles(scene, stops_bodies);
    return voxelized(scenario::triangles_by_role(scene), layout_around(all, voxel_size, margin));
  });
}

void save_level(const Level& level, const fs::path& path) {
  if (scene::lower_extension(path) != ".vxl") refuse("path", path.string() + ": expected the suffix .vxl");
  released([&] {
    const scenario::Voxels& v = *level.voxels;
    of_file(vxl::save(path, {v.grid, v.planes, v.triangles, v.roles}, 0), path, FileUse::write);
  });
}

std::string description(const Level& level) {
  const voxel::GridLayout& layout = level.grid().layout();
  char text[160];
  std::snprintf(text, sizeof text, "Level(size=(%d, %d, %d), voxel_size=%g, origin=(%g, %g, %g))",
                layout.size.x, layout.size.y, layout.size.z, double{layout.voxel_size},
                double{layout.origin_world.x}, double{layout.origin_world.y}, double{layout.origin_world.z});
  return text;
}

}  // namespace

void bind_level(py::module_& module) {
  using namespace py::literals;
  py::class_<Level>(module, "Level", R"(The walls of a world: voxels that are solid, and the surfaces in them.

A level never changes; World.set_solid changes one world. y points up.)")
      .def_static("from_array", &from_array, "solid"_a, "voxel_size"_a = 0.25f,
                  "origin"_a = py::make_tuple(0.0, 0.0, 0.0), R"(A level from an array of solid voxels.

solid: bool, shape (x, y, z), each axis 1 to 4096 long. solid[i, j, k] covers
    origin + voxel_size * [i, i + 1) x [j, j + 1) x [k, k + 1).
voxel_size: edge length of a voxel [m], 1/64 to 64.
origin: low corner of voxel (0, 0, 0) [m].

Smoke ends at the faces of the voxels. Raises TypeError for another dtype, ValueError for another shape or a
number out of range, MemoryError for an axis beyond 4096.)")
      .def_static("from_triangles", &from_triangles, "triangles"_a, "voxel_size"_a = 0.25f, py::kw_only(),
                  "size"_a = py::none(), "origin"_a = py::none(), "margin"_a = 2, "roles"_a = py::none(),
                  R"(A level from triangles: exactly the voxels that a wall or glass touches are solid.

triangles: numbers, shape (N, 3, 3): the corners of each triangle [m], in any order.
voxel_size: edge length of a voxel [m], 1/64 to 64.
size, origin: voxels along each axis, 1 to 4096, and low corner of voxel (0, 0, 0) [m]. By default around all
    triangles, with `margin` voxels on every side.
roles: what each triangle stops, shape (N,): 0 for a wall, 1 for glass, which sight passes, 2 for a grille, which stops
    only bodies and grenades, 3 for nothing. By default all are walls.

Smoke ends at the triangles, not at the voxels. Raises ValueError for another shape or a number that is not
finite, MemoryError for an axis beyond 4096.)")
      .def_static("load", &load_level, "path"_a, "voxel_size"_a = 0.25f, py::kw_only(), "margin"_a = 2,
                  R"(A level from a scene (.glb, .gltf, .obj, .txt) or from voxels (.vxl).

voxel_size, margin: as in from_triangles; a .vxl file has its own.

Raises FileNotFoundError, ValueError for a damaged file, MemoryError for an axis beyond 4096 voxels.)")
      .def(
          "save", &save_level, "path"_a,
          R"(Writes a .vxl file, completely or not at all. Raises OSError, and ValueError for another suffix.)")
      .def_property_readonly(
          "size", [](const Level& l) { return tuple_of(l.grid().size()); }, "Voxels along x, y and z.")
      .def_property_readonly(
          "voxel_size", [](const Level& l) { return l.grid().layout().voxel_size; },
          "Edge length of a voxel [m].")
      .def_property_readonly(
          "origin", [](const Level& l) { return tuple_of(l.grid().layout().origin_world); },
          "Low corner of voxel (0, 0, 0) [m].")
      .def_property_readonly(
          "solid", [](const Level& l) { return solid_array(l.grid()); },
          "Which voxels are solid: a new array of bool, shape (x, y, z). MemoryError beyond 2^30 voxels.")
      .def_property_readonly(
          "roles", [](const Level& l) { return role_array(l.voxels->solids()); },
          "What each voxel stops: a new array of uint8, shape (x, y, z). 0: wall, 1: glass, 2: grille, 3: "
          "nothing, it is free. MemoryError beyond 2^30 voxels.")
      .def_property_readonly(
          "hash", [](const Level& l) { return l.voxels->level_hash(); },
          "Hash of the voxels and surfaces: levels of one hash give the same smoke and lines of sight.")
      .def("__repr__", &description);
}

}  // namespace brume::python
