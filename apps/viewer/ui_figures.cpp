// The section of figures: times of the passes, memory, and the state of the simulation.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "apps/viewer/screen.hpp"
#include "apps/viewer/ui_parts.hpp"
#include "sim/cloud.hpp"

namespace brume::viewer {
namespace {

// Colours of the passes in the graph, in frame order.
constexpr std::array kPassColours{
    IM_COL32(94, 129, 172, 255),  IM_COL32(136, 192, 208, 255), IM_COL32(163, 190, 140, 255),
    IM_COL32(235, 203, 139, 255), IM_COL32(208, 135, 112, 255), IM_COL32(191, 97, 106, 255),
    IM_COL32(180, 142, 173, 255), IM_COL32(229, 233, 240, 255), IM_COL32(143, 188, 187, 255),
    IM_COL32(129, 161, 193, 255), IM_COL32(200, 170, 90, 255),  IM_COL32(120, 140, 90, 255),
    IM_COL32(170, 110, 160, 255), IM_COL32(110, 110, 130, 255)};

ImU32 pass_colour(std::size_t pass) {
  return kPassColours[pass % kPassColours.size()];
}

// GPU times of the last frames as stacked bars, scaled to the slowest frame.
void lay_out_graph(const Figures& figures) {
  const auto& names = figures.pass_names();
  const auto& frames = figures.frames();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::GetContentRegionAvail().x, 110);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, ImVec2(at.x + size.x, at.y + size.y), IM_COL32(20, 22, 28, 255));

  // The newest frame is at the right end.
  double slowest = 1e-3;  // [ms]
  for (const FrameFigures& frame : frames) {
    double sum = 0;
    for (const auto& pass : frame.passes) sum += pass.milliseconds;
    slowest = std::max(slowest, sum);
  }
  const float bar = size.x / static_cast<float>(Figures::kHistory);
  float x = at.x + size.x - bar * static_cast<float>(frames.size());
  for (const FrameFigures& frame : frames) {
    float y = at.y + size.y;
    for (const auto& pass : frame.passes) {
      const auto index =
          static_cast<std::size_t>(std::find(names.begin(), names.end(), pass.name) - names.begin());
      const float height = size.y * static_cast<float>(pass.milliseconds / slowest);
      list.AddRectFilled(ImVec2(x, y - height), ImVec2(x + std::max(bar, 1.0f), y), pass_colour(index));
      y -= height;
    }
    x += bar;
  }

  // The scale.
  char top[32];
  std::snprintf(top, sizeof top, "%.2f ms", slowest);
  list.AddText(ImVec2(at.x + 4, at.y + 2), IM_COL32(230, 230, 230, 255), top);
  ImGui::Dummy(size);
}

void lay_out_times(const Figures& figures) {
  ImGui::TextUnformatted("GPU time by pass [ms]");
  lay_out_graph(figures);
  if (figures.frames().empty() || !ImGui::BeginTable("passes", 4, ImGuiTableFlags_SizingFixedFit)) return;
  for (const auto& pass : figures.frames().back().passes) {
    const auto& names = figures.pass_names();
    const auto index =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), pass.name) - names.begin());
    ImGui::TableNextColumn();
    const ImVec4 colour = ImGui::ColorConvertU32ToFloat4(pass_colour(index));
    ImGui::TextColored(colour, "%.*s", static_cast<int>(pass.name.size()), pass.name.data());
    ImGui::TableNextColumn();
    ImGui::Text("%7.2f  ", pass.milliseconds);
  }
  ImGui::EndTable();
}

void lay_out_state(const Session& session, const Figures& figures, const Status& status) {
  const sim::State& state = session.simulation().world().state();
  constexpr double kMiB = 1024.0 * 1024.0;
  ImGui::Text("%s", status.device.c_str());
  ImGui::Text("simulation: %.3f ms CPU", figures.median(&FrameFigures::tick_ms));
  ImGui::Text("from the input to the image: %.1f ms", figures.median(&FrameFigures::latency_ms));
  ImGui::Text("memory: GPU %.0f MiB, process %.0f MiB", static_cast<double>(status.device_bytes) / kMiB,
              static_cast<double>(resident_bytes()) / kMiB);
  ImGui::Text("tick %u", state.tick);
  sim::for_each_state_list([&](const char* what, auto list) {
    if ((state.*list).empty()) return;
    ImGui::SameLine(0, 0);
    ImGui::Text("; %s %zu", what, (state.*list).size());
  });
  std::uint64_t amount = 0;  // in voxels / 2^20
  for (const sim::LiveCloud& cloud : state.clouds) amount += cloud.cloud->amount(state.tick);
  const double edge = double{session.live().scenario().voxels.grid.layout().voxel_size};
  ImGui::Text("smoke: %.1f m\xc2\xb3, %llu voxels in %u bricks",
              static_cast<double>(amount >> 20) * edge * edge * edge,
              static_cast<unsigned long long>(amount >> 20), session.simulation().volume().slot_count());
}

}  // namespace

void lay_out_figures(const Session& session, const Figures& figures, const Status& status) {
  lay_out_times(figures);
  lay_out_state(session, figures, status);
}

}  // namespace brume::viewer
