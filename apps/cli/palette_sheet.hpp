// A picture of palettes: their colours and names.
#pragma once

#include <cstdint>
#include <span>

#include "core/error.hpp"
#include "image/image.hpp"
#include "palettes/palette.hpp"

namespace brume::cli {

/// Strips of colours with their names below, in columns from the top left; the indices are of `palettes`.
/// Colours run into each other in Oklab, except in qualitative palettes. Fails with bad_input where
/// image::default_font() is missing.
Result<image::Image8> palette_sheet(std::span<const palettes::Palette> palettes,
                                    std::span<const std::uint32_t> indices);

}  // namespace brume::cli
