// From samples to a picture.
#pragma once

#include <functional>

#include "image/image.hpp"
#include "planning/frame_input.hpp"
#include "reference/render.hpp"
#include "smoke/mask_atlas.hpp"

namespace brume::reference {

/// The picture so far through the exposure and the tone curve of a view, as shaders/display.comp makes it,
/// with noise of a quantization step against banding.
image::Image8 make_picture(const Render& render, glm::uvec2 size_px, const planning::View& view);

/// The factor that shows a frame, without its smoke, at a middle brightness. Arguments as for
/// make_scene. When `stopped` returns true, from what was found so far.
float measure_exposure(const scene::Scene& scene, planning::FrameInput frame, const smoke::MaskAtlas* masks,
                       float aspect, const std::function<bool()>& stopped);

}  // namespace brume::reference
