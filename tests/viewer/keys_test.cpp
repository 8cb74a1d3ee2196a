#include "apps/viewer/keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

#include "core/file.hpp"

namespace brume::viewer {
namespace {

TEST(KeysTest, EveryCommandHasAKeyAndEveryKeyOneAction) {
  std::set<Action> commands;
  for (const KeyMap map : {KeyMap::level, KeyMap::tank}) {
    std::set<std::tuple<bool, int, bool, bool>> codes;
    for (const KeyBinding& binding : key_bindings(map)) {
      if (!event_type(binding.action)) commands.insert(binding.action);
      const auto [shift, control] = binding.modifiers;
      EXPECT_TRUE(codes.insert({binding.mouse, binding.code, shift, control}).second) << binding.name;
      EXPECT_EQ(action_of(binding.mouse, binding.code, binding.modifiers, map), binding.action)
          << binding.name;
    }
  }
  EXPECT_EQ(commands.size(), kCommands);
}

TEST(KeysTest, EachKindOfEventHasAnAction) {
  std::size_t kinds = 0;
  scene::for_each_event_kind([&](const std::string& type, auto) {
    EXPECT_EQ(event_type(static_cast<Action>(kCommands + kinds)), type);
    ++kinds;
  });
  EXPECT_EQ(kCommands + kinds, kActions);
  EXPECT_EQ(event_type(kThrowSmoke), std::string("smoke"));
  EXPECT_EQ(event_type(Action::undo), nullptr);
}

TEST(KeysTest, ShiftRunsAndControlReservesKeys) {
  EXPECT_EQ(action_of(false, 'W', {.shift = true}), Action::forward);
  EXPECT_EQ(action_of(false, 'W', {.control = true}), std::nullopt);
  EXPECT_EQ(action_of(false, 'Z', {}), std::nullopt);
  EXPECT_EQ(action_of(false, 'R', {}), Action::rewind);
  EXPECT_EQ(action_of(false, 'R', {.shift = true}), Action::empty);
}

TEST(KeysTest, HelpHasEachKeyOnceInGroups) {
  EXPECT_EQ(help_rows().front().keys, "W A S D");
  for (const KeyMap map : {KeyMap::level, KeyMap::tank}) {
    const std::vector<HelpRow> rows = help_rows(map);
    std::set<std::string> keys;
    for (const HelpRow& row : rows) EXPECT_TRUE(keys.insert(row.keys).second) << row.keys;
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(),
                               [](const HelpRow& a, const HelpRow& b) { return a.group < b.group; }));
  }
}

TEST(KeysTest, DocumentationListsEveryKey) {
  const std::string document = read_text_file(BRUME_SOURCE_DIR "/docs/guides/viewer.md").value_or_throw();
  for (const KeyMap map : {KeyMap::level, KeyMap::tank})
    for (const HelpRow& row : help_rows(map)) {
      const std::string line = "| " + row.keys + " | " + row.does + " |\n";
      EXPECT_NE(document.find(line), std::string::npos) << line;
    }
}

}  // namespace
}  // namespace brume::viewer
