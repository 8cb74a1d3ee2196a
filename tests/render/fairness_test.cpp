#include "tests/render/fairness.hpp"
#include "tests/render/hall.hpp"

namespace brume::render {
namespace {

TEST_F(FairnessTest, NoScaleShowsWhatFullResolutionHides) {
  const scenario::Scenario scenario = hall();
  expect_fair(scenario, random_pairs(scenario, {-5.8f, 0.3f, -5.8f}, {5.8f, 3.5f, 5.8f}, 12, 24));
}

}  // namespace
}  // namespace brume::render
