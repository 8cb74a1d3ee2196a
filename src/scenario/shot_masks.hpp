// The masks of a timeline's shots and letters: pictures and glyphs, in one atlas.
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

/// A letter of a text that is shot, in capital heights from the middle of its row: halfway along it, and
/// halfway up a capital letter.
struct Letter {
  std::uint32_t mask = 0;
  float right = 0, up = 0;
  float half_side = 0;
};

/// Which masks of an atlas belong to what a timeline names.
struct ShotMasks {
  using Text = std::tuple<std::string, std::string, float>;  ///< Font, text, spacing.
  std::map<std::string, std::uint32_t> pictures;             ///< By their files.
  std::map<Text, std::vector<Letter>> texts;                 ///< Blanks are left out.

  static Text key(const scene::TextEvent& event) { return {event.font.string(), event.text, event.spacing}; }
};

struct LoadedMasks {
  smoke::MaskAtlas atlas;
  ShotMasks of_shots;
};

/// The mask that a picture is: luminance times alpha, 255 where it is white. One that is no square lies in
/// the middle of one. Fails with resource_limit for a picture larger than an atlas holds.
Result<smoke::Mask> mask_of(const image::Image8& picture, const std::string& name);

/// Reads the pictures and fonts that the timeline names; each picture, and each glyph of a font, is one mask,
/// and those that are the same texel for texel are one together. They are numbered by the time of their first
/// use: what is shot later changes no number of what was before. The same atlas for the same pictures,
/// letters and timeline, wherever the files lie. Fails with bad_input for a file that is missing or cannot
/// be read, a character that its font lacks, a text of blanks, naming the event's place, and with
/// resource_limit as MaskAtlas::pack, naming the last event's that brings a mask.
Result<LoadedMasks> load_masks(const scene::Timeline& timeline);

}  // namespace brume::scenario
