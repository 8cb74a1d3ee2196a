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
image::Image8 picture_of(const Render& render, glm::uvec2 size_px, const planning::View& view);

/// The factor that shows a frame, without its smoke, at a middle brightness. Arguments as those of
/// make_scene. By what it found so far when `stopped` returns true.
float measure_exposure(const scene::Scene& scene, planning::FrameInput frame, const smoke::MaskAtlas* masks,
                       float aspect, const std::function<bool()>& stopped);

}  // namespace brume::reference
