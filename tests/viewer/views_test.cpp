// Every debug view shows something different.
#include <X11/keysym.h>

#include "passes/debug_view.hpp"
#include "tests/viewer/room.hpp"

namespace brume::viewer {
namespace {

TEST(ViewsTest, ViewsAreNotBlankAndDifferFromEachOther) {
  const cli::WorkFolder folder;
  // Paused at a time, whatever the pace of the program.
  write_room(folder,
             "[[event]]\ntype = \"smoke\"\ntime = 0.0\nfrom = [0.5, 1.6, 3.2]\nat = [0.3, 0.2, 0.0]\n"
             "[[event]]\ntype = \"shot\"\ntime = 1.7\nfrom = [0.5, 1.6, 3.2]\ntoward = [0.2, 1.3, -3.0]\n");
  const Desktop desktop;
  Program program(desktop, folder.path(),
                  {"--play", "room.toml", "--time", "2.1", "--size", "192x128", "--quality", "half", "--bare",
                   "--validation"});
  ASSERT_TRUE(program.wait_for_window()) << program.error();
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
