// The exposure that fits a scene.
#pragma once

#include "render/renderer.hpp"

namespace brume::render {

/// The factor that shows what `input` shows, without its smoke, at a middle brightness. Draws a small frame
/// of the renderer's aspect. Between frames; a film of the renderer starts over.
float measure_exposure(gpu::Context& context, Renderer& renderer, FrameInput input);

}  // namespace brume::render
