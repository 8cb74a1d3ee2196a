#include <gtest/gtest.h>

#include "tests/grids/child.hpp"
#include "tests/grids/mutations.hpp"
#include "tests/sanitized.hpp"

namespace brume::grids {
namespace {

TEST(AllMutations, AreReadOrRefused) {
  load_mutations(1000, 10'000);
  EXPECT_LT(child_costs().max_megabytes, kSanitized ? 8192 : 1280);
}

}  // namespace
}  // namespace brume::grids
