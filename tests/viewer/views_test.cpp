// Every debug view shows something different.
#include <X11/keysym.h>

#include "passes/debug_view.hpp"
#include "tests/viewer/room.hpp"

namespace brume::viewer {
namespace {

TEST(ViewsTest, ViewsAreNotBlankAndDifferFromEachOther) {
  const cli::WorkFolder folder;
  write_room(folder);
  const Desktop desktop;
  Program program(desktop, folder.path(),
                  {"room.toml", "--size", "192x128", "--quality", "half", "--bare", "--validation"});
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  program.click(1);
  ASSERT_TRUE(program.wait_for_clock(1.5));
  program.click(3);
  ASSERT_TRUE(program.wait_for_clock(0.3));
  program.tap(XK_p);
  ASSERT_TRUE(program.wait_for_best());
  std::vector<image::Image8> images{program.contents()};
  for (std::size_t view = 1; view < passes::kDebugViewNames.size(); ++view) {
    program.tap(XK_v);
    ASSERT_TRUE(program.wait_for_best()) << passes::kDebugViewNames[view];
    images.push_back(program.contents());
    EXPECT_GT(count_colours(images.back()), 2u) << passes::kDebugViewNames[view];
  }
  for (std::size_t i = 0; i < images.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(mean_difference(images[i], images[j]), 1)
          << passes::kDebugViewNames[i] << " and " << passes::kDebugViewNames[j];
  program.close();
  EXPECT_EQ(program.wait(), 0) << program.error();
}

}  // namespace
}  // namespace brume::viewer
