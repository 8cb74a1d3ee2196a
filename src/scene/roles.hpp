// Roles that files give to surfaces: by the names of objects, and by what their materials let through.
#pragma once

#include <optional>
#include <string_view>

#include "core/role.hpp"
#include "image/image.hpp"

namespace brume::scene {

/// By how a name begins: IGNORE_ is a ghost, GLASS_ glass, GRILLE_ a grille.
std::optional<Role> role_of_prefix(std::string_view name);

/// Of a material whose alpha is `factor` times that of an image (null: 1), and which is cut out below
/// `cutoff`: glass where all of it is cut out or below an alpha of 0.5, a grille where some of it is cut out,
/// else a wall.
Role role_of_alpha(const image::Image8* image, double factor, double cutoff);

}  // namespace brume::scene
