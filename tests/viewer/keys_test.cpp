#include "apps/viewer/keys.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/file.hpp"

namespace brume::viewer {
namespace {

TEST(KeysTest, EveryActionHasAKeyAndEveryKeyOneAction) {
  std::set<Action> actions;
  std::set<std::pair<bool, int>> codes;
  for (const KeyBinding& binding : key_bindings()) {
    actions.insert(binding.action);
    EXPECT_TRUE(codes.insert({binding.mouse, binding.code}).second) << binding.name;
  }
  EXPECT_EQ(actions.size(), kActions);
}

TEST(KeysTest, DocumentationListsEveryKey) {
  const std::string document = read_text_file(BRUME_SOURCE_DIR "/docs/viewer.md").value_or_throw();
  for (const KeyBinding& binding : key_bindings()) {
    const std::string row = std::string("| ") + binding.name + " | " + binding.does + " |\n";
    EXPECT_NE(document.find(row), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace brume::viewer
