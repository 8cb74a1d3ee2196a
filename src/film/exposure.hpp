// The exposure that fits a scene.
#pragma once

#include "render/renderer.hpp"

namespace brume::film {

/// The factor that shows what `input` shows, without its smoke, at a middle brightness. Draws a small frame
/// of the renderer's aspect. Between frames; a film of the renderer starts over.
float measure_exposure(gpu::Context& context, render::Renderer& renderer, planning::FrameInput input);

}  // namespace brume::film
