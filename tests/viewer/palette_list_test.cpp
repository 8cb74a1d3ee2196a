// The list of palettes in a window of no screen: frames are laid out, and what they draw is read.
#include "apps/viewer/palette_list.hpp"

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>

#include "apps/viewer/widgets.hpp"

namespace brume::viewer {
namespace {

class PaletteListTest : public testing::Test {
 protected:
  PaletteListTest() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {600, 800};
    io.DeltaTime = 1.0f / 60;
    io.IniFilename = nullptr;
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&texels, &width, &height);  // without which no frame begins
    set_widget_log(&log_);
    frame();
    frame();  // A list knows the size of its window from its second frame on.
  }
  ~PaletteListTest() override { ImGui::DestroyContext(); }

  /// Lays out a frame; whether the choice changed in it.
  bool frame() {
    log_.begin_frame();
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({600, 800});
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
    const bool changed = lay_out_palettes(state_, palettes_, chosen_, 400);
    ImGui::End();
    ImGui::Render();
    return changed;
  }

  std::vector<Widget> of_kind(const std::string& kind) const {
    std::vector<Widget> found;
    for (const Widget& widget : log_.widgets())
      if (widget.kind == kind) found.push_back(widget);
    return found;
  }

  const Widget* widget(const std::string& label) const {
    for (const Widget& widget : log_.widgets())
      if (widget.label == label) return &widget;
    return nullptr;
  }

  /// Presses and releases the mouse at a place; whether the choice changed.
  bool click(glm::vec2 place_px) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {place_px.x, place_px.y};
    bool changed = frame();
    for (const bool down : {true, false}) {
      io.MouseDown[0] = down;
      changed = frame() || changed;
    }
    return changed;
  }

  std::span<const palettes::Palette> palettes_ = palettes::built_in();
  WidgetLog log_;
  PaletteListState state_;
  PaletteSelection chosen_;
};

TEST_F(PaletteListTest, LaysOutOnlyWhatIsVisible) {
  EXPECT_EQ(state_.found.size(), palettes_.size()) << "64 colours stand for any number";
  const std::size_t rows = of_kind("canvas").size();
  EXPECT_GT(rows, 5u);
  // 400 pixels of rows that are at least as high as their text, 13 pixels, and one more at each end.
  EXPECT_LE(rows, 400u / 13 + 2);
  // Rows of at most 64 patches of 4 corners, and less than that for all else.
  EXPECT_LT(ImGui::GetDrawData()->TotalVtxCount, 4 * 64 * 40);
}

TEST_F(PaletteListTest, AClickChoosesARow) {
  const Widget row = of_kind("canvas").at(3);
  EXPECT_TRUE(click(0.5f * (row.low_px + row.high_px)));
  EXPECT_EQ(chosen_.name, row.label);
  EXPECT_FALSE(click(0.5f * (row.low_px + row.high_px))) << "it was chosen already";
  EXPECT_FALSE(frame());
}

TEST_F(PaletteListTest, SearchesWhenTheSettingsChange) {
  state_.words = "viridis";
  frame();
  EXPECT_EQ(state_.found, palettes::search(palettes_, filter_of(state_)));
  EXPECT_FALSE(state_.found.empty());
  EXPECT_LT(state_.found.size(), 20u);
  EXPECT_NE(widget("viridis"), nullptr) << "a row";
  state_.words = "no such words";
  frame();
  EXPECT_TRUE(of_kind("canvas").empty());
  state_.words.clear();
  state_.least_colors = 5;
  state_.most_colors = 6;
  state_.has_hue = true;
  state_.hue = 0;
  frame();
  EXPECT_FALSE(state_.found.empty());
  for (const std::uint32_t i : state_.found) {
    EXPECT_GE(palettes_[i].colors.size(), 5u);
    EXPECT_LE(palettes_[i].colors.size(), 6u);
  }
  // The same settings do not search again: a result that is put there stays.
  state_.found = {7};
  frame();
  EXPECT_EQ(state_.found, std::vector<std::uint32_t>{7});
}

TEST_F(PaletteListTest, HasWidgetsForAllSettings) {
  for (const char* label : {"##palette words", "##fewest colours", "##most colours", "##has hue",
                            "##palette low", "##palette high"})
    EXPECT_NE(widget(label), nullptr) << label;
  EXPECT_EQ(widget("##hue"), nullptr);
  const Widget* const box = widget("##has hue");
  click(0.5f * (box->low_px + box->high_px));
  EXPECT_TRUE(state_.has_hue);
  frame();
  EXPECT_NE(widget("##hue"), nullptr);
}

TEST_F(PaletteListTest, SlidersChangeTheRange) {
  const Widget low = *widget("##palette low");
  EXPECT_TRUE(
      click({low.low_px.x + 0.25f * (low.high_px.x - low.low_px.x), 0.5f * (low.low_px.y + low.high_px.y)}));
  // The knob is a few pixels wide, so that the ends are not those of the slider.
  EXPECT_NEAR(chosen_.low, 0.25f, 0.03f);
  EXPECT_EQ(chosen_.high, 1);
}

/// How many corners of the last frame have a colour.
std::size_t corners_of(ImU32 color) {
  std::size_t count = 0;
  const ImDrawData& data = *ImGui::GetDrawData();
  for (int i = 0; i < data.CmdListsCount; ++i)
    for (const ImDrawVert& vertex : data.CmdLists[i]->VtxBuffer) count += vertex.col == color ? 1 : 0;
  return count;
}

TEST_F(PaletteListTest, DimsColoursOutsideOfTheRange) {
  const std::vector<palettes::Palette> one{
      {"one", "", palettes::Kind::qualitative, {{255, 1, 2}, {3, 4, 255}}}};
  palettes_ = one;
  frame();
  const ImU32 veil = ImGui::GetColorU32(ImGuiCol_WindowBg, 0.8f);
  EXPECT_EQ(corners_of(IM_COL32(255, 1, 2, 255)), 4u);
  EXPECT_EQ(corners_of(IM_COL32(3, 4, 255, 255)), 4u);
  const std::size_t others = corners_of(veil);
  chosen_ = {"one", 0.2f, 0.6f};
  frame();
  EXPECT_EQ(corners_of(veil), others + 8) << "one veil at each end";
  chosen_ = {"one", 0.6f, 0};
  frame();
  EXPECT_EQ(corners_of(veil), others + 4) << "backwards";
  palettes_ = palettes::built_in();
}

TEST_F(PaletteListTest, TheLastRowsAreReachedByScrolling) {
  const Widget row = of_kind("canvas").at(3);
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = {row.low_px.x + 5, row.low_px.y + 5};
  frame();
  // A notch is five lines or less of a list; more than there are palettes.
  for (std::size_t i = 0; i < palettes_.size(); ++i) {
    io.MouseWheel = -5;
    frame();
  }
  EXPECT_EQ(of_kind("canvas").back().label, palettes_.back().name);
}

}  // namespace
}  // namespace brume::viewer
