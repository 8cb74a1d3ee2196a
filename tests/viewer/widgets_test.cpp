// Every widget of every panel takes a click: the program lists its widgets in the frame log, and the test
// uses each of them until none is left.
#include <X11/keysym.h>

#include <map>
#include <regex>

#include "core/file.hpp"
#include "tests/viewer/foggy_room.hpp"
#include "tests/viewer/small_tank.hpp"

namespace brume::viewer {
namespace {

constexpr unsigned kWidth = 640, kHeight = 480;
constexpr unsigned kWheelUp = 4, kWheelDown = 5;
constexpr glm::ivec2 kBesideThePanels(40, 300);

class WidgetsTest : public testing::Test {
 protected:
  void run(const std::string& scene, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{
        scene,      "--size",        std::to_string(kWidth) + "x" + std::to_string(kHeight),
        "--panels", "--log-widgets", "--validation",
        "--json",   "r.json"};
    words.insert(words.end(), more.begin(), more.end());
    program_.emplace(desktop_, folder_.path(), words);
    ASSERT_TRUE(program_->wait_for_window()) << program_->error();
  }
  void use_all() {
    while (const WidgetLine* widget = next()) {
      use(*widget);
      if (!program_->runs() || HasFatalFailure()) break;
    }
    ASSERT_TRUE(program_->runs()) << program_->error();
  }
  void expect_silent_end() {
    program_->close();
    EXPECT_EQ(program_->wait(), 0) << program_->error();
    const auto report = read_json(folder_.path() / "r.json");
    ASSERT_TRUE(report.is_object());
    EXPECT_TRUE(report.at("validation_messages").empty()) << report.at("validation_messages").dump();
  }

  // The list of widgets, each of which has an id of its own: two of one id abort the program at a click.
  const std::vector<WidgetLine>& widgets() {
    const auto& all = program_->widgets();
    std::set<std::string> ids;
    for (const WidgetLine& widget : all) {
      EXPECT_TRUE(ids.insert(widget.id).second) << widget.kind << " " << widget.label;
      kinds_[widget.kind].insert(widget.label);
    }
    return all;
  }

  // The widget to use next. A popup hides all others; in its file list folders come first, then the way back.
  const WidgetLine* next() {
    const auto& all = widgets();
    const bool popup = std::any_of(all.begin(), all.end(), [](const auto& w) { return w.in_popup; });
    const WidgetLine* best = nullptr;
    const auto rank = [](const WidgetLine& w) {
      return w.label == "../" ? 1 : w.label.ends_with("/") ? 0 : 2;
    };
    for (const WidgetLine& widget : all) {
      if (widget.in_popup != popup || skipped_.contains(widget.label)) continue;
      // What is folded is unfolded, even if that was its first use.
      if (done_.contains(widget.id) && widget.kind != "closed") continue;
      if (!best || rank(widget) < rank(*best)) best = &widget;
    }
    if (best || !popup) return best;
    click(kBesideThePanels, 1);  // closes the popup
    return next();
  }

  void click(glm::ivec2 place, unsigned button) {
    program_->place_mouse(place.x, place.y);
    program_->wait_for_frames(2);
    program_->click(button);
    program_->wait_for_frames(5);
  }

  // Turns the wheel until a widget is in view.
  std::optional<WidgetLine> show(const std::string& id) {
    for (int turns = 0; turns < 200 && program_->runs(); ++turns) {
      const auto& all = widgets();
      const auto found = std::find_if(all.begin(), all.end(), [&](const auto& w) { return w.id == id; });
      if (found == all.end()) return std::nullopt;
      if (found->reachable) return *found;
      program_->place_mouse(static_cast<int>(kWidth) - 60, static_cast<int>(kHeight) / 2);
      program_->click(found->low_px.y > static_cast<int>(kHeight) / 2 ? kWheelDown : kWheelUp);
      program_->wait_for_frames(3);
    }
    return std::nullopt;
  }

