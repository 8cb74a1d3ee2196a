// Colours between colours: sRGB, linear light and Oklab.
#pragma once

#include <glm/glm.hpp>

namespace brume::palettes {

/// Each channel of sRGB in [0, 1] as linear light and back (IEC 61966-2-1).
glm::dvec3 linear_from_srgb(const glm::dvec3& encoded);
glm::dvec3 srgb_from_linear(const glm::dvec3& linear);

/// Linear light with sRGB primaries as Oklab: lightness in [0, 1], green to red, blue to yellow; equal
/// distances look about equally large (Ottosson 2020, "A perceptual color space for image processing", with
/// the matrices that its author corrected in 2021, https://bottosson.github.io/posts/oklab).
glm::dvec3 oklab_from_linear(const glm::dvec3& linear);
/// The inverse, up to 1e-6; may be outside of [0, 1].
glm::dvec3 linear_from_oklab(const glm::dvec3& lab);

}  // namespace brume::palettes
