// The volumes of a timeline at any time: files of grids and numbered sequences of them, loaded when their
// time comes.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "core/error.hpp"
#include "grids/brick_volume.hpp"
#include "scene/scene.hpp"
#include "scene/timeline.hpp"

namespace brume::scenario {

/// The grids of one file that are rendered.
struct VolumeFrame {
  grids::BrickVolume density;
  std::optional<grids::BrickVolume> heat;
  double mean_density = 0;   ///< Of the active voxels.
  double filled_volume = 0;  ///< That all active voxels take, in the file's world.
  Box<float> bounds;         ///< Around what can be dense, in the file's world.
  Box<float> core;           ///< Around most of it: a ball, but none of the wisps around it.
  bool z_is_up = false;      ///< As Blender writes files; other programs have y up.
};

/// A volume at one time.
struct VolumeAt {
  std::shared_ptr<const VolumeFrame> frame;             ///< null: not shown.
  glm::mat4 world_from_density{1}, world_from_heat{1};  ///< From the voxels of the grids.
};

/// Not for several threads at a time.
class Volumes {
 public:
  /// Loads the first frame of each. Fails as grids::load_grid_file, and with bad_input for a sequence without
  /// files, for axes without an inverse, and for grids that do not exist.
  static Result<std::shared_ptr<Volumes>> load(std::span<const scene::VolumeOptions> options);

  /// All volumes, in the order of the options. A frame that is missing from a sequence shows the one before
  /// it, so do times after the last, unless the options repeat or clip it; before the first, the first. Warns
  /// of a frame that cannot be read, which shows the last one that was. Frames remain loaded as long as they
  /// are shown.
  std::vector<VolumeAt> at(std::span<const scene::VolumeOptions> options, double seconds);

  const VolumeFrame& first_frame(std::size_t volume) const { return *sequences_[volume].first; }
  /// All files of all sequences.
  std::vector<std::filesystem::path> files() const;

 private:
  struct Sequence {
    std::map<std::int64_t, std::filesystem::path> files;  ///< By number of the frame.
    std::shared_ptr<const VolumeFrame> first, shown;
    std::int64_t shown_number = 0;
  };
  std::vector<Sequence> sequences_;
};

/// Where the first frame of a volume is.
scene::Volume place_of(const scene::VolumeOptions& options, const VolumeFrame& frame);

/// Corners of boxes around all that is dense in the first frame of a volume, in the world.
std::vector<glm::vec3> corners_of(const scene::VolumeOptions& options, const VolumeFrame& frame);

/// From the world of a volume's file to that of the scene [m].
glm::mat4 world_from_file(const scene::VolumeOptions& options);

/// Loads the grids that the options name.
Result<std::shared_ptr<const VolumeFrame>> load_volume_frame(const std::filesystem::path& file,
                                                             const scene::VolumeOptions& options);

}  // namespace brume::scenario
