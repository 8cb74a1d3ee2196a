#include "apps/viewer/curve_editor.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/color_space.hpp>

#include "apps/viewer/option_panel.hpp"
#include "apps/viewer/widgets.hpp"

namespace brume::viewer {
namespace {

constexpr float kHeight = 120, kBarHeight = 14;  // [px]
constexpr float kPointRadius = 4, kReach = 9;    // [px]
constexpr ImU32 kBackground = IM_COL32(28, 32, 40, 255), kBars = IM_COL32(70, 82, 100, 255),
                kLine = IM_COL32(250, 189, 102, 255), kArea = IM_COL32(250, 189, 102, 40);

glm::vec2 to_vec(ImVec2 p) {
  return {p.x, p.y};
}
ImVec2 to_im(glm::vec2 p) {
  return {p.x, p.y};
}

/// Where places of a curve are on the display.
struct Area {
  glm::vec2 low, high;  // corners of the rectangle [px]
  glm::vec2 size() const { return high - low; }
  glm::vec2 on_display(glm::vec2 place) const {
    return {low.x + place.x * size().x, high.y - place.y * size().y};
  }
  glm::vec2 place(glm::vec2 p) const { return {(p.x - low.x) / size().x, (high.y - p.y) / size().y}; }
};

void draw_histogram(ImDrawList& list, const Area& area, const CurveBackdrop& backdrop) {
  const auto& bins = backdrop.histogram;
  if (bins.empty()) return;
  const double most = std::log1p(static_cast<double>(*std::ranges::max_element(bins)));
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const auto end_of = [&](std::size_t bin) {
      const float part = static_cast<float>(bin) / static_cast<float>(bins.size());
      return std::clamp(glm::mix(backdrop.histogram_range.x, backdrop.histogram_range.y, part), 0.0f, 1.0f);
    };
    const auto tall = static_cast<float>(std::log1p(static_cast<double>(bins[i])) / std::max(most, 1e-9));
    if (tall > 0 && end_of(i) < end_of(i + 1))
      list.AddRectFilled(to_im(area.on_display({end_of(i), 0.95f * tall})),
                         to_im(area.on_display({end_of(i + 1), 0})), kBars);
  }
}

void draw_curve(ImDrawList& list, const Area& area, std::span<const scene::OpacityPoint> curve) {
  std::vector<glm::vec2> places{{0, curve.front().opacity}};
  for (const scene::OpacityPoint& point : curve) places.emplace_back(point.at, point.opacity);
  places.emplace_back(1, curve.back().opacity);
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const glm::vec2 a = area.on_display(places[i]), b = area.on_display(places[i + 1]);
    list.AddQuadFilled(to_im({a.x, area.high.y}), to_im(a), to_im(b), to_im({b.x, area.high.y}), kArea);
    list.AddLine(to_im(a), to_im(b), kLine, 1.5f);
  }
  for (const scene::OpacityPoint& point : curve)
    list.AddCircleFilled(to_im(area.on_display({point.at, point.opacity})), kPointRadius, kLine);
}

void draw_bar(const Area& area, const scene::ColorMap& map) {
  constexpr int kParts = 64;
  const auto color_of = [&](int part) {
    const glm::vec3 srgb(glm::convertLinearToSRGB(scene::color_at(map, double(part) / kParts)));
    return ImGui::GetColorU32(ImVec4(srgb.r, srgb.g, srgb.b, 1));
  };
  for (int i = 0; i < kParts; ++i) {
    const ImU32 left = color_of(i), right = color_of(i + 1);
    const glm::vec2 a = area.on_display({float(i) / kParts, 1}),
                    b = area.on_display({float(i + 1) / kParts, 0});
    ImGui::GetWindowDrawList()->AddRectFilledMultiColor(to_im(a), to_im(b), left, right, right, left);
  }
}

glm::vec2 limited(glm::vec2 place) {
  return glm::clamp(place, glm::vec2(0), glm::vec2(1));
}

}  // namespace

