// Volumes keep all that they hold on their way through OpenVDB and NanoVDB.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "core/file.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/volume_files.hpp"
#include "tests/grids/child.hpp"
#include "tests/grids/sample_grids.hpp"

namespace brume::grids {
namespace {

namespace fs = std::filesystem;

class Vdb : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  GridFile through(const std::string& name, const GridFile& file) const {
    save_grid_file(path(name), file).value_or_throw();
    return load_grid_file(path(name)).value_or_throw();
  }
  // What OpenVDB's own program prints of a file, or the shell's complaint that it is not there.
  std::string vdb_print(const std::string& name) const {
    const std::string out = path("print.txt").string();
    const std::string command = "vdb_print -l '" + path(name).string() + "' > '" + out + "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << "script/bootstrap test installs libopenvdb-tools";
    return *read_text_file(out);
  }

  WorkFolder folder_;
  ChildProgram program_;
};

// OpenVDB sorts grids by name.
GridFile sorted(GridFile file) {
  std::stable_sort(file.grids.begin(), file.grids.end(),
                   [](const Grid& a, const Grid& b) { return a.name < b.name; });
  return file;
}

GridFile file_of_all_types(bool with_vec3i) {
  GridFile file;
  for (const ValueType type : kAllTypes)
    if (type != ValueType::vec3i || with_vec3i) file.grids.push_back(random_grid(type, 7));
  file.grids.push_back(smoke_grid("density", 11));
  file.grids.push_back(smoke_grid("density", 5));  // A file may hold one name twice.
  file.grids.push_back(Grid{});
  file.metadata = sample_metadata();
  return file;
}

TEST_F(Vdb, KeepsGridsOfEveryType) {
  const GridFile file = file_of_all_types(true);
  const GridFile again = through("a.vdb", file);
  expect_same(sorted(again), sorted(file));
  expect_same(sorted(through("b.vdb", again)), sorted(file));
}

// Of every format the grids that are chosen are read, in their order.
TEST_F(Vdb, ReadsTheChosenGridsOfEveryFormat) {
  const GridFile file{{smoke_grid("a", 5), smoke_grid("b", 7), smoke_grid("b", 9), smoke_grid("c", 11)}, {}};
  for (const char* name : {"a.brv", "a.vdb", "a.nvdb"}) {
    save_grid_file(path(name), file).value_or_throw();
    std::vector<std::string> names;
    const auto choice = [&](std::span<const Grid* const> heads) -> Result<std::vector<std::size_t>> {
      for (const Grid* head : heads) names.push_back(head->name);
      return std::vector<std::size_t>{0, 2};
    };
    const GridFile read = load_grid_file(path(name), {}, choice).value_or_throw();
    EXPECT_EQ(names, (std::vector<std::string>{"a", "b", "b", "c"})) << name;
    expect_same({read.grids, {}}, {{file.grids[0], file.grids[2]}, {}});
    const auto refused = load_volume_file(path(name), {}, [](std::span<const Grid* const>) {
      return Result<std::vector<std::size_t>>(Failure{ErrorCode::bad_input, "none"});
    });
    ASSERT_FALSE(refused) << name;
  }
}

TEST_F(Vdb, NanoKeepsGridsOfEveryTypeThatItHas) {
  const GridFile file = file_of_all_types(false);
  expect_same(through("a.nvdb", file), file);
  // The same bytes, on every machine.
  save_grid_file(path("b.nvdb"), file).value_or_throw();
  EXPECT_TRUE(*read_file(path("a.nvdb")) == *read_file(path("b.nvdb")));
  const auto no_vec3i = save_grid_file(path("c.nvdb"), {{random_grid(ValueType::vec3i, 1)}, {}});
  ASSERT_FALSE(no_vec3i);
  EXPECT_EQ(no_vec3i.failure().code, ErrorCode::bad_input);
  EXPECT_FALSE(fs::exists(path("c.nvdb")));
}

TEST_F(Vdb, NanoKeepsLongNames) {
  GridFile file{{smoke_grid(std::string(300, 'n'), 3), smoke_grid(std::string(255, 'm'), 3)}, {}};
  expect_same(through("a.nvdb", file), file);
}

// Versions since 32.6 begin files and grids with digits of their own, and write grids without a head of the
// file.
TEST_F(Vdb, ReadsNanoFilesOfLaterVersions) {
  const GridFile file{{smoke_grid("density", 11), random_grid(ValueType::vec3f, 7)}, sample_metadata()};
  save_grid_file(path("a.nvdb"), file).value_or_throw();
  std::vector<std::byte> bytes = *read_file(path("a.nvdb"));
  const std::string_view name("NanoVDB0", 8);
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i + 8 <= bytes.size(); ++i)
    if (std::memcmp(&bytes[i], name.data(), 8) == 0) at.push_back(i);
  ASSERT_EQ(at.size(), 4u) << "of a segment and its grid, twice";
  for (const std::size_t segment : {at[0], at[2]}) bytes[segment + 7] = std::byte{'2'};
  for (const std::size_t grid : {at[1], at[3]}) bytes[grid + 7] = std::byte{'1'};
  write_file_atomic(path("new.nvdb"), bytes).value_or_throw();
  expect_same(load_grid_file(path("new.nvdb")).value_or_throw(), file);
  // The grids alone, one after the other.
  const auto part = [&](std::size_t begin, std::size_t end) {
    return std::span(bytes).subspan(begin, end - begin);
  };
  std::vector<std::byte> raw(part(at[1], at[2]).begin(), part(at[1], at[2]).end());
  raw.insert(raw.end(), part(at[3], bytes.size()).begin(), part(at[3], bytes.size()).end());
  write_file_atomic(path("raw.nvdb"), raw).value_or_throw();
  expect_same(load_grid_file(path("raw.nvdb")).value_or_throw(), file);
  for (const std::size_t length : {std::size_t{20}, std::size_t{1000}, raw.size() - 1}) {
    write_file_atomic(path("raw.nvdb"), std::span(raw).first(length)).value_or_throw();
    EXPECT_FALSE(load_grid_file(path("raw.nvdb"))) << length;
  }

