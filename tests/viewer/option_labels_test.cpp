// The settings of each panel have labels of their own.

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "apps/viewer/option_panel.hpp"
#include "scenario/walker.hpp"
#include "scene/event_fields.hpp"
#include "scene/tank_options.hpp"
#include "scene/tank_scene.hpp"
#include "scene/timeline.hpp"

namespace brume::viewer {
namespace {

using VisitInfo = std::function<void(const scene::OptionInfo&)>;

/// The settings of a struct, and a name for them.
struct Table {
  const char* name;
  std::function<void(const VisitInfo&)> visit;
};

template <typename Options, typename Visit>
Table table(const char* name, Visit visit) {
  return {name, [visit](const VisitInfo& info) {
            const Options options;
            visit(options, [&]<typename Info>(const Info& each, const auto&) {
              if constexpr (std::is_same_v<Info, scene::OptionInfo>) info(each);
            });
          }};
}

class OptionLabelsTest : public testing::TestWithParam<Table> {};

TEST_P(OptionLabelsTest, EverySettingHasALabelOfItsOwn) {
  std::set<std::string> labels;
  GetParam().visit([&](const scene::OptionInfo& info) {
    const std::string label = label_of(info);
    EXPECT_TRUE(labels.insert(label).second) << label;
  });
  EXPECT_FALSE(labels.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Panels, OptionLabelsTest,
    testing::Values(
        table<scene::SmokeOptions>("Smoke", [](auto& o, auto&& v) { scene::visit_smoke_options(o, v); }),
        table<scene::SkyOptions>("Sky", [](auto& o, auto&& v) { scene::visit_sky_options(o, v); }),
        table<scene::Timeline>("Light", [](auto& o, auto&& v) { scene::visit_picture_options(o, v); }),
        table<scene::TankScene>("TankFilm", [](auto& o, auto&& v) { scene::visit_film_options(o, v); }),
        table<scene::Camera>("Camera", [](auto& o, auto&& v) { scene::visit_camera_options(o, v); }),
        table<scenario::WalkerOptions>("Body",
                                       [](auto& o, auto&& v) { scenario::visit_walker_options(o, v); }),
        table<scene::TankScene>("TankPicture",
                                [](auto& o, auto&& v) { scene::visit_tank_picture_options(o, v); }),
        table<spheres::PackOptions>("Packing", [](auto& o, auto&& v) { scene::visit_pack_options(o, v); }),
        table<scene::TankFog>("Fog", [](auto& o, auto&& v) { scene::visit_fog_options(o, v); }),
        table<scene::TankLight>("TankLights",
                                [](auto& o, auto&& v) { scene::visit_tank_light_options(o, v); }),
        table<scene::TankGlass>("Glass", [](auto& o, auto&& v) { scene::visit_glass_options(o, v); })),
    [](const auto& each) { return each.param.name; });

TEST(EventLabelsTest, EverySettingHasALabelOfItsOwn) {
  scene::for_each_event_kind([](const char* kind, auto list) {
    using Event = std::remove_reference_t<decltype((scene::EventLists().*list).front())>;
    std::set<std::string> labels;
    const Event event;
    scene::visit_event_numbers(event, [&](const scene::OptionInfo& info, const auto&) {
      const std::string label = label_of(info);
      EXPECT_TRUE(labels.insert(label).second) << kind << ": " << label;
    });
  });
}

TEST(LabelsTest, AreTheWordsOfAKeyWithoutOne) {
  EXPECT_EQ(label_of({"two_words", "", "", 0, 1}), "two words");
  EXPECT_EQ(label_of({"two_words", "", "", 0, 1, "others"}), "others");
}

}  // namespace
}  // namespace brume::viewer
