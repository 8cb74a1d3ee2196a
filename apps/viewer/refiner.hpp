// What draws the picture of a document, and refines it as long as nothing in it changes.
#pragma once

#include <functional>
#include <glm/glm.hpp>

#include "gpu/recorder.hpp"
#include "image/image.hpp"

namespace brume::viewer {

/// How long the picture of a frame has been the same.
enum class Stage {
  changed,   ///< It is another one than in the frame before.
  waiting,   ///< It has been the same for a few frames: an input may well follow.
  refining,  ///< It becomes the best one, step by step.
};

/// To be called in this order for each frame, when the device has finished the one before.
class Refiner {
 public:
  virtual ~Refiner() = default;

  /// Whether the picture in a window of this size is another one than in the last frame.
  virtual bool changes(glm::uvec2 window_px) = 0;
  /// Prepares a frame, that many seconds after the last one; false if an input interrupted it: then the
  /// picture waits again. Throws resource_limit.
  virtual bool prepare(glm::uvec2 window_px, Stage stage, double frame_seconds) = 0;
  /// Records what was prepared.
  virtual void record(gpu::Recorder& recorder) = 0;
  /// The newest complete picture, once that is recorded; null: none.
  virtual const gpu::Image* shown() const = 0;
  /// Whether nothing refines it further.
  virtual bool is_best() const = 0;
  /// In place of all that while the window shows nothing.
  virtual void hide() {}

  /// The picture in this size, at once; if `complete`, the best one. `check` is called after every few
  /// samples, and may throw.
  virtual image::Image8 picture(glm::uvec2 size_px, bool complete, const std::function<void()>& check) = 0;
};

}  // namespace brume::viewer
