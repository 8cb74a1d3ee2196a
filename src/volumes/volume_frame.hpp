// One file of grids as the renderer shows it.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/box.hpp"
#include "core/error.hpp"
#include "grids/brick_volume.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/glow.hpp"
#include "grids/volume_files.hpp"
#include "scene/volume_options.hpp"

namespace brume::volumes {

/// A part of a mask as a homogeneous ball, in the file's world.
struct MaskGlow {
  std::size_t mask = 0;
  glm::dvec3 middle{0};
  double radius = 0;
  double integral = 0;  ///< The mask over the part's volume.
};

/// The grids of one file that are rendered.
struct VolumeFrame {
  grids::BrickVolume density;
  std::optional<grids::BrickVolume> heat;
  std::vector<grids::GlowBall> glow;  ///< Balls that stand for the heat.
  /// As grids::make_color_bricks, or of a volume with masks as grids::make_mask_bricks; null: none.
  std::unique_ptr<volume::SparseVolume> colors;
  std::vector<MaskGlow> mask_glow;  ///< Balls that stand for its masks.
  double mean_density = 0;          ///< Over the active voxels.
  Box<float> bounds;                ///< Around what can be dense, in the file's world.
  /// Whether the density is an extinction per metre (grids::is_extinction_per_metre).
  bool is_extinction = false;
  /// Whether values of the heat, in this frame or another one, are above kMostFactor: kelvin, and no factors
  /// of a temperature.
  bool heat_is_kelvin = false;
  std::string density_name;  ///< Name of the grid that is dense.
  std::string heat_note;     ///< What was decided about the heat, a sentence; empty: there is none.
  /// ChosenGrids::notes.
  std::vector<std::string> grid_notes;
  std::string value_note;  ///< About values below 0 that count as 0, a sentence; empty: there are none.
  bool z_is_up = false;    ///< As Blender writes files; other programs have y up.
  /// Names of the file's grids that can be dense or glow, and of those that can hold colours; of several of
  /// one name as titles_of.
  std::vector<std::string> number_grids, color_grids;
};

/// The largest heat that counts as a factor of a temperature.
inline constexpr float kMostFactor = 100;

/// Kelvin where the heat is 1: VolumeOptions::kelvin, or 1 where the heat is in kelvin and the options do not
/// differ from their default.
float kelvin_of(const scene::VolumeOptions& options, const VolumeFrame& frame);

/// How values below 0 are stored, where the options' range reaches below 0 and their opacity curve draws
/// something there; else empty.
std::optional<grids::ValueShift> shift_of(const scene::VolumeOptions& options);

/// What is shown of a file without options: the grid that is dense, and what was decided about its heat.
/// Fails with bad_input where nothing can be shown.
Result<std::string> shown_grids(const grids::GridFile& file);

/// The same at a lower resolution, for as long as not all of it is on the device; empty where it is small.
struct VolumePreview {
  std::optional<grids::BrickVolume> density, heat;
};

/// Bricks of a preview at most: 8 MiB, uploaded in one frame.
inline constexpr std::uint32_t kPreviewBricks = 4096;

/// What a volume may take of the device: its density and its heat together.
struct VolumeRoom {
  std::uint64_t bricks = grids::kMostVolumeBricks;
  std::uint64_t pages = grids::kMostVolumePages;  ///< Entries of page tables.
  bool operator==(const VolumeRoom&) const = default;
};
VolumeRoom room_of(const VolumeFrame& frame);

/// Loads the grids that the options name, reduced until they fit into the room, with a warning that names
/// the error. Fails as `read`, and with bad_input for grids that do not exist; soon once `stopped` (null:
/// never) is true. `in_kelvin`: another frame of the sequence has heat in kelvin, and so has this one.
Result<std::shared_ptr<const VolumeFrame>> load_volume_frame(const std::filesystem::path& file,
                                                             const scene::VolumeOptions& options,
                                                             const VolumeRoom& room = {},
                                                             const std::atomic<bool>* stopped = nullptr,
                                                             grids::GridReader read = grids::load_grid_file,
                                                             bool in_kelvin = false);

/// Around a box under an affine transform.
Box<float> transformed(const glm::mat4& matrix, const Box<float>& box);

/// The previews of grids of more than kPreviewBricks bricks.
std::shared_ptr<const VolumePreview> make_previews(const VolumeFrame& frame);

}  // namespace brume::volumes
