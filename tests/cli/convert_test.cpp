#include <gtest/gtest.h>

#include "grids/files/grid_files.hpp"
#include "tests/cli/command_test.hpp"
#include "tests/grids/sample_grids.hpp"

namespace brume::cli {
namespace {

class Convert : public CommandTest {
 protected:
  Convert() {
    grids::Grid density = grids::smoke_grid("density", 11), flame = grids::smoke_grid("flame", 5);
    grids::save_grid_file(folder_.path() / "smoke.brv", {{density, flame}, {}}).value_or_throw();
  }
  void convert(const std::string& from, const std::string& to, const Arguments& more = {}) const {
    EXPECT_EQ(run_well({"convert", from, to}, more).error, "");
  }
  Json info(const std::string& file) const { return json_of({"info", file}); }
  grids::GridFile load(const std::string& name) const {
    return grids::load_grid_file(folder_.path() / name).value_or_throw();
  }
};

TEST_F(Convert, KeepsGridsAmongAllFormats) {
  convert("smoke.brv", "a.vdb");
  convert("a.vdb", "b.nvdb");
  convert("b.nvdb", "c.VDB");
  convert("c.VDB", "d.brv");
  expect_same(load("d.brv"), load("smoke.brv"));
}

TEST_F(Convert, ChoosesGridsByName) {
  convert("smoke.brv", "a.vdb", {"--grid", "flame"});
  EXPECT_EQ(info("a.vdb")["grids"].size(), 1u);
  convert("smoke.brv", "b.vdb", {"--grid", "flame", "--grid", "density"});
  EXPECT_EQ(info("b.vdb")["grids"].size(), 2u);
  expect_failure(folder_, {"convert", "smoke.brv", "c.vdb", "--grid", "none"}, 2,
                 {"--grid none", "smoke.brv has no such grid", "density, flame"});
}

TEST_F(Convert, WritesARawArrayAndItsDescription) {
  expect_failure(folder_, {"convert", "smoke.brv", "a.json"}, 2, {"one grid, not 2", "--grid"});
  convert("smoke.brv", "a.json", {"--grid", "density"});
  EXPECT_EQ(std::filesystem::file_size(folder_.path() / "a.raw"), 21u * 21 * 21 * 4);
  convert("a.json", "b.brv");
  EXPECT_TRUE(load("b.brv").grids[0].values == load("smoke.brv").grids[0].values);
  // The array that a description names is an input, too.
  expect_failure(folder_, {"convert", "a.json", "a.json"}, 2, {"is the input"});
  std::filesystem::copy(folder_.path() / "a.json", folder_.path() / "c.json");
  folder_.write("b.json", *read_text_file(folder_.path() / "a.json"));
  std::filesystem::rename(folder_.path() / "a.json", folder_.path() / "e.json");
  expect_failure(folder_, {"convert", "e.json", "a.json"}, 2, {"a.raw", "is the input"});
}

TEST_F(Convert, GridsOfOneNameAreNoChoice) {
  grids::GridFile file = load("smoke.brv");
  for (grids::Grid& grid : file.grids) grid.name = "density";
  grids::save_grid_file(folder_.path() / "two.vdb", file).value_or_throw();
  for (const Arguments& more : {Arguments{}, Arguments{"--grid", "density"}})
    expect_failure(folder_, joined({"convert", "two.vdb", "two.json"}, more), 2,
                   {"one grid, but 2 have the name density; convert to .vdb"});
}

TEST_F(Convert, ReportsWhatItDid) {
  const Json done = json_of({"convert", "smoke.brv", "a.vdb"});
  EXPECT_EQ(done["grids"], (Json{"density", "flame"}));
  EXPECT_EQ(done["bytes"], std::filesystem::file_size(folder_.path() / "a.vdb"));
  const grids::GridFile file = load("smoke.brv");
  EXPECT_EQ(done["active_voxels"], count_active(file.grids[0]) + count_active(file.grids[1]));
}

TEST_F(Convert, ReplacesOnlyFilesOfTheSameKind) {
  for (const char* name : {"a.vdb", "a.nvdb", "a.brv"}) {
    folder_.write(name, "something else, of some length, that is no volume");
    expect_failure(folder_, {"convert", "smoke.brv", name}, 2, {name, "--force"});
    convert("smoke.brv", name, {"--force"});
    convert("smoke.brv", name);
  }
  expect_failure(folder_, {"convert", "smoke.brv", "a.png"}, 2, {"a.png: unknown file suffix"});
  expect_failure(folder_, {"convert", "smoke.brv", "smoke.brv"}, 2, {"is the input"});
}

// Every format, wherever in the file there is no more room.
TEST_F(Convert, WritesAllOfAFileOrNothing) {
  for (const std::string name : {"a.vdb", "a.nvdb", "a.brv"}) {
    convert("smoke.brv", name);
    const std::uint64_t whole = std::filesystem::file_size(folder_.path() / name);
    std::filesystem::remove(folder_.path() / name);
    for (const std::uint64_t bytes : {std::uint64_t{1000}, whole / 2, whole - 1}) {
      RunOptions full;
      full.file_bytes = bytes;
      expect_failure(folder_, {"convert", "smoke.brv", name}, 4, {name + ": cannot write"}, full);
    }
  }
}

TEST_F(Convert, RefusesDamagedFilesAndBombs) {
  grids::save_grid_file(folder_.path() / "bomb.brv", {{grids::huge_tile()}, {}}).value_or_throw();
  expect_failure(folder_, {"convert", "bomb.brv", "a.vdb"}, 4, {"bomb.brv: ", "68719476736 active voxels"});
  expect_failure(folder_, {"info", "bomb.brv"}, 4, {"bomb.brv: ", "limit"});
  folder_.write("text.vdb", "hello");
  expect_failure(folder_, {"info", "text.vdb"}, 3, {"text.vdb: "});
  expect_failure(folder_, {"info", "none.vdb"}, 3, {"none.vdb: cannot open"});
  expect_failure(folder_, {"convert", "none.nvdb", "a.vdb"}, 3, {"none.nvdb: cannot open"});
  RunOptions without;
  without.environment = {{"BRUME_VDB", "/none/brume-vdb"}};
  expect_failure(folder_, {"info", "text.vdb"}, 5, {"text.vdb: ", "brume-vdb"}, without);
}

TEST_F(Convert, InfoDescribesGrids) {
  convert("smoke.brv", "a.vdb");
  for (const char* name : {"smoke.brv", "a.vdb"}) {
    const Json file = info(name);
    EXPECT_EQ(file["kind"], "volumes");
    const Json& density = file["grids"][0];
    EXPECT_EQ(density["name"], "density");
    EXPECT_EQ(density["type"], "float32");
    EXPECT_EQ(density["class"], "fog volume");
    EXPECT_EQ(density["saved_as_half"], true);
    EXPECT_EQ(density["active_voxels"], count_active(grids::smoke_grid("density", 11)));
    EXPECT_EQ(density["index_bounds"], (Json{{"min", {-10.5, -10.5, -10.5}}, {"max", {10.5, 10.5, 10.5}}}));
    // 0.125 m a voxel, moved by (-1, 2, 0.5).
    EXPECT_EQ(density["world_bounds"]["min"], (Json{-2.3125, 0.6875, -0.8125}));
    EXPECT_EQ(density["voxel_size"], (Json{0.125, 0.125, 0.125}));
    EXPECT_EQ(density["max"], 11.0625);
    std::uint64_t sum = 0;
    for (const Json& count : density["histogram"]) sum += count.get<std::uint64_t>();
    EXPECT_EQ(density["histogram"].size(), 16u);
    EXPECT_EQ(sum, density["active_voxels"]);
  }
  const std::string text = run({"info", "a.vdb"}).out;
  for (const char* part :
       {"density ", "float32, fog volume, saved in half precision", "-10.5,-10.5,-10.5 to 10.5"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

}  // namespace
}  // namespace brume::cli
