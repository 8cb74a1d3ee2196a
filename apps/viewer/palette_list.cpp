#include "apps/viewer/palette_list.hpp"

#include <imgui.h>

#include <algorithm>

#include "apps/viewer/widgets.hpp"
#include "palettes/sample.hpp"

namespace brume::viewer {
namespace {

constexpr float kLabelPart = 0.42f;        // fraction of the window's width
constexpr float kStripPart = 0.55f;        // fraction of a row's width
constexpr std::size_t kMostSegments = 32;  // in a strip: finer than a row can show

/// The label of a row of settings, before its widget.
void begin_setting(const char* label) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label);
  ImGui::SameLine(kLabelPart * ImGui::GetWindowWidth());
  ImGui::SetNextItemWidth(-1);
}

ImU32 packed_color(const glm::u8vec3& color) {
  return IM_COL32(color.x, color.y, color.z, 255);
}

void draw_gradient(ImDrawList& draw, const palettes::Palette& palette, ImVec2 low, ImVec2 high) {
  const std::size_t segments = std::min(kMostSegments, 4 * (palette.colors.size() - 1));
  const auto count = static_cast<float>(segments);
  ImU32 left = packed_color(palettes::sample_byte(palette, 0));
  for (std::size_t i = 0; i < segments; ++i) {
    const float begin = static_cast<float>(i) / count, end = static_cast<float>(i + 1) / count;
    const ImU32 right = packed_color(palettes::sample_byte(palette, end));
    draw.AddRectFilledMultiColor({low.x + begin * (high.x - low.x), low.y},
                                 {low.x + end * (high.x - low.x), high.y}, left, right, right, left);
    left = right;
  }
}

void draw_patches(ImDrawList& draw, const palettes::Palette& palette, ImVec2 low, ImVec2 high) {
  const std::size_t patches = std::min<std::size_t>(palette.colors.size(), kMostShownColors);
  const auto count = static_cast<float>(patches);
  for (std::size_t i = 0; i < patches; ++i) {
    const float begin = static_cast<float>(i) / count, end = static_cast<float>(i + 1) / count;
    const glm::u8vec3 color =
        palettes::sample_byte(palette, 0.5 * double{begin} + 0.5 * double{end}, palettes::Space::nearest);
    draw.AddRectFilled({low.x + begin * (high.x - low.x), low.y}, {low.x + end * (high.x - low.x), high.y},
                       packed_color(color));
  }
}

/// The colours of a palette, those outside of the range under a veil, and a frame around the range.
void draw_strip(const palettes::Palette& palette, const PaletteSelection& chosen, ImVec2 low, ImVec2 high) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  if (palette.kind == palettes::Kind::qualitative) {
    draw_patches(draw, palette, low, high);
  } else {
    draw_gradient(draw, palette, low, high);
  }
  const ImU32 veil = ImGui::GetColorU32(ImGuiCol_WindowBg, 0.8f);
  const auto [first, last] = std::minmax(chosen.low, chosen.high);
  const float begin = low.x + first * (high.x - low.x), end = low.x + last * (high.x - low.x);
  if (first > 0) draw.AddRectFilled(low, {begin, high.y}, veil);
  if (last < 1) draw.AddRectFilled({end, low.y}, high, veil);
  if (palette.name == chosen.name)
    draw.AddRect({begin - 1, low.y - 1}, {end + 1, high.y + 1}, ImGui::GetColorU32(ImGuiCol_Text));
}

/// A row; true: it was clicked.
bool palette_row(const palettes::Palette& palette, const PaletteSelection& chosen) {
  const float height = ImGui::GetFrameHeight();
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float width = std::max(ImGui::GetContentRegionAvail().x, 16.0f);
  const bool is_clicked = canvas(palette.name.c_str(), height);
  const bool is_hovered = ImGui::IsItemHovered();
  if (is_hovered)
    ImGui::SetTooltip("%s: %zu colours of %s", palette.name.c_str(), palette.colors.size(),
                      palette.collection.empty() ? "a file" : palette.collection.c_str());
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  if (is_hovered || palette.name == chosen.name)
    draw.AddRectFilled(low, {low.x + width, low.y + height},
                       ImGui::GetColorU32(is_hovered ? ImGuiCol_HeaderHovered : ImGuiCol_Header));
  const float strip = kStripPart * width;
  draw_strip(palette, chosen, {low.x + 2, low.y + 2}, {low.x + strip, low.y + height - 2});
  const float text_y = low.y + 0.5f * (height - ImGui::GetTextLineHeight());
  draw.AddText({low.x + strip + ImGui::GetStyle().ItemInnerSpacing.x, text_y},
               ImGui::GetColorU32(ImGuiCol_Text), palette.name.c_str());
  return is_clicked;
}

void lay_out_filters(PaletteListState& state) {
  begin_setting("search");
  text_field("##palette words", &state.words);
  begin_setting("fewest colours");
  if (slider("##fewest colours", &state.least_colors, 2, kMostShownColors, ImGuiSliderFlags_AlwaysClamp))
    state.most_colors = std::max(state.most_colors, state.least_colors);
  begin_setting("most colours");
  if (slider("##most colours", &state.most_colors, 2, kMostShownColors, ImGuiSliderFlags_AlwaysClamp))
    state.least_colors = std::min(state.least_colors, state.most_colors);
  begin_setting("hue");
  checkbox("##has hue", &state.has_hue);
  if (!state.has_hue) return;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  slider("##hue", &state.hue, 0, 360, "%.0f degrees");
}

/// Whether what the rows choose changed.
bool lay_out_rows(const PaletteListState& state, std::span<const palettes::Palette> palettes,
                  PaletteSelection& chosen, float height) {
  bool changed = false;
  if (ImGui::BeginChild("##palettes", {0, height}, true)) {
    ImGuiListClipper rows;
    rows.Begin(static_cast<int>(state.found.size()), ImGui::GetFrameHeightWithSpacing());
    while (rows.Step())
      for (int i = rows.DisplayStart; i < rows.DisplayEnd; ++i) {
        const palettes::Palette& palette = palettes[state.found[static_cast<std::size_t>(i)]];
        if (!palette_row(palette, chosen)) continue;
        changed = changed || palette.name != chosen.name;
        chosen.name = palette.name;
      }
  }
  ImGui::EndChild();
  return changed;
}

}  // namespace

palettes::Filter filter_of(const PaletteListState& state) {
  palettes::Filter filter;
  filter.words = state.words;
  filter.least_colors = state.least_colors;
  filter.most_colors = state.most_colors == kMostShownColors ? palettes::kMostColors : state.most_colors;
  if (state.has_hue) filter.hue = double{state.hue};
  return filter;
}

bool lay_out_palettes(PaletteListState& state, std::span<const palettes::Palette> palettes,
                      PaletteSelection& chosen, float height) {
  ImGui::PushID("palette list");
  // What to list
  lay_out_filters(state);
  const palettes::Filter filter = filter_of(state);
  if (state.searched != filter || state.searched_count != palettes.size()) {
    state.found = palettes::search(palettes, filter);
    state.searched = filter;
    state.searched_count = palettes.size();
  }
  ImGui::TextDisabled("%zu of %zu palettes", state.found.size(), palettes.size());
  // The list and the range
  bool changed = lay_out_rows(state, palettes, chosen, height);
  begin_setting("range begins");
  changed = slider("##palette low", &chosen.low, 0, 1, "%.3f") || changed;
  begin_setting("range ends");
  changed = slider("##palette high", &chosen.high, 0, 1, "%.3f") || changed;
  ImGui::PopID();
  return changed;
}

}  // namespace brume::viewer
