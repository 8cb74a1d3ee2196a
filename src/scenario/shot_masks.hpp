// The masks of a timeline's shots and texts: pictures and glyphs in one atlas.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "core/error.hpp"
#include "image/image.hpp"
#include "scene/timeline.hpp"
#include "smoke/mask_atlas.hpp"

namespace brume::scenario {

/// A letter of a text, in cap heights from the middle of its row: half its length along it and half a cap
/// height up.
struct Letter {
  std::uint32_t mask = 0;
  float right = 0, up = 0;
  float half_side = 0;
};

/// The masks in an atlas for each picture and text of a timeline.
struct ShotMasks {
  using Text = std::tuple<std::string, std::string, float>;  ///< Font, text, spacing.
  std::map<std::string, std::uint32_t> pictures;             ///< By file.
  std::map<Text, std::vector<Letter>> texts;                 ///< Without blanks.

  static Text key(const scene::TextEvent& event) { return {event.font.string(), event.text, event.spacing}; }
};

struct LoadedMasks {
  smoke::MaskAtlas atlas;
  ShotMasks of_shots;
};

/// Converts a picture to a mask: luminance times alpha, 255 for opaque white. A picture that is not square is
/// centred in a square. Fails with resource_limit for a picture larger than an atlas can hold.
Result<smoke::Mask> make_mask(const image::Image8& picture, const std::string& name);

/// Loads the pictures and fonts that the timeline names. Each picture and each glyph is one mask; masks with
/// identical texels are shared. They are numbered by the time of their first use, so later shots do not
/// change earlier numbers. The atlas depends on pictures, letters and timeline only, not on file locations.
/// Fails with bad_input for a file that is missing or unreadable, a character missing from its font, or a
/// text of blanks, naming the event's place, and with resource_limit as MaskAtlas::pack, naming the place of
/// the last event that adds a mask.
Result<LoadedMasks> load_masks(const scene::Timeline& timeline);

}  // namespace brume::scenario
