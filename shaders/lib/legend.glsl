// Legend of a debug view: its ramp with three numbers in the lower left corner. The includer has `params`.
#ifndef LEGEND_GLSL
#define LEGEND_GLSL
#include "lib/frame.glsl"
#include "shared/debug_view.h"

// Glyphs 0 to 9, point, m, +: rows of three pixels, the top row in the highest bits.
const uint kGlyphRows[13] = {0x7b6fu, 0x2c97u, 0x73e7u, 0x73cfu, 0x5bc9u, 0x79cfu, 0x79efu, 0x7252u, 0x7befu, 0x7bcfu,
                             0x0002u, 0x0fedu, 0x05d0u};

/// Whether a pixel of a label is inked; `at` from its upper left corner, in glyph pixels. A glyph is four wide.
bool inked(uint label, ivec2 at) {
  if (at.x < 0 || at.y < 0 || at.x >= 4 * int(kLabelGlyphs) || at.y >= 5 || at.x % 4 == 3) return false;
  const uint glyph = label >> uint(5 * (at.x / 4)) & 31u;
  return glyph != kGlyphNone && (kGlyphRows[min(glyph, 12u)] >> uint(14 - 3 * at.y - at.x % 4) & 1u) != 0u;
}

/// Number of glyphs of a label.
int label_length(uint label) {
  int length = 0;
  while (length < int(kLabelGlyphs) && (label >> uint(5 * length) & 31u) != kGlyphNone) ++length;
  return length;
}

/// The colour of a pixel with the legend over it. Small images have no legend.
vec3 with_legend(vec3 colour, ivec2 px, uint ramp) {
  const ivec2 size = ivec2(frame.size_px);
  if (params.labels == uvec3(0u) || size.x < 200 || size.y < 100) return colour;
  const int scale = max(1, (size.y + 90) / 180);
  const ivec2 bar = ivec2(88, 5) * scale, margin = ivec2(12, 5) * scale;
  const ivec2 panel = bar + 2 * margin + ivec2(0, 8 * scale);
  const ivec2 at = px - ivec2(6 * scale, size.y - 6 * scale - panel.y);
  if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, panel))) return colour;
  colour = mix(colour, vec3(0.03, 0.035, 0.045), 0.78);
  const ivec2 in_bar = at - margin;
  if (all(greaterThanEqual(in_bar, ivec2(0))) && all(lessThan(in_bar, bar)))
    return ramp_colour(ramp, (float(in_bar.x) + 0.5) / float(bar.x));
  for (int i = 0; i < 3; ++i) {
    const uint label = params.labels[i];
    const int left = i * (bar.x - 1) / 2 - (4 * label_length(label) - 1) * scale / 2;
    const ivec2 in_label = in_bar - ivec2(left, bar.y + 3 * scale);
    if (all(greaterThanEqual(in_label, ivec2(0))) && inked(label, in_label / scale)) return vec3(0.86, 0.88, 0.9);
    // A tick above each number.
    const int tick = abs(in_bar.x - i * (bar.x - 1) / 2);
    if (tick < scale && in_bar.y >= bar.y && in_bar.y < bar.y + 2 * scale) return vec3(0.6, 0.62, 0.65);
  }
  return colour;
}

#endif