std::optional<std::size_t> point_near(std::span<const scene::OpacityPoint> curve, glm::vec2 place,
                                      glm::vec2 reach) {
  std::optional<std::size_t> nearest;
  float least = 1;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const glm::vec2 off = glm::abs(glm::vec2(curve[i].at, curve[i].opacity) - place) / reach;
    const float distance = std::max(off.x, off.y);
    if (distance > least || (nearest && distance == least)) continue;
    least = distance;
    nearest = i;
  }
  return nearest;
}

std::optional<std::size_t> add_point(std::vector<scene::OpacityPoint>& curve, glm::vec2 place) {
  if (curve.size() >= scene::kMostPoints) return std::nullopt;
  const glm::vec2 p = limited(place);
  const auto behind = std::ranges::upper_bound(curve, p.x, {}, &scene::OpacityPoint::at);
  const auto index = static_cast<std::size_t>(behind - curve.begin());
  curve.insert(behind, {p.x, p.y});
  return index;
}

void move_point(std::vector<scene::OpacityPoint>& curve, std::size_t point, glm::vec2 place) {
  const glm::vec2 p = limited(place);
  const float low = point > 0 ? curve[point - 1].at : 0.0f;
  const float high = point + 1 < curve.size() ? curve[point + 1].at : 1.0f;
  curve[point] = {std::clamp(p.x, low, high), p.y};
}

bool remove_point(std::vector<scene::OpacityPoint>& curve, std::size_t point) {
  if (curve.size() <= 2) return false;
  curve.erase(curve.begin() + static_cast<std::ptrdiff_t>(point));
  return true;
}

bool edit_curve(const char* label, std::vector<scene::OpacityPoint>& curve, const CurveBackdrop& backdrop) {
  canvas(label, kHeight);
  const Area area{to_vec(ImGui::GetItemRectMin()), to_vec(ImGui::GetItemRectMax())};
  const glm::vec2 place = area.place(to_vec(ImGui::GetIO().MousePos)), reach = kReach / area.size();
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID held = ImGui::GetID("held");
  bool changed = false;

  // A click holds a point, of its own or a new one, until the button is up.
  if (ImGui::IsItemClicked(ImGuiMouseButton_Left)) {
    auto point = point_near(curve, place, reach);
    if (!point) {
      point = add_point(curve, place);
      changed = point.has_value();
    }
    storage.SetInt(held, point ? static_cast<int>(*point) : -1);
  }
  const auto point = static_cast<std::size_t>(storage.GetInt(held, -1));
  if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1) && point < curve.size()) {
    const scene::OpacityPoint before = curve[point];
    move_point(curve, point, place);
    changed = changed || curve[point] != before;
  }
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right))
    if (const auto near = point_near(curve, place, reach)) changed = remove_point(curve, *near) || changed;

  // Drawing.
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(to_im(area.low), to_im(area.high), kBackground, 3);
  draw_histogram(list, area, backdrop);
  draw_curve(list, area, curve);
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) {
    const float value = glm::mix(backdrop.values.x, backdrop.values.y, std::clamp(place.x, 0.0f, 1.0f));
    ImGui::SetTooltip("value %.4g: opacity %.3g\nclick: a point; drag: move it; right click: remove it",
                      double{value}, scene::opacity_at(curve, double{place.x}));
  }
  return changed;
}

std::optional<std::size_t> add_color(std::vector<scene::ColorPoint>& points, float at) {
  if (points.size() >= scene::kMostPoints) return std::nullopt;
  at = std::clamp(at, 0.0f, 1.0f);
  const glm::vec3 color(scene::color_at({"", points}, double{at}));
  const auto behind = std::ranges::upper_bound(points, at, {}, &scene::ColorPoint::at);
  const auto index = static_cast<std::size_t>(behind - points.begin());
  points.insert(behind, {at, color});
  return index;
}

