// Image difference metrics: numerical and perceptual.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "image/image.hpp"

namespace brume::image {

/// Statistics of the differences between two lists of values.
struct Difference {
  double max = 0;   ///< Largest absolute difference.
  double mean = 0;  ///< Mean absolute difference.
  double rmse = 0;  ///< Root of the mean squared difference.
};

/// Compares two lists of equal length; all 0 for empty ones. A value that is not finite in either list counts
/// as an infinite difference.
Difference difference(std::span<const float> a, std::span<const float> b);

/// Peak signal-to-noise ratio [dB], 20 log10(peak / rmse); infinite for an rmse of 0.
double psnr(double rmse, double peak);

/// One value per texel, rows from the top.
struct Plane {
  std::uint32_t width = 0, height = 0;
  std::vector<float> values;
};

/// The encoded colours [0, 1] of an image, three values per texel; its alpha; its luma (ITU-R BT.601).
std::vector<float> encoded_colours(const Image8& image);
std::vector<float> alphas(const Image8& image);
Plane luma(const Image8& image);

/// Mean structural similarity, [-1, 1], 1 for equal planes (Wang et al. 2004, "Image Quality Assessment: From
/// Error Visibility to Structural Similarity"): Gaussian windows of 11 x 11 texels with a deviation of 1.5,
/// K1 = 0.01, K2 = 0.03, at every texel whose window lies inside the image. Along an axis of less than 11
/// texels all texels count, with clipped and renormalized windows. Planes of equal size; values in [0, peak].
double ssim(const Plane& a, const Plane& b, double peak);

/// Pixels per degree of a screen with 3,840 pixels on 0.7 m, viewed from 0.7 m.
constexpr double kScreenPixelsPerDegree = 67.0206;

/// The difference an observer notices when the images alternate, [0, 1] per texel (Andersson et al. 2020,
/// "FLIP: A Difference Evaluator for Alternating Images", with its constants; clamped at the edges). Images
/// of equal size; colours are sRGB, alpha is ignored.
Plane flip(const Image8& reference, const Image8& test, double pixels_per_degree = kScreenPixelsPerDegree);

/// A map [0, 1] in colours of increasing brightness: black, violet, red, orange, pale yellow.
Image8 heat_map(const Plane& map);

}  // namespace brume::image
