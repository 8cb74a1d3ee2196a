// Bombs are refused with a reason, and cost little.
#include <gtest/gtest.h>

#include "core/file.hpp"
#include "grids/files/grid_files.hpp"
#include "tests/grids/bombs.hpp"
#include "tests/grids/child.hpp"
#include "tests/grids/sample_grids.hpp"
#include "tests/sanitized.hpp"

namespace brume::grids {
namespace {

// What the smallest file may take, and a margin for the start of the child.
constexpr double kMostSeconds = 4;
constexpr double kMostMegabytes = kSanitized ? 8192 : 1280;

class Bombs : public testing::Test {
 protected:
  Failure failure_of(const Bomb& bomb) const {
    const auto path = folder_.path() / ("bomb." + bomb.name.substr(0, bomb.name.find(':')));
    write_file_atomic(path, bomb.bytes).value_or_throw();
    const auto file = load_grid_file(path);
    return file ? Failure{} : file.failure();
  }
  void expect_refusals(const std::vector<Bomb>& bombs) const {
    for (const Bomb& bomb : bombs) {
      SCOPED_TRACE(bomb.name);
      EXPECT_LT(bomb.bytes.size(), 600'000u);
      const double before = child_costs().cpu_seconds;
      const Failure failure = failure_of(bomb);
      EXPECT_TRUE(failure.code == ErrorCode::bad_input || failure.code == ErrorCode::resource_limit)
          << failure.message;
      EXPECT_EQ(failure.message.find('\n'), std::string::npos);
      EXPECT_LT(child_costs().cpu_seconds - before, kMostSeconds * (kSanitized ? 10 : 1));
      EXPECT_LT(child_costs().max_megabytes, kMostMegabytes);
      if (bomb.name.find("voxels") != std::string::npos) {
        EXPECT_EQ(failure.code, ErrorCode::resource_limit) << failure.message;
      }
    }
  }
  WorkFolder folder_;
  ChildProgram program_;
};

TEST_F(Bombs, OfVdbAreRefused) {
  std::vector<Bomb> bombs = vdb_bombs(folder_.path().string());
  // A sanitizer sees nothing of OpenVDB, and lifts the limit of memory: gigabytes for each.
  if (kSanitized) bombs.resize(1);
  expect_refusals(bombs);
}
TEST_F(Bombs, OfNvdbAreRefused) {
  expect_refusals(nvdb_bombs(folder_.path().string()));
}
TEST_F(Bombs, OfBrvAreRefused) {
  expect_refusals(brv_bombs());
}

TEST_F(Bombs, AreFortyAndMore) {
  const std::string folder = folder_.path().string();
  EXPECT_GE(vdb_bombs(folder).size() + nvdb_bombs(folder).size() + brv_bombs().size(), 40u);
}

TEST_F(Bombs, SixtyNineBillionVoxelsAreRefusedBeforeTheyAreMade) {
  const auto path = folder_.path() / "huge.vdb";
  save_grid_file(path, {{huge_tile()}, {}}).value_or_throw();
  EXPECT_LT(std::filesystem::file_size(path), 1000u);
  const double before = child_costs().cpu_seconds;
  const auto file = load_grid_file(path);
  EXPECT_LT(child_costs().cpu_seconds - before, kMostSeconds);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.failure().code, ErrorCode::resource_limit);
  EXPECT_NE(file.failure().message.find("68719476736 active voxels"), std::string::npos);
}

}  // namespace
}  // namespace brume::grids
