// Panel rows generated from the option structs: scene/options.hpp is the only place that states the name,
// default, unit and range of a number.
#pragma once

#include <imgui.h>

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/options.hpp"

namespace brume::viewer {

// One row per number: a slider with unit and tooltip; right click restores the default, Ctrl+click types a
// value. Values stay in their range. Returns whether the value changed.
bool option_row(const scene::OptionInfo& info, float& value, float initial);
bool option_row(const scene::OptionInfo& info, std::uint32_t& value, std::uint32_t initial);
bool option_row(const scene::OptionInfo& info, glm::vec3& value, glm::vec3 initial);
bool option_row(const scene::OptionInfo& info, std::optional<float>& value, std::optional<float> initial);

/// Rows for the members that `selects` selects, all if it is empty; `visit` wraps one of the visit_*
/// functions. Returns whether a value changed.
template <typename Options, typename Visit>
bool option_rows(Options& options, Visit visit, const std::function<bool(const std::string&)>& selects = {}) {
  Options initial{};
  bool changed = false;
  // Both visits are in the same order, so that index i is the default of member i.
  std::vector<const void*> defaults;
  visit(initial, [&](const scene::OptionInfo&, auto& member) { defaults.push_back(&member); });
  std::size_t i = 0;
  visit(options, [&](const scene::OptionInfo& info, auto& member) {
    using Member = std::remove_reference_t<decltype(member)>;
    const auto& standard = *static_cast<const Member*>(defaults[i++]);
    if (!selects || selects(info.key)) changed = option_row(info, member, standard) || changed;
  });
  return changed;
}

}  // namespace brume::viewer
