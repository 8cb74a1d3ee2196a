// The numbers behind a frame as layers of an image: radiance, distances, media and surfaces
// (docs/reference/command-line.md).
#pragma once

#include "image/image.hpp"
#include "render/renderer.hpp"

namespace brume::film {

/// Reads the images of frames of one size back from the device.
class FrameLayers {
 public:
  /// `size_px`: the size of the frames. Throws resource_limit.
  FrameLayers(gpu::Context& context, glm::uvec2 size_px);

  /// Copies what `renderer` drew, after its record_frame in the same recording. The renderer has
  /// SmokeFrameOptions::record_entries, its frame no debug view.
  void record(gpu::Recorder& recorder, const render::Renderer& renderer);

  /// The layers, when the device is done:
  ///
  ///   R, G, B            half: radiance before exposure and tone curve; of a frame of several samples the
  ///   mean so far A                  half: 1 where there is a surface, else 1 - transmittance Z float:
  ///   distance of the nearest surface along the view axis [m]; infinity: none transmittance.V    half: of
  ///   all media, up to the surface depth_in.V         float: distance along the ray at which the
  ///   transmittance falls to
  ///                      shared::kEntryTransmittance [m]; infinity: it does not
  ///   albedo.R, .G, .B   half: of the nearest surface, linear; 0: none, or a tank
  ///   media.R, .G, .B    half: radiance of the media alone, premultiplied
  ///   occlusion.V        half: of the light that surfaces reflect, what decals take; in frames with decals
  ///   alone
  ///
  /// All halves but A are the bits of the device.
  image::LayeredImage image() const;

 private:
  glm::uvec2 size_px_;
  gpu::Context& context_;
  gpu::Buffer radiance_, media_, albedo_, depth_, entries_;
  gpu::Buffer occlusion_;    ///< From the first frame with decals in view on.
  gpu::Buffer level_depth_;  ///< From the first frame with tanks in view on.
  bool has_decals_ = false, has_occlusion_ = false, has_tanks_ = false;
};

}  // namespace brume::film
