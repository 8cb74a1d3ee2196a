// A window with its panels open, whose widgets a test finds by their labels.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "scene/files/timeline_reader.hpp"
#include "scene/timeline.hpp"
#include "tests/viewer/foggy_room.hpp"

namespace brume::viewer {

class PanelTest : public testing::Test {
 protected:
  PanelTest() { write_busy_room(folder_); }

  void run(const std::string& timeline = "foggy.toml", const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{timeline,   "--size",        "640x700",  "--panels", "--quality",
                                   "smallest", "--log-widgets", "--record", "made.toml"};
    words.insert(words.end(), more.begin(), more.end());
    program_.emplace(desktop_, folder_.path(), words);
    ASSERT_TRUE(program_->wait_for_window()) << program_->error();
  }
  /// The widget of this label, unfolded and scrolled into view.
  WidgetLine widget(const std::string& label) {
    for (int turns = 0; turns < 60 && program_->runs(); ++turns) {
      const auto& all = program_->widgets();
      const auto found = std::ranges::find(all, label, &WidgetLine::label);
      if (found != all.end() && found->reachable) return *found;
      program_->place_mouse(580, 300);
      program_->click(found != all.end() && found->low_px.y < 300 ? 4 : 5);  // the wheel
      program_->wait_for_frames(3);
    }
    ADD_FAILURE() << label << " is never in view; " << program_->error();
    return {};
  }
  void move_to(glm::ivec2 place) {
    program_->place_mouse(place.x, place.y);
    program_->wait_for_frames(2);
  }
  void click(glm::ivec2 place, unsigned button = 1) {
    move_to(place);
    program_->click(button);
    program_->wait_for_frames(5);
  }
  void click(const std::string& label) {
    const WidgetLine at = widget(label);
    click((at.low_px + at.high_px) / 2);
  }
  /// The timeline of the session, after its end.
  scene::Timeline saved() {
    program_->close();
    EXPECT_EQ(program_->wait(), 0) << program_->error();
    return scene::load_timeline(folder_.path() / "made.toml").value_or_throw();
  }

  cli::WorkFolder folder_;
  Desktop desktop_;
  std::optional<Program> program_;
};

}  // namespace brume::viewer