void move_color(std::vector<scene::ColorPoint>& points, std::size_t point, float at) {
  const float low = point > 0 ? points[point - 1].at : 0.0f;
  const float high = point + 1 < points.size() ? points[point + 1].at : 1.0f;
  points[point].at = std::clamp(at, low, high);
}

bool remove_color(std::vector<scene::ColorPoint>& points, std::size_t point) {
  if (points.size() <= 2) return false;
  points.erase(points.begin() + static_cast<std::ptrdiff_t>(point));
  return true;
}

std::vector<scene::ColorPoint> points_of(const scene::ColorMap& map) {
  if (map.name.empty()) return map.points;
  constexpr int kPoints = 9;
  std::vector<scene::ColorPoint> points;
  for (int i = 0; i < kPoints; ++i) {
    const double at = double(i) / (kPoints - 1);
    points.push_back({static_cast<float>(at), glm::vec3(scene::color_at(map, at))});
  }
  return points;
}

void draw_color_map(const scene::ColorMap& map) {
  const glm::vec2 low = to_vec(ImGui::GetCursorScreenPos());
  const float width = ImGui::GetContentRegionAvail().x;
  draw_bar({low, low + glm::vec2(width, kBarHeight)}, map);
  ImGui::Dummy(ImVec2(width, kBarHeight));
}

bool edit_color_map(const char* label, std::vector<scene::ColorPoint>& points) {
  ImGui::PushID(label);
  canvas(label, kBarHeight + 2 * kPointRadius);
  const Area area{to_vec(ImGui::GetItemRectMin()), to_vec(ImGui::GetItemRectMax())};
  const float at = area.place(to_vec(ImGui::GetIO().MousePos)).x, reach = kReach / area.size().x;
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID held = ImGui::GetID("held");
  const auto near = [&]() -> std::optional<std::size_t> {
    const auto nearest = std::ranges::min_element(
        points, {}, [&](const scene::ColorPoint& point) { return std::abs(point.at - at); });
    if (std::abs(nearest->at - at) > reach) return std::nullopt;
    return static_cast<std::size_t>(nearest - points.begin());
  };
  bool changed = false;

  // As in a curve; the point that is held remains chosen.
  if (ImGui::IsItemClicked(ImGuiMouseButton_Left)) {
    auto point = near();
    if (!point) {
      point = add_color(points, at);
      changed = point.has_value();
    }
    if (point) storage.SetInt(held, static_cast<int>(*point));
  }
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right))
    if (const auto point = near()) changed = remove_color(points, *point) || changed;
  const std::size_t chosen = std::min(static_cast<std::size_t>(storage.GetInt(held, 0)), points.size() - 1);
  if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1)) {
    const float before = points[chosen].at;
    move_color(points, chosen, at);
    changed = changed || points[chosen].at != before;
  }
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
    ImGui::SetTooltip("click: a colour, whose patch is below; drag: move it; right click: remove it");

  // Drawing, and the colour.
  draw_bar({area.low, area.high - glm::vec2(0, 2 * kPointRadius)}, {"", points});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::vec2 tip(area.on_display({points[i].at, 0}).x, area.high.y - 2 * kPointRadius);
    const glm::vec2 side(kPointRadius, 0), down(0, 2 * kPointRadius);
    ImGui::GetWindowDrawList()->AddTriangleFilled(to_im(tip), to_im(tip + down - side),
                                                  to_im(tip + down + side), i == chosen ? kLine : kBars);
  }
  glm::vec3 color = points[chosen].color;
  if (color_patch(color)) {
    points[chosen].color = glm::clamp(color, glm::vec3(0), glm::vec3(1));
    changed = true;
  }
  ImGui::SameLine();
  ImGui::TextDisabled("colour at %.3g of the range", double{points[chosen].at});
  ImGui::PopID();
  return changed;
}

}  // namespace brume::viewer
