// The march at a reduced resolution: one ray per tile of pixels, interpolated to the smoke of each pixel.
#pragma once

#include "gpu/recorder.hpp"
#include "passes/march.hpp"

namespace brume::passes {

class ResolvePass {
 public:
  explicit ResolvePass(gpu::Context& context);

  /// A frame; images and tiles may be larger.
  struct Frame {
    const gpu::Buffer& constants;  ///< FrameConstants.
    glm::uvec2 size_px;
  };
  /// Finds the ray of each tile and the depths of its surfaces. `depth` is the G-buffer's.
  void record_ends(gpu::Recorder& recorder, const Frame& frame, const gpu::Image& depth,
                   const MarchTiles& tiles) const;
  /// Empties the list of tiles, among the uploads of a frame.
  static void upload(gpu::Recorder& recorder, const MarchTiles& tiles);
  /// Adds to the list the tiles where interpolation between rays would be visible: off by more than
  /// FrameConstants::resolve_error on the screen, in front of a surface with the G-buffer's `emission` or in
  /// bright light.
  void record_select(gpu::Recorder& recorder, const Frame& frame, const gpu::Image& emission,
                     const MarchTiles& tiles) const;
  /// Writes premultiplied radiance and transmittance of every pixel to `smoke` (half floats) from the marched
  /// tiles. Independent of the list.
  void record(gpu::Recorder& recorder, const Frame& frame, const gpu::Image& depth, const MarchTiles& tiles,
              const gpu::Image& smoke) const;

 private:
  gpu::ComputePipeline ends_, select_, resolve_;
  gpu::Sampler nearest_;
};

}  // namespace brume::passes
