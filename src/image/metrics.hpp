// How far two pictures are apart: in numbers, and in what an eye would notice.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "image/image.hpp"

namespace brume::image {

/// Differences of values, whatever they measure.
struct Difference {
  double max = 0;   ///< Largest absolute one.
  double mean = 0;  ///< Mean of the absolute ones.
  double rmse = 0;  ///< Root of their mean square.
};

/// Of two lists of equal length; all 0 for empty ones. A value that is not finite, on one side or both,
/// differs by infinity.
Difference difference(std::span<const float> a, std::span<const float> b);

/// Peak signal-to-noise ratio [dB], 20 log10(peak / rmse); infinite for an rmse of 0.
double psnr(double rmse, double peak);

/// One value a texel, rows from the top.
struct Plane {
  std::uint32_t width = 0, height = 0;
  std::vector<float> values;
};

/// Colours [0, 1] of a picture as they are encoded, three values a texel; its alpha; its luma of ITU-R
/// BT.601.
std::vector<float> encoded_colours(const Image8& picture);
std::vector<float> alphas(const Image8& picture);
Plane luma(const Image8& picture);

/// Mean structural similarity, [-1, 1], 1 for equal planes (Wang et al. 2004, "Image Quality Assessment: From
/// Error Visibility to Structural Similarity"): Gaussian windows of 11 x 11 texels with a deviation of 1.5,
/// K1 = 0.01, K2 = 0.03, at every texel whose window lies in the picture. Along an axis of less than 11
/// texels all count, and windows are cut and weighed anew. Planes of one size; values in [0, peak].
double ssim(const Plane& a, const Plane& b, double peak);

/// Pixels per degree of a screen of 3,840 pixels on 0.7 m, seen from 0.7 m.
constexpr double kScreenPixelsPerDegree = 67.0206;

/// What an observer notices when the two are shown in turn, [0, 1] a texel (Andersson et al. 2020, "FLIP: A
/// Difference Evaluator for Alternating Images", with its constants; texels beyond the edge are those at the
/// edge). Pictures of one size; colours are sRGB, alpha is not looked at.
Plane flip(const Image8& reference, const Image8& test, double pixels_per_degree = kScreenPixelsPerDegree);

/// A map [0, 1] as colours: black over violet, red and orange to pale yellow, ever brighter.
Image8 heat_map(const Plane& map);

}  // namespace brume::image
