// Roles that files give to surfaces: by the names of objects, and by what their materials let through.
#pragma once

#include <optional>
#include <string_view>

#include "core/role.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

/// By how a name begins: IGNORE_ is a ghost, GLASS_ glass, GRILLE_ a grille.
std::optional<Role> role_of_prefix(std::string_view name);

/// The alpha of a material: the image's at a place, times the vertices', times a factor.
struct Alpha {
  const Image* image = nullptr;  ///< Null: 1.
  double factor = 1;
  double cutoff = 0.5;  ///< What is below is not drawn.
};

/// What a mesh of such a material stops, by its alpha at 36 places of each triangle:
/// - a wall where fewer than 1/64 of them are cut out;
/// - glass where all are cut out, or none has an alpha of 0.5 or more, or fewer than 1/64 are holes, which
/// are
///   cut out with an alpha below 1/16;
/// - a grille otherwise.
Role role_of_alpha(const Mesh& mesh, const Alpha& alpha);

}  // namespace brume::scene
