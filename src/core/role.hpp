// Roles of surfaces: what each stops.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace brume {

/// Each role stops less than the one before it. The numbers are brume_role's (brume.h).
enum class Role : std::uint8_t {
  wall,    ///< Stops everything: smoke, sight, shots, bodies and thrown grenades.
  glass,   ///< Lets sight pass.
  grille,  ///< Lets smoke, sight and shots pass, and stops bodies and thrown grenades: a fence, leaves.
  ghost,   ///< Stops nothing.
};

/// Names in files, by the number of the role.
constexpr std::array<const char*, 4> kRoleNames = {"wall", "glass", "grille", "ghost"};

inline const char* name_of(Role role) {
  return kRoleNames[static_cast<std::size_t>(role)];
}
/// The role of that name, in lower case; nothing for any other.
inline std::optional<Role> role_of_name(std::string_view name) {
  for (std::size_t i = 0; i < kRoleNames.size(); ++i)
    if (name == kRoleNames[i]) return static_cast<Role>(i);
  return std::nullopt;
}

constexpr bool stops_sight(Role role) {
  return role == Role::wall;
}
/// Also shots.
constexpr bool stops_smoke(Role role) {
  return role <= Role::glass;
}
/// Also thrown grenades.
constexpr bool stops_bodies(Role role) {
  return role <= Role::grille;
}

}  // namespace brume
