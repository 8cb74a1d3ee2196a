// Pictures that the CPU reads.
#pragma once

#include "gpu/read_back.hpp"
#include "image/image.hpp"

namespace brume::film {

/// The picture in a readback buffer of four bytes per pixel, once the device is done.
image::Image8 read_picture(const gpu::Buffer& pixels, glm::uvec2 size_px);
/// The picture in an image of four bytes per texel. `record` comes first in the same submission.
image::Image8 read_picture(gpu::Context& context, gpu::CommandRunner& runner, const gpu::Image& image,
                           const std::function<void(gpu::Recorder&)>& record = {});
/// Four numbers for each pixel of a readback buffer of four half floats per pixel.
std::vector<glm::vec4> unpack_halves(const gpu::Buffer& pixels);

}  // namespace brume::film
