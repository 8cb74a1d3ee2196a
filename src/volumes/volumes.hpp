// The volumes of a timeline at any time: files of grids and numbered sequences of them, loaded when their
// time comes.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "scene/scene.hpp"
#include "scene/volume_options.hpp"
#include "volumes/volume_extent.hpp"
#include "volumes/volume_frame.hpp"
#include "volumes/volume_loader.hpp"

namespace brume::volumes {

/// A volume at one time.
struct VolumeAt {
  std::shared_ptr<const VolumeFrame> frame;      ///< Null: not shown.
  std::shared_ptr<const VolumePreview> preview;  ///< Null: none was made.
  /// From the voxels of the grids; of a volume with a carrier, to the carrier's space.
  glm::mat4 world_from_density{1}, world_from_heat{1};
  glm::mat4 world_from_density_preview{1}, world_from_heat_preview{1};
};

/// What to do about a frame that is not loaded yet.
enum class VolumeWait {
  until_loaded,  ///< Wait: what is shown does not depend on timing.
  never,         ///< Show the frame before it until it is.
};

/// Loads frames in a thread of its own, the next one of each sequence ahead. Not for several threads at a
/// time.
class Volumes {
 public:
  /// Loads the first frame of each by `read`, one more where there is nothing to see in it, and later the
  /// others. Fails as `read`, and with bad_input for a sequence without files, for axes without an inverse,
  /// and for grids that do not exist.
  static Result<std::shared_ptr<Volumes>> load(std::span<const scene::VolumeOptions> options,
                                               grids::GridReader read = grids::load_grid_file);

  /// All volumes, in the order of the options, with the grids that they name. A frame that is missing from a
  /// sequence shows the one before it, so do times after the last, unless the options repeat or clip it;
  /// before the first, the first. Warns once of a frame that cannot be read, which shows the last one that
  /// was. Frames remain loaded as long as they are shown.
  std::vector<VolumeAt> at(std::span<const scene::VolumeOptions> options, double seconds,
                           VolumeWait wait = VolumeWait::until_loaded);
  /// Whether the last `at` showed frames of other times, since the right ones were not loaded.
  bool is_behind() const { return is_behind_; }

  /// Chooses the grids that the options of a volume name, from its first frame on. On failure, as load,
  /// nothing changes.
  Result<void> choose_grids(std::size_t volume, const scene::VolumeOptions& options);

  /// Makes room for all volumes together: where the first frames take more, those that take more than a fair
  /// part are loaded again at a lower resolution, each with a warning; so are frames that are loaded later.
  /// Fails as `load`.
  Result<void> limit(const VolumeRoom& room);
  /// Makes previews of all frames, those that are loaded included.
  void make_previews();

  /// The frame that stands for all of a sequence, so that they are lit and coloured in one way: the first one
  /// in which there is something to see, and after measure_sequence the deepest of those that it looked at.
  const VolumeFrame& typical_frame(std::size_t volume) const { return *sequences_[volume].typical.frame; }
  bool is_sequence(std::size_t volume) const { return sequences_[volume].files.size() > 1; }
  /// Frames of a sequence, those that are missing between its first and its last included; 1 for a single
  /// file.
  std::int64_t length(std::size_t volume) const;
  /// Loads up to a dozen frames of a sequence, for its extent, its typical frame, and whether its heat is in
  /// kelvin, which one frame decides for all.
  void measure_sequence(std::size_t volume);
  /// The extent of all frames that were measured; else of the typical one.
  VolumeExtent extent(std::size_t volume) const;
  /// All files of all sequences, without what they describe or are described by (grids::files_of).
  std::vector<std::filesystem::path> files() const;

 private:
  struct Sequence {
    scene::VolumeOptions options;                         ///< Options that loading follows.
    std::map<std::int64_t, std::filesystem::path> files;  ///< By number of the frame.
    LoadedVolume typical = {}, shown = {};
    std::int64_t typical_number = 0, shown_number = 0;
    std::optional<VolumeExtent> extent = {};  ///< After measure_sequence.
    std::set<std::int64_t> unreadable = {};   ///< Frames of which a warning was given.
    VolumeRoom room = {};                     ///< What each frame may take.
    bool in_kelvin = false;                   ///< Whether a frame that was loaded has heat in kelvin.
  };
  std::optional<std::int64_t> frame_at(const Sequence& sequence, const scene::VolumeOptions& options,
                                       double seconds) const;
  std::optional<std::int64_t> frame_after(const Sequence& sequence, const scene::VolumeOptions& options,
                                          std::int64_t number) const;
  void show(std::size_t volume, std::int64_t number, Result<LoadedVolume> loaded);
  void start_loader();
  Result<std::shared_ptr<const VolumeFrame>> load_frame(const Sequence& sequence, std::int64_t number) const;
  void measure(Sequence& sequence);

  grids::GridReader read_ = nullptr;
  std::vector<Sequence> sequences_;
  bool has_previews_ = false, is_behind_ = false;
  std::unique_ptr<VolumeLoader> loader_;  ///< Another one when rooms or previews change.
};

/// The part of `total` that each of several gets: what it wants where that is at most a fair part, and else
/// as much as all others that get less than they want. The sum of the parts is at most `total`.
std::vector<std::uint64_t> fair_parts(std::span<const std::uint64_t> wanted, std::uint64_t total);
/// The values that the curves of a volume span, in the unit of its grid: as chosen, or its typical
/// frame's; from 0 on where all are the same.
glm::vec2 range_of(const scene::VolumeOptions& options, const VolumeFrame& typical);

/// Where a volume is.
scene::Volume place_of(const scene::VolumeOptions& options, const VolumeExtent& extent);

/// Corners of boxes around all that is dense in a volume, in the world; of a sequence around what is seen of
/// its frames.
std::vector<glm::vec3> corners_of(const scene::VolumeOptions& options, const Volumes& volumes, std::size_t i);

/// From the world of a volume's file to the world of the scene [m].
glm::mat4 world_from_file(const scene::VolumeOptions& options);

}  // namespace brume::volumes
