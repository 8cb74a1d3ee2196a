#include "python/grids.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>

#include "grids/files/grid_files.hpp"
#include "grids/files/raw_file.hpp"
#include "python/grid_arrays.hpp"

namespace brume::python {
namespace {

namespace fs = std::filesystem;
using Names = std::optional<std::vector<std::string>>;

/// Runs work(limits) in a thread of its own, which Ctrl-C stops.
template <typename Work>
auto interruptible(const Work& work) {
  std::atomic<bool> stopped = false;
  grids::GridLimits limits;
  limits.stopped = &stopped;
  return released([&] {
    auto result = std::async(std::launch::async, [&] { return work(limits); });
    while (result.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
      try {
        stop_if_interrupted();
      } catch (...) {
        stopped = true;
        result.wait();
        throw;
      }
    }
    return result.get();
  });
}

void select_grids(grids::GridFile& file, const fs::path& path, const Names& names) {
  if (!names) return;
  const auto is_named = [](const std::string& name) {
    return [&name](const grids::Grid& grid) { return grid.name == name; };
  };
  std::string known;
  for (const grids::Grid& grid : file.grids) known += (known.empty() ? "" : ", ") + grid.name;
  for (const std::string& name : *names)
    if (std::ranges::none_of(file.grids, is_named(name)))
      refuse("names",
             path.string() + " has no grid " + name + "; it has " + (known.empty() ? "none" : known));
  std::erase_if(file.grids, [&](const grids::Grid& grid) {
    return std::ranges::find(*names, grid.name) == names->end();
  });
}

grids::GridFile load_file(const fs::path& path, const Names& names) {
  if (!grids::is_grid_file(path))
    refuse("path", path.string() + ": unknown file suffix; expected .brv, .vdb, .nvdb or .json");
  auto file = interruptible(
      [&](const grids::GridLimits& limits) { return of_file(grids::load_grid_file(path, limits), path); });
  select_grids(file, path, names);
  return file;
}

/// An output that is one of the files that are read, by whatever name.
void refuse_input(const fs::path& input, const fs::path& output) {
  std::vector<fs::path> written{output};
  if (grids::is_raw_description(output)) written.push_back(grids::raw_path_of(output));
  std::error_code ignored;
  for (const fs::path& read : of_file(grids::files_of(input), input))
    for (const fs::path& file : written)
      if (fs::equivalent(read, file, ignored))
        refuse("output", file.string() + ": is the input; name another file");
}

void save_file(const fs::path& path, const grids::GridFile& file) {
  released([&] {
    if (!grids::is_raw_description(path))
      return of_file(grids::save_grid_file(path, file), path, FileUse::write);
    if (file.grids.size() != 1)
      refuse("path", path.string() + ": a raw file holds one grid, not " + std::to_string(file.grids.size()));
    of_file(grids::save_raw(path, file.grids.front()), path, FileUse::write);
  });
}

}  // namespace

void bind_grids(py::module_& module) {
  using namespace py::literals;
  module.def(
      "_read_grids",
      [](const fs::path& path, const Names& names) {
        const grids::GridFile file = load_file(path, names);
        py::list grids;
        for (const grids::Grid& grid : file.grids) grids.append(dict_of(grid));
        return grids;
      },
      "path"_a, "names"_a, "What read_grids makes its result of.");
  module.def(
      "_write_grids",
      [](const fs::path& path, const py::list& dicts) {
        grids::GridFile file;
        for (const py::handle& dict : dicts) file.grids.push_back(grid_of(dict.cast<py::dict>()));
        save_file(path, file);
      },
      "path"_a, "dicts"_a, "Writes what write_grids prepares.");
  module.def(
      "convert",
      [](const fs::path& input, const fs::path& output, const Names& names) {
        refuse_input(input, output);
        save_file(output, load_file(input, names));
      },
      "input"_a, "output"_a, py::kw_only(), "names"_a = py::none(),
      R"(Converts a volume file to another format, as brume convert does, voxel by voxel and without arrays.

input: .vdb, .nvdb, .brv, or .json that describes a raw array.
output: .vdb, .nvdb, .brv, or .json beside which a .raw file is written; completely or not at all. Never the input.
names: the grids to take; default: all.

.vdb and .nvdb require the program brume-vdb: that of the environment variable BRUME_VDB, which the import of the
module sets to the one it was built or installed with, or one on the PATH. Raises FileNotFoundError and OSError,
ValueError for a damaged file or an unknown
name, MemoryError beyond 8 GiB, RuntimeError without brume-vdb.)");
}

}  // namespace brume::python