  bytes[7] = std::byte{'7'};
  write_file_atomic(path("new.nvdb"), bytes).value_or_throw();
  const auto later = load_grid_file(path("new.nvdb"));
  ASSERT_FALSE(later);
  EXPECT_NE(later.failure().message.find("begins with NanoVDB7; expected NanoVDB0, 1 or 2"),
            std::string::npos)
      << later.failure().message;
}

TEST_F(Vdb, KeepsGridsOnEveryPathAmongTheFormats) {
  const GridFile file = sorted(file_of_all_types(false));
  const GridFile first = through("a.vdb", file);
  expect_same(through("e.vdb", through("d.nvdb", through("c.brv", first))), file);
  // OpenVDB's own program finds the same in both, other than what the path in between has no influence on.
  const auto described = [&](const std::string& name) { return vdb_print(name); };
  EXPECT_EQ(described("a.vdb"), described("e.vdb"));
}

TEST_F(Vdb, OpenVdbFindsWhatIsWritten) {
  save_grid_file(path("a.vdb"), {{smoke_grid("density", 11)}, {}}).value_or_throw();
  const std::string text = vdb_print("a.vdb");
  const std::uint64_t active = count_active(smoke_grid("density", 11));
  std::string count = std::to_string(active);
  for (std::size_t i = count.size(); i > 3; i -= 3) count.insert(i - 3, ",");
  for (const std::string& part : std::vector<std::string>{
           "Name: density", "Type: Tree_float_5_4_3", "Number of active voxels:       " + count,
           "Bounding box of active voxels: [-10, -10, -10] -> [10, 10, 10]", "class: fog volume",
           "is_saved_as_half_float: true", "voxel size: 0.125", "[-1, 2, 0.5, 1]"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

// OpenVDB tries, and prints a warning where results go.
TEST_F(Vdb, ReadsAFileOfALaterVersion) {
  const GridFile file{{smoke_grid("density", 11)}, {}};
  save_grid_file(path("a.vdb"), file).value_or_throw();
  std::string bytes = *read_text_file(path("a.vdb"));
  bytes[8] = '\xff';
  folder_.write("b.vdb", bytes);
  expect_same(load_grid_file(path("b.vdb")).value_or_throw(), file);
}

TEST_F(Vdb, ReplacesNoFileUnlessItIsComplete) {
  const GridFile good{{smoke_grid("density", 3)}, {}};
  for (const char* name : {"a.vdb", "a.nvdb", "a.brv"}) {
    save_grid_file(path(name), good).value_or_throw();
    GridFile bad = good;
    bad.grids[0].values.pop_back();
    const auto saved = save_grid_file(path(name), bad);
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.failure().code, ErrorCode::bad_input);
    expect_same(load_grid_file(path(name)).value_or_throw(), good);
  }
  EXPECT_EQ(folder_.files(), (std::vector<std::string>{"a.brv", "a.nvdb", "a.vdb"}));
}

}  // namespace
}  // namespace brume::grids
