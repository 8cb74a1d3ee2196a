// The help: all keys, in groups, as large as the window allows.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/viewer/ui_parts.hpp"

namespace brume::viewer {
namespace {

constexpr float kLeastScale = 0.72f;
const ImVec4 kKey(1, 0.8f, 0.5f, 1);

/// The rows of some groups, [first, end).
struct Column {
  std::size_t first = 0, end = 0;
};

/// One column of all rows.
std::vector<Column> one_column(const std::vector<HelpRow>& rows) {
  return {{0, rows.size()}};
}

/// Two columns, split before the group that makes the longer one shortest.
std::vector<Column> two_columns(const std::vector<HelpRow>& rows) {
  std::size_t best = rows.size();
  const auto longer = [&](std::size_t split) { return std::max(split, rows.size() - split); };
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (rows[i].group != rows[i - 1].group && longer(i) < longer(best)) best = i;
  return {{0, best}, {best, rows.size()}};
}

/// Size of a column at the usual size of the text [px].
glm::vec2 size_of(const std::vector<HelpRow>& rows, const Column& column, float key_width) {
  const float row = ImGui::GetTextLineHeightWithSpacing();
  glm::vec2 size(0);
  for (std::size_t i = column.first; i < column.end; ++i) {
    size.x = std::max(size.x, ImGui::CalcTextSize(rows[i].does.c_str()).x);
    size.y += i == column.first || rows[i].group != rows[i - 1].group ? 2.3f * row : row;
  }
  return {size.x + key_width + 12, size.y};
}

void lay_out_column(const std::vector<HelpRow>& rows, const Column& column, float key_width) {
  ImGui::BeginGroup();
  for (std::size_t i = column.first; i < column.end; ++i) {
    if (i == column.first || rows[i].group != rows[i - 1].group) {
      if (i != column.first) ImGui::Dummy(ImVec2(0, 0.15f * ImGui::GetTextLineHeight()));
      ImGui::TextDisabled("%s", name_of(rows[i].group));
    }
    ImGui::TextColored(kKey, "%s", rows[i].keys.c_str());
    ImGui::SameLine(key_width);
    ImGui::TextUnformatted(rows[i].does.c_str());
  }
  ImGui::EndGroup();
}

}  // namespace

void lay_out_help(KeyMap map, const char* note) {
  const std::vector<HelpRow> rows = help_rows(map);
  float key_width = 0;
  for (const HelpRow& row : rows) key_width = std::max(key_width, ImGui::CalcTextSize(row.keys.c_str()).x);
  key_width += 12;

  // One column or two, whichever allows the larger text in this window.
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const glm::vec2 room = glm::vec2(display.x, display.y) - 5 * kMargin;
  const auto scale_of = [&](const std::vector<Column>& columns) {
    glm::vec2 size(0);
    for (const Column& column : columns) {
      const glm::vec2 part = size_of(rows, column, key_width);
      size = {size.x + part.x + 24, std::max(size.y, part.y)};
    }
    return std::clamp(std::min(room.x / size.x, room.y / (size.y + 24)), kLeastScale, 1.0f);
  };
  const std::vector<Column> one = one_column(rows), two = two_columns(rows);
  const auto& columns = scale_of(two) > scale_of(one) ? two : one;
  const float scale = scale_of(columns);

  // A window too small for that is scrolled by the wheel.
  ImGui::SetNextWindowPos(ImVec2(0.5f * display.x, 0.5f * display.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(display.x, display.y));
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::Begin("help", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav);
  ImGui::SetWindowFontScale(scale);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i > 0) ImGui::SameLine(0, 24);
    lay_out_column(rows, columns[i], scale * key_width);
  }
  ImGui::TextDisabled("%s", note);
  ImGui::End();
}

}  // namespace brume::viewer
