// A tank of spheres that is edited in a window.
#include <algorithm>

#include "apps/viewer/document.hpp"
#include "apps/viewer/screenshot.hpp"
#include "apps/viewer/tank_mouse.hpp"
#include "apps/viewer/tank_refiner.hpp"
#include "apps/viewer/tank_ui.hpp"
#include "scene/files/tank_writer.hpp"
#include "spheres/file.hpp"

namespace brume::viewer {
namespace {

// Part of the tank's longest side that a held key moves the camera in a second; a slow frame counts as this
// time [s].
constexpr float kGlideSpeed = 0.5f;
constexpr double kLongestGlide = 0.25;

class TankDocument final : public Document {
 public:
  TankDocument(Window& window, TankMaker make, bool play, const ViewerOptions& options)
      : window_(window), make_(std::move(make)), plays_(play), options_(options) {
    static_cast<WindowChoices&>(choices_) = first_window_choices(options);
  }

  // Loading.

  Work making() const override {
    return {state_ ? "packing spheres" : "loading or packing spheres", "", true};
  }
  Maker make() override {
    TankMaker make = make_;
    if (state_)
      make = [scene = state_->scene()](const std::function<bool()>& stopped) {
        return scenario::TankScenario{scene, scenario::make_tank(scene, stopped).value_or_throw()};
      };
    return [this, make = std::move(make)](const std::function<bool()>& stopped) {
      scenario::TankScenario scenario = make(stopped);
      made_ = Made{std::move(scenario), !stopped()};
    };
  }

  void prepare(Screen& screen, bool takes_made) override {
    if (!refiner_) refiner_.emplace(screen, state_, tank_);
    const bool is_new = takes_made && made_;
    try {
      refiner_->load(is_new ? made_->scenario.tank : tank_, window_.size_px());
    } catch (const gpu::DeviceLost&) {
      throw;
    } catch (const Error&) {
      if (!is_new || !state_) throw;
      made_.reset();
      refiner_->load(tank_, window_.size_px());
      throw;
    }
  }

  void adopt() override {
    if (!made_) return;
    Made made = std::move(*made_);
    made_.reset();
    tank_ = std::move(made.scenario.tank);
    const glm::vec3 size = planning::size_of(tank_);
    if (state_) {
      ++packings_;
      state_->set_packed(made.scenario.scene, size, made.is_complete);
      return notify("packed " + std::to_string(tank_.spheres.size()) + " spheres");
    }
    state_.emplace(std::move(made.scenario.scene), size);
    state_->set_packed(state_->scene(), size, made.is_complete);
    state_->set_playing(plays_);
    run_seconds_ = options_.begin_at.value_or(0);
    if (options_.begin_at) state_->seek(*options_.begin_at);
  }
  bool is_loaded() const override { return state_.has_value(); }
  void release() override { refiner_.reset(); }

  // Input.

  void act(Action action) override {
    choices_.act(action);
    if (action == Action::help) choices_.help = !choices_.help;
    if (action == Action::pause) state_->set_playing(!state_->is_playing());
    if (action == Action::rewind) state_->seek(0);
    if (action == Action::next_view) {
      scene::TankView& view = state_->edit().view;
      view = view == scene::TankView::spheres ? scene::TankView::voxels : scene::TankView::spheres;
    }
    if (action == Action::undo) state_->undo();
    if (action == Action::redo) state_->redo();
    if (action == Action::camera_path) state_->set_follows_path(!state_->follows_path());
    if (action == Action::home) state_->go_home();
    if (action == Action::focus) state_->focus_on_middle(tank_);
    if (action != Action::save_tank) return;
    const std::filesystem::path path = free_name(options_.folder, "spheres", ".spheres");
    (void)say_saved(path, spheres::save_tank(path, tank_));
  }

  // Stops the time at exactly exit_after.
  bool advance(double frame_seconds) override {
    if (!options_.exit_after) {
      state_->advance(frame_seconds);
      return false;
    }
    run_seconds_ = std::min(run_seconds_ + frame_seconds, *options_.exit_after);
    state_->seek(run_seconds_);
    return run_seconds_ == *options_.exit_after;
  }

