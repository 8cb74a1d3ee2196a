#include "scene/timeline.hpp"

#include "fuzz/scene_fuzz.hpp"
#include "scene/files/timeline_check.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/files/timeline_writer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace brume::scene;
  const auto timeline = parse_timeline(as_text(data, size), "t.toml");
  if (!timeline) return 0;
  // A timeline that was read can be written, and reads back the same.
  if (!check_settings(*timeline) || !check_events(*timeline)) __builtin_trap();
  const std::string written = format_timeline(*timeline, "");
  const auto again = parse_timeline(written, "t.toml");
  if (!again || format_timeline(*again, "") != written) __builtin_trap();
  for (double time = -0.5; time < 5; time += 0.25) {
    const Camera camera = camera_at(*timeline, Camera(), time);
    if (!std::isfinite(camera.position_world.x) || camera.position_world == camera.target_world)
      __builtin_trap();
    if (!(camera.vertical_fov > 0 && camera.vertical_fov < 3.15f)) __builtin_trap();
  }
  return 0;
}
