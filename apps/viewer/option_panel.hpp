// Panels that are made of the option structs: name, default, unit and range of each number stand in
// scene/options.hpp alone.
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

// One row for a number: a slider, its unit, what it is when the mouse rests on it; a right click brings the
// default back. True when it was changed. Ctrl and a click lets type it in; it never leaves its range.
bool option_row(const scene::OptionInfo& info, float& value, float initial);
bool option_row(const scene::OptionInfo& info, std::uint32_t& value, std::uint32_t initial);
bool option_row(const scene::OptionInfo& info, glm::vec3& value, glm::vec3 initial);
bool option_row(const scene::OptionInfo& info, std::optional<float>& value, std::optional<float> initial);

/// The rows of those members that `wanted` names; `visit` is one of the visit_* functions, as a callable.
template <typename Options, typename Visit>
bool option_rows(Options& options, Visit visit, const std::function<bool(const std::string&)>& wanted = {}) {
  Options initial{};
  bool changed = false;
  // Both structs are walked in step: the default of a member stands at the same place.
  std::vector<const void*> defaults;
  visit(initial, [&](const scene::OptionInfo&, auto& member) { defaults.push_back(&member); });
  std::size_t i = 0;
  visit(options, [&](const scene::OptionInfo& info, auto& member) {
    using Member = std::remove_reference_t<decltype(member)>;
    const auto& standard = *static_cast<const Member*>(defaults[i++]);
    if (!wanted || wanted(info.key)) changed = option_row(info, member, standard) || changed;
  });
  return changed;
}

}  // namespace brume::viewer
