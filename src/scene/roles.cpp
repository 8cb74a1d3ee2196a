#include "scene/roles.hpp"

#include <algorithm>
#include <cstddef>

namespace brume::scene {

std::optional<Role> role_of_prefix(std::string_view name) {
  if (name.starts_with("IGNORE_")) return Role::ghost;
  if (name.starts_with("GLASS_")) return Role::glass;
  if (name.starts_with("GRILLE_")) return Role::grille;
  return std::nullopt;
}

Role role_of_alpha(const image::Image8* image, double factor, double cutoff) {
  double least = factor, most = factor;
  if (image != nullptr && image->rgba.size() >= 4) {
    int low = 255, high = 0;
    for (std::size_t i = 3; i < image->rgba.size(); i += 4) {
      low = std::min<int>(low, image->rgba[i]);
      high = std::max<int>(high, image->rgba[i]);
    }
    least *= low / 255.0;
    most *= high / 255.0;
  }
  if (most < std::max(cutoff, 0.5)) return Role::glass;
  return least < cutoff ? Role::grille : Role::wall;
}

}  // namespace brume::scene
