// What the picture of `brume demo` shows; docs/gallery.md shows the same moment.
#pragma once

namespace brume::cli {

/// Of scenes/demo.toml [s].
inline constexpr double kPictureTime = 4.95;

}  // namespace brume::cli
