#include "tests/grids/mutations.hpp"

#include <gtest/gtest.h>

#include "tests/grids/child.hpp"
#include "tests/sanitized.hpp"

namespace brume::grids {
namespace {

TEST(Mutations, AreReadOrRefused) {
  load_mutations(1, kSanitized ? 24 : 200);
  EXPECT_LT(child_costs().max_megabytes, kSanitized ? 8192 : 1280);
}

}  // namespace
}  // namespace brume::grids
