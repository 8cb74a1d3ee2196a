// Rows of the panels for the settings of a tank: scene/tank_options.hpp.
#pragma once

#include <string_view>
#include <type_traits>
#include <vector>

#include "apps/viewer/option_panel.hpp"
#include "scene/tank_options.hpp"

namespace brume::viewer {

// Ranges that no slider resolves are dragged.
inline bool tank_row(const scene::OptionInfo& info, float& value, float file) {
  return info.high > 1000 ? drag_row(info, value, file) : option_row(info, value, file);
}
inline bool tank_row(const scene::OptionInfo& info, std::uint32_t& value, std::uint32_t file) {
  return option_row(info, value, file);
}
inline bool tank_row(const scene::OptionInfo& info, glm::vec3& value, const glm::vec3& file) {
  return std::string_view(info.unit) == "m" ? vector_row(info, value, file) : option_row(info, value, file);
}

/// A row for each member that `selects` selects, all without it; as option_rows.
template <typename Options, typename Visit>
bool tank_rows(Options& options, const Options& file, Visit visit,
               const std::function<bool(std::string_view)>& selects = {}) {
  bool changed = false;
  // Both visits are in the same order, so that index i is the file's value of member i.
  std::vector<const void*> initial;
  visit(file, [&](const scene::OptionInfo&, auto& member) { initial.push_back(&member); });
  std::size_t i = 0;
  visit(options, [&](const scene::OptionInfo& info, auto& member) {
    using Member = std::remove_reference_t<decltype(member)>;
    const auto& standard = *static_cast<const Member*>(initial[i++]);
    if (!selects || selects(info.key)) changed = tank_row(info, member, standard) || changed;
  });
  return changed;
}

}  // namespace brume::viewer
