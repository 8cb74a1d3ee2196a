// The add-on's own tests, which run in Blender: addon_*_test.py.
#include "tests/blender/blender_fixture.hpp"

namespace brume::blender {
namespace {

TEST_F(Blender, AddonTestsPass) {
  const nlohmann::json failures = read_json(blender_run().folder / "addon.json");
  ASSERT_GT(failures.size(), 50u);
  for (const auto& [name, failure] : failures.items()) EXPECT_EQ(failure, "") << name;
}

}  // namespace
}  // namespace brume::blender