  void move(const Input& input, double frame_seconds, bool has_cursor) override {
    mouse_.update(*state_, choices_, input, window_.cursor_px(), glm::vec2(window_.size_px()), has_cursor);
    const auto held = [&](Action positive, Action negative) {
      return static_cast<float>(input.is_held(positive)) - static_cast<float>(input.is_held(negative));
    };
    const glm::vec3 steps(held(Action::right, Action::left), held(Action::up, Action::down),
                          held(Action::forward, Action::back));
    if (steps == glm::vec3(0)) return;
    const glm::vec3 size = state_->size();
    const float speed = kGlideSpeed * std::max({size.x, size.y, size.z});
    const auto seconds = static_cast<float>(std::min(frame_seconds, kLongestGlide));
    state_->move_camera(glided(state_->camera(), steps * (speed * seconds)));
  }
  void apply(const UiRequests& requests) override {
    if (!requests.seek) return;
    state_->set_playing(false);
    state_->seek(*requests.seek);
  }
  void settle() override {
    if (!mouse_.is_dragging()) state_->settle();
  }
  void update(bool new_shaders) override {
    if (new_shaders) refiner_->restart();
  }
  double seconds() const override { return state_->seconds(); }
  double end_seconds() const override { return double{state_->scene().duration}; }
  WindowChoices& choices() override { return choices_; }

  // User interface.

  void lay_out_marks() override {
    if (choices_.overlay) lay_out_tank_marks(*state_, choices_, mouse_.hovered());
  }
  void lay_out_status() override { lay_out_tank_status(*state_, figures()); }
  bool shows_hint() const override { return !choices_.help && !choices_.panels; }
  void lay_out_sections(const Status& status, UiRequests& requests) override {
    lay_out_tank_sections(*state_, choices_, figures(), status, requests);
  }
  void lay_out_buttons(UiRequests& requests) override { lay_out_tank_buttons(*state_, requests); }
  void mark_times(const TimeMark& mark) const override { mark_keys(state_->scene(), mark); }
  KeyMap keys() const override { return KeyMap::tank; }
  const char* help_note() const override { return "The wheel: nearer or farther. H closes this."; }

  // Frames.

  Refiner& refiner() override { return *refiner_; }
  // Voxels need more memory than spheres.
  bool fall_back(const Error& error) override {
    if (state_->scene().view == scene::TankView::spheres) return false;
    notify(error.what());
    state_->edit().view = scene::TankView::spheres;
    refiner_->restart();
    return true;
  }
  void finish_frame(FrameFigures, PictureKind) override {
    refiner_->measure();
    ++frames_;
  }
  bool is_at_rest() const override { return !state_->is_playing() && !options_.exit_after; }

  // Files.

  Result<void> save_snapshot(const std::filesystem::path& path) override {
    auto saved = scene::save_tank_scene(path, state_->snapshot(refiner_->samples()));
    if (saved && !state_->is_complete())
      notify("the saved scene packs the full tank; to keep these spheres, save the tank too");
    return saved;
  }
  const char* name_of_recording() const override { return "tank"; }
  Result<void> save_recording(const std::filesystem::path& path) override {
    return say_saved(path, scene::save_tank_scene(path, state_->to_save()));
  }

  void report(ViewerReport& report) const override {
    report.frames = frames_;
    TankReport tank{tank_.spheres.size(), 0, glm::uvec2(0), packings_};
    if (state_) {
      report.seconds = options_.exit_after ? run_seconds_ : state_->seconds();
      tank.samples = refiner_->samples();
      tank.picture_px = refiner_->picture_px();
    }
    report.document = tank;
  }

 private:
  TankFigures figures() const {
    return {refiner_->samples(), refiner_->seconds(), refiner_->is_moving(), refiner_->picture_px(),
            tank_.spheres.size()};
  }

  /// What make() made.
  struct Made {
    scenario::TankScenario scenario;
    bool is_complete = true;
  };

  Window& window_;
  TankMaker make_;
  bool plays_;
  const ViewerOptions& options_;
  std::optional<Made> made_;        ///< Until it is shown.
  std::optional<TankState> state_;  ///< Empty while the first tank is made.
  spheres::Tank tank_;
  std::optional<TankRefiner> refiner_;
  TankChoices choices_;
  TankMouse mouse_;
  double run_seconds_ = 0;  ///< Time on the way to options_.exit_after.
  std::uint64_t frames_ = 0;
  std::size_t packings_ = 0;
};

}  // namespace

std::unique_ptr<Document> make_document(Window& window, TankMaker make, bool play,
                                        const ViewerOptions& options) {
  return std::make_unique<TankDocument>(window, std::move(make), play, options);
}

}  // namespace brume::viewer
