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

/// A patch of a linear colour in [0, 1] whose popup edits it. Returns whether it changed.
bool color_patch(glm::vec3& color);

/// What a row has for a range from 0 to more than 1000.
enum class WideRange { slider, drag };

/// Rows for the members that `selects` selects, all if it is empty; `visit` wraps one of the visit_*
/// functions. `file` holds the values that the document began with. Returns whether a value changed.
template <typename Options, typename Visit>
bool option_rows(Options& options, const Options& file, Visit visit,
                 const std::function<bool(const std::string&)>& selects = {},
                 WideRange wide = WideRange::slider) {
  const auto row = [&](const scene::OptionInfo& info, auto& value, const auto& standard) {
    using Value = std::remove_reference_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, float>)
      if (wide == WideRange::drag && info.high > 1000) return drag_row(info, value, standard);
    if constexpr (std::is_same_v<Value, glm::vec3>)
      if (info.unit == std::string_view("m")) return vector_row(info, value, standard);
    return option_row(info, value, standard);
  };
  bool changed = false;
  // Both visits are in the same order, so that index i is the file's value of member i.
  std::vector<const void*> initial;
  visit(file, [&](const scene::OptionInfo&, auto& member) { initial.push_back(&member); });
  std::size_t i = 0;
  visit(options, [&](const scene::OptionInfo& info, auto& member) {
    using Member = std::remove_reference_t<decltype(member)>;
    const auto& standard = *static_cast<const Member*>(initial[i++]);
    if (!selects || selects(info.key)) changed = row(info, member, standard) || changed;
  });
  return changed;
}

/// The rows of a tank, whose lengths and intensities span more than a slider resolves.
template <typename Options, typename Visit>
bool tank_rows(Options& options, const Options& file, Visit visit,
               const std::function<bool(const std::string&)>& selects = {}) {
  return option_rows(options, file, visit, selects, WideRange::drag);
}

}  // namespace brume::viewer
