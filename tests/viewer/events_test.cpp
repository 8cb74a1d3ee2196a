// A thousand random keys, clicks, mouse moves and resizes: no crash, no validation message, no memory leak.
#include "passes/debug_view.hpp"
#include "tests/viewer/random_events.hpp"
#include "tests/viewer/room.hpp"

namespace brume::viewer {
namespace {

constexpr int kEvents = 1000;

// Memory grows by less than half of a leak of one window-sized image per drawn frame: that of malloc, that of
// the device, and what drivers and stacks map. All count what is allocated. Resident memory also grows when
// earlier allocations are first touched, and with fragmentation, by 15 to 30 MB within a thousand events.
void expect_no_growth(const std::vector<Frame>& frames, std::size_t from) {
  double forgotten = 0;
  for (std::size_t i = from + 1; i < frames.size(); ++i)
    forgotten += 4.0 * frames[i].size_px.x * frames[i].size_px.y;
  const auto grown = [&](std::uint64_t Frame::*bytes) {
    return static_cast<double>(frames.back().*bytes) - static_cast<double>(frames[from].*bytes);
  };
  testing::Test::RecordProperty("frames", std::to_string(frames.size() - from - 1));
  testing::Test::RecordProperty("forgotten_bytes", std::to_string(forgotten));
  testing::Test::RecordProperty("heap_grown_bytes", std::to_string(grown(&Frame::heap_bytes)));
  testing::Test::RecordProperty("device_grown_bytes", std::to_string(grown(&Frame::device_bytes)));
  testing::Test::RecordProperty("mapped_grown_bytes", std::to_string(grown(&Frame::mapped_bytes)));
  EXPECT_LT(grown(&Frame::heap_bytes), forgotten / 2);
  EXPECT_LT(grown(&Frame::device_bytes), forgotten / 2);
  EXPECT_LT(grown(&Frame::mapped_bytes), forgotten / 2);
}

void tap(Program& program, unsigned long key) {
  program.tap(key);
  program.wait_for_frames(2);
}

// All debug views, then none: while it plays, and for the full-quality image, which other pipelines draw.
void show_views(Program& program) {
  for (std::size_t view = 0; view < passes::kDebugViewNames.size(); ++view) tap(program, XK_v);
  tap(program, XK_p);
  for (std::size_t view = 0; view < passes::kDebugViewNames.size(); ++view) {
    program.tap(XK_v);
    ASSERT_TRUE(program.wait_for_best()) << passes::kDebugViewNames[view] << ": " << program.error();
  }
  tap(program, XK_p);
}

// Does everything once, so that all lazily created resources exist: about 150 MB in steps of 2 to 25 MB,
// which in random order appear as late as after 3,000 events. A debug view creates its pipeline when it is
// first shown, and lavapipe compiles a shader concurrently when it is first dispatched.
void warm_up(Program& program) {
  program.tap(XK_F11);
  EXPECT_TRUE(program.wait_for_frame([](const Frame& now) { return now.size_px.x == 1280; }));
  program.wait_for_frames(2);
  program.tap(XK_F11);
  EXPECT_TRUE(program.wait_for_frame([](const Frame& now) { return now.size_px.x == 160; }));
  show_views(program);
  program.click(1);
  program.wait_for_clock(1);
  show_views(program);
  for (const unsigned long shape : {XK_4, XK_3, XK_2, XK_1}) {
    tap(program, shape);
    program.click(3);
  }
  program.wait_for_clock(0.1);
  show_views(program);
  for (const unsigned long key : kKeys)
    if (key != XK_p && key != XK_r && key != XK_v && key != XK_comma && key != XK_period) tap(program, key);
  for (const unsigned long key : {XK_comma, XK_period, XK_p, XK_r}) tap(program, key);
}

TEST(EventsTest, SurvivesAThousandRandomEvents) {
  const cli::WorkFolder folder;
  write_room(folder);
  const Desktop desktop;
  Program program(
      desktop, folder.path(),
      {"room.toml", "--size", "160x96", "--quality", "smallest", "--validation", "--json", "r.json"});
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  warm_up(program);
  const std::size_t warm = program.frames().size() - 1;
  RandomEvents().send(program, kEvents);
  ASSERT_TRUE(program.runs()) << program.error();
  const std::vector<Frame> frames = program.frames();
  program.close();
  EXPECT_EQ(program.wait(), 0) << program.error();
  EXPECT_GE(frames.size() - 1 - warm, std::size_t{kEvents});
  expect_no_growth(frames, warm);
  const auto report = read_json(folder.path() / "r.json");
  ASSERT_TRUE(report.is_object());
  EXPECT_TRUE(report.at("validation_messages").empty()) << report.at("validation_messages").dump();
}

}  // namespace
}  // namespace brume::viewer
