// The kinds of files that commands write, recognized by their first bytes.
#pragma once

#include <filesystem>

#include "core/error.hpp"

namespace brume::cli {

enum class FileKind {
  png,
  exr,
  mp4,
  vxl,
  brp,
  brv,
  vdb,
  nvdb,
  raw,
  json,
  obj,
  ply,
  spheres,
  timeline,
  frame_log,
  godot_import,
  slice_atlas,  ///< The description of one.
  flipbook,     ///< Likewise.
  checkpoint,   ///< A stopped reference rendering.
  unit_key      ///< What a unit of many was made from.
};

/// As messages call it: ".png file", "timeline".
const char* name_of(FileKind kind);

/// Whether a file may be replaced by one of this kind: it is empty or begins like one. Fails with bad_input
/// when it cannot be read.
Result<bool> is_of_kind(const std::filesystem::path& file, FileKind kind);

/// Whether a JSON file may be one that scenes refer to: a palette, a slice atlas, a raw array. Fails as
/// is_of_kind.
Result<bool> may_be_json_input(const std::filesystem::path& file);

}  // namespace brume::cli
