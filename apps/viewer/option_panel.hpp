// Panel rows generated from the option structs: scene/options.hpp is the only place that states the key,
// default, unit and range of a number.
#pragma once

#include <imgui.h>

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "scene/options.hpp"

namespace brume::viewer {

/// The part of a row's width that its label takes.
constexpr float kLabelWidth = 0.42f;

/// The label of a setting.
std::string label_of(const scene::OptionInfo& info);

// One row per number, or colour: a slider with unit and tooltip; a right click restores the value of the
// file, Ctrl+click types a value. Values stay in their range. The labels of changed values are marked.
// Returns whether the value changed.
bool option_row(const scene::OptionInfo& info, float& value, float file);
bool option_row(const scene::OptionInfo& info, std::uint32_t& value, std::uint32_t file);
bool option_row(const scene::OptionInfo& info, glm::vec3& value, glm::vec3 file);
bool option_row(const scene::OptionInfo& info, std::optional<float>& value, std::optional<float> file);
/// The same for a range that no slider resolves: dragged, the faster the larger it is.
bool drag_row(const scene::OptionInfo& info, float& value, float file);
/// The same for a vector that is no colour.
bool vector_row(const scene::OptionInfo& info, glm::vec3& value, glm::vec3 file);
/// The same for a number of voxels, shown as their volume.
bool volume_row(const scene::OptionInfo& info, std::uint32_t& voxels, std::uint32_t file, float voxel_size);

/// Lays out the label of a row that has widgets of its own.
void begin_row(const char* label, const char* about = nullptr);

/// A patch of a linear colour in [0, 1] whose popup edits it. Returns whether it changed.
bool color_patch(glm::vec3& color);

/// Calls `row` with the description of each number that `visit`, one of the visit_* functions, visits, the
/// member, and its value in `file`, with which the document began. Returns whether a row changed its member.
template <typename Options, typename Visit, typename Row>
bool each_row(Options& options, const Options& file, Visit visit, Row row) {
  bool changed = false;
  // Both visits are in the same order, so that index i is the file's value of member i.
  std::vector<const void*> initial;
  visit(file, [&](const auto&, auto& member) { initial.push_back(&member); });
  std::size_t i = 0;
  visit(options, [&]<typename Info, typename Member>(const Info& info, Member& member) {
    const auto& initially = *static_cast<const Member*>(initial[i++]);
    if constexpr (std::is_same_v<Info, scene::OptionInfo>) changed = row(info, member, initially) || changed;
  });
  return changed;
}

/// What a row has for a range from 0 to more than 1000.
enum class WideRange { slider, drag };

/// Rows for the members that `selects` selects, all if it is empty. Returns whether a value changed.
template <typename Options, typename Visit>
bool option_rows(Options& options, const Options& file, Visit visit,
                 const std::function<bool(const std::string&)>& selects = {},
                 WideRange wide = WideRange::slider) {
  return each_row(options, file, visit,
                  [&](const scene::OptionInfo& info, auto& value, const auto& standard) {
                    using Value = std::remove_reference_t<decltype(value)>;
                    if (selects && !selects(info.key)) return false;
                    if constexpr (std::is_same_v<Value, float>)
                      if (wide == WideRange::drag && info.high > 1000) return drag_row(info, value, standard);
                    if constexpr (std::is_same_v<Value, glm::vec3>)
                      if (info.unit == std::string_view("m")) return vector_row(info, value, standard);
                    return option_row(info, value, standard);
                  });
}

/// The rows of a tank, whose lengths and intensities span more than a slider resolves.
template <typename Options, typename Visit>
bool tank_rows(Options& options, const Options& file, Visit visit,
               const std::function<bool(const std::string&)>& selects = {}) {
  return option_rows(options, file, visit, selects, WideRange::drag);
}

}  // namespace brume::viewer
