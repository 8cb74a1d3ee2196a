// The time of the image that `brume demo` renders; docs/gallery.md shows the same frame.
#pragma once

namespace brume::cli {

/// On the timeline scenes/demo.toml [s].
inline constexpr double kPictureTime = 4.95;

}  // namespace brume::cli