  void use(WidgetLine widget) {
    done_.insert(widget.id);
    const auto shown = show(widget.id);
    ASSERT_TRUE(shown) << widget.kind << " " << widget.label << " is never in view";
    const glm::ivec2 size = shown->high_px - shown->low_px;
    click(shown->low_px + size / 2, 1);
    if (widget.kind == "text")
      for (const unsigned long key : {XK_x, XK_BackSpace, XK_a, XK_comma, XK_Return}) {
        program_->tap(key);
        program_->wait_for_frames(2);
      }
    if (widget.kind == "picker")
      for (int y = 1; y < 8; ++y)
        for (int x = 1; x < 4; ++x) click(shown->low_px + size * glm::ivec2(x, y) / glm::ivec2(4, 8), 1);
    // Restores what sliders changed, so that the level remains as it is.
    if (widget.kind == "slider" || widget.kind == "drag") click(shown->low_px + size / 2, 3);
    const auto& all = widgets();
    const bool is_gone =
        std::none_of(all.begin(), all.end(), [&](const auto& w) { return w.id == widget.id; });
    if (program_->widget_uses(widget.id) == 0 && is_gone) {
      done_.erase(widget.id);  // a click before removed it; it takes its own when it is there again
      return;
    }
    EXPECT_GT(program_->widget_uses(widget.id), 0u) << widget.kind << " " << widget.label << " took no click";
  }

  cli::WorkFolder folder_;
  Desktop desktop_;
  std::optional<Program> program_;
  std::set<std::string> done_;
  std::set<std::string> skipped_;  ///< Labels.
  std::map<std::string, std::set<std::string>> kinds_;
};

TEST_F(WidgetsTest, EveryWidgetOfEveryPanelTakesAClick) {
  write_busy_room(folder_);
  // Unlit by the first volume's heat, whose lights take a software rasterizer half of each frame.
  std::string room = read_text_file(folder_.path() / "busy.toml").value_or_throw();
  room.insert(room.find("kelvin = "), "emission = 0.0\n");
  folder_.write("busy.toml", room);
  run("busy.toml", {"--quality", "smallest"});
  program_->place_mouse(kBesideThePanels.x, kBesideThePanels.y);
  program_->click(1);  // smoke, so that there is something to change
  use_all();

  // The log misses no kind of widget that the panels have.
  EXPECT_EQ(kinds_["open"].size(), 18u);  // 11 sections, 7 names of parts of them
  EXPECT_EQ(kinds_["text"].size(), 2u);
  EXPECT_TRUE(kinds_["choice"].contains("../"));
  EXPECT_TRUE(kinds_["choice"].contains("walls_diffuse.png"));
  EXPECT_GE(kinds_["button"].size(), 8u);
  for (const char* kind : {"swatch", "picker", "slider", "drag", "checkbox", "radio", "combo", "canvas"})
    EXPECT_FALSE(kinds_[kind].empty()) << kind;
  RecordProperty("widgets", std::to_string(done_.size()));
  EXPECT_GT(done_.size(), 100u);

  expect_silent_end();
}

TEST_F(WidgetsTest, EveryWidgetOfATankTakesAClick) {
  write_tank(folder_);
  // The list of palettes is as long as there are palettes (palette_list_test.cpp), and packing ends soon.
  skipped_ = {"Palette", "Stop here"};
  run("tank.toml");
  ASSERT_TRUE(program_->wait_for_best()) << program_->error();
  use_all();
  EXPECT_GE(kinds_["open"].size(), 10u);  // 8 sections, 2 lights
  EXPECT_GE(kinds_["button"].size(), 17u);
  for (const char* kind : {"swatch", "picker", "slider", "drag", "checkbox", "radio", "combo", "choice"})
    EXPECT_FALSE(kinds_[kind].empty()) << kind;
  EXPECT_GT(done_.size(), 70u);
  expect_silent_end();
}

// Else a widget would not be in the log.
TEST(WidgetsSourceTest, OnlyWidgetsCppCallsWidgetsOfImGui) {
  const std::regex widget(
      "ImGui::(\\w*Button|Checkbox\\w*|CollapsingHeader|TreeNode\\w*|Selectable|Input\\w+|\\w*Combo|\\w*"
      "Slider\\w*|"
      "Drag\\w+|Color(Edit|Picker|Button)\\w*|MenuItem|TabItem\\w*|ListBox\\w*)\\(");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(BRUME_SOURCE_DIR "/apps/viewer")) {
    if (entry.path().extension() != ".cpp" || entry.path().filename() == "widgets.cpp") continue;
    const std::string text = read_text_file(entry.path()).value_or_throw();
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, widget)) << entry.path() << ": " << found.str();
    ++files;
  }
  EXPECT_GT(files, 10);
}

}  // namespace
}  // namespace brume::viewer
