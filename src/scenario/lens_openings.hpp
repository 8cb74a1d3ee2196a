// Images of the openings of lenses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <vector>

#include "core/error.hpp"
#include "scene/timeline.hpp"
#include "smoke/mask_atlas.hpp"

namespace brume::scenario {

/// Most texels of an opening per axis.
constexpr std::uint32_t kMostOpeningTexels = 1024;

/// How much light passes at each point of a lens's opening.
class LensOpening {
 public:
  /// A square mask: texels pass light in proportion to their values. Fails with bad_input where all are 0;
  /// `name` is the file's in messages.
  static Result<LensOpening> create(const smoke::Mask& mask, const std::string& name);

  /// A point of [-1, 1]^2, y up, distributed as light passes for evenly distributed `u` in [0, 1)^2.
  glm::vec2 point(const glm::vec2& u) const;

 private:
  LensOpening() = default;
  std::uint32_t side_ = 0;
  std::vector<std::uint64_t> rows_up_to_;    ///< Sum of the rows up to and with each, from the top.
  std::vector<std::uint32_t> texels_up_to_;  ///< Within its row, up to and with each texel.
};

/// By file.
using LensOpenings = std::map<std::filesystem::path, std::shared_ptr<const LensOpening>>;

/// Loads the openings that the camera's keys name and `openings` lacks: luminance times alpha; an image that
/// is not square is centred in a square. Fails with bad_input for a file that is missing, unreadable or
/// black, and with resource_limit for more than kMostOpeningTexels, naming the key's place.
Result<void> load_lens_openings(const scene::Timeline& timeline, LensOpenings& openings);

}  // namespace brume::scenario
