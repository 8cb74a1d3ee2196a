// A level that is played in a window.
#include <cmath>

#include "apps/viewer/autosave.hpp"
#include "apps/viewer/document.hpp"
#include "apps/viewer/level_refiner.hpp"
#include "apps/viewer/ui_parts.hpp"
#include "core/log.hpp"
#include "scene/files/timeline_writer.hpp"

namespace brume::viewer {
namespace {

// Weight of the newest frame in the pace of the time.
constexpr double kPaceWeight = 0.3;

Choices first_choices(const ViewerOptions& options) {
  Choices choices;
  static_cast<WindowChoices&>(choices) = first_window_choices(options);
  choices.weapons = options.weapons;
  choices.pictures.open(options.weapons.picture.empty() ? "." : options.weapons.picture.parent_path());
  choices.view = options.view;
  choices.level = options.level;
  choices.frames_per_second = options.frames_per_second;
  return choices;
}

class LevelDocument final : public Document {
 public:
  LevelDocument(Window& window, ScenarioLoader load, bool play, const ViewerOptions& options)
      : window_(window),
        load_(std::move(load)),
        plays_(play),
        options_(options),
        autosave_(options.folder),
        quality_(options.frames_per_second) {}

  // Loading.

  Work making() const override {
    return {"1 of 2: reading the level, finding its solid voxels",
            "2 of 2: preparing textures, shadows and shaders"};
  }
  Maker make() override {
    return
        [this](const std::function<bool()>&) { loaded_ = Session::create(load_(), plays_).value_or_throw(); };
  }

  void prepare(Screen& screen, bool /*takes_made*/) override {
    refiner_.emplace(screen, window_, scenario(), options_.volume_bytes, game_, quality_);
    masks_ = scenario().masks.key();
    if (!loaded_ || !scenario().measure_exposure) return;
    std::vector<shared::Hole> holes;
    const float factor = refiner_->measure_exposure(
        scenario::frame_input(scenario(), loaded_->simulation(), loaded_->seconds(), holes));
    loaded_->set_first_exposure(std::log2(factor)).value_or_throw();
  }

  void adopt() override {
    if (!loaded_) return;
    game_.emplace(std::move(loaded_), first_choices(options_),
                  [this](const std::string& line) { notify(line); });
    if (options_.begin_at) {
      session().seek(*options_.begin_at);
      session().set_paused(!options_.exit_after);
    }
    for (const std::filesystem::path& file : recover_sessions(options_.folder)) {
      const std::string line = "a session that ended early is recovered: brume view --play " + file.string();
      log_warning(line);
      notify(line);
    }
  }
  bool is_loaded() const override { return game_.has_value(); }
  void release() override { refiner_.reset(); }

  // Input.

  void act(Action action) override { game_->act(action, aim()); }

  // Stops the clock at exactly exit_after.
  bool advance(double frame_seconds) override {
    const double passes = session().passing(frame_seconds);
    if (!session().paused() && frame_seconds > 0) pace_ += kPaceWeight * (passes / frame_seconds - pace_);
    const double next = session().seconds() + passes;
    // A seek without need would make the light in the smoke start over.
    const bool ends = options_.exit_after && next >= *options_.exit_after;
    if (ends || passes > 0) session().seek(ends ? std::max(*options_.exit_after, seconds()) : next);
    return ends;
  }
  void move(const Input& input, double frame_seconds, bool /*has_cursor*/) override {
    for (const std::filesystem::path& file : input.dropped) game_->choose_picture(file);
    game_->move(input, frame_seconds);
  }
  void apply(const UiRequests& requests) override {
    if (requests.play) session().play();
    if (requests.seek) session().scrub(*requests.seek);
  }
  void settle() override { game_->settle(); }
  // The mouse turns the view unless the cursor is needed.
  bool captures_mouse(const Input& input) const override {
    const Choices& choices = game_->choices();
    return !choices.panels && !choices.help && !choices.free_cursor && !input.is_held(Action::free_cursor);
  }

  void update(bool new_shaders) override {
    update_autosave();
    if (const sim::MaskKey key = scenario().masks.key(); !(key == masks_)) {
      refiner_->set_masks(scenario().masks);
      masks_ = key;
    }
    if (new_shaders) game_->change_picture();
    const Choices& choices = game_->choices();
    quality_.set_frame_rate(choices.frames_per_second);
    if (!choices.level) {
      quality_.set_automatic();
    } else if (quality_.automatic() || quality_.level() != *choices.level) {
      quality_.fix(*choices.level);
    }
  }
  double seconds() const override { return session().seconds(); }
  double end_seconds() const override { return session().end_seconds(); }
  WindowChoices& choices() override { return game_->choices(); }

  // User interface.

  void lay_out_marks() override {
    if (game_->choices().overlay) lay_out_shot_marks(*game_);
    lay_out_level_marks(*game_);
  }
  void lay_out_status() override { lay_out_level_status(*game_, figures_, notices()); }
  bool shows_hint() const override { return figures_.count() < 600 && !game_->choices().help; }
  void lay_out_sections(const Status& status, UiRequests& requests) override {
    lay_out_level_sections(*game_, figures_, notices(), status, requests);
  }
  void lay_out_buttons(UiRequests& requests) override { lay_out_level_buttons(session(), requests); }
  void mark_times(const TimeMark& mark) const override { mark_events(scenario().timeline, mark); }
  KeyMap keys() const override { return KeyMap::level; }
  const char* help_note() const override { return "Time stands still while this is open. H closes it."; }

  // Frames.

  Refiner& refiner() override { return *refiner_; }
  void finish_frame(FrameFigures figures, PictureKind kind) override {
    // The first frame has no duration, and paused frames are no measure of the cost of the film.
    if (figures.frame_ms == 0 || kind != PictureKind::film) return;
    double device_ms = 0;
    for (const auto& pass : figures.passes) device_ms += pass.milliseconds;
    // Excludes waiting for vertical sync.
    figures.work_ms = device_ms + figures.tick_ms + 1e3 * refiner_->record_seconds();
    quality_.add_frame(1e-3 * figures.work_ms, 1e-3 * figures.frame_ms);
    figures_.add(std::move(figures));
  }
  bool is_at_rest() const override { return session().paused(); }

  // Files.

  Result<void> save_snapshot(const std::filesystem::path& path) override {
    return scene::save_timeline(path, game_->snapshot());
  }
  const char* name_of_recording() const override { return "recording"; }
  Result<void> save_recording(const std::filesystem::path& path) override {
    return say_saved(path, scene::save_timeline(path, session().recording()));
  }
  void discard() override { autosave_.discard(); }
  void rescue() override {
    if (!game_) return;
    const auto saved = autosave_.finish(session());
    if (!saved) log_warning("the session is lost: " + saved.failure().message);
    if (saved && *saved)
      log_warning("the session is saved in " + autosave_.file().string() + "; brume view recovers it");
  }

  void report(ViewerReport& report) const override {
    LevelReport level;
    level.quality = quality_.quality().name;
    report.frames = figures_.count();
    level.frames_per_second = figures_.frames_per_second();
    level.work_ms = figures_.median(&FrameFigures::work_ms);
    level.latency_ms = figures_.median(&FrameFigures::latency_ms);
    level.tick_ms = figures_.median(&FrameFigures::tick_ms);
    for (const std::string& name : figures_.pass_names())
      level.passes_ms.emplace_back(name, figures_.pass_median(name));
    if (game_) {
      report.seconds = session().seconds();
      level.tick = session().simulation().world().tick();
      level.state_hash = session().simulation().world().state_hash();
    }
    report.document = std::move(level);
  }

 private:
  Session& session() { return game_->session(); }
  const Session& session() const { return game_->session(); }
  const scenario::Scenario& scenario() const { return (loaded_ ? *loaded_ : session()).live().scenario(); }
  /// Where the player aims.
  glm::vec3 aim() const {
    const glm::vec2 size(glm::max(window_.size_px(), glm::uvec2(1)));
    const glm::vec2 point = window_.captures_mouse() ? glm::vec2(0.5f) : window_.cursor_px() / size;
    return direction_through(game_->player().camera(), size.x / size.y,
                             glm::clamp(point, glm::vec2(0), glm::vec2(1)));
  }
  // Failures also go to the terminal, which outlives the window.
  void update_autosave() {
    const auto saved = autosave_.update(session());
    if (saved) return;
    notify(saved.failure().message);
    log_warning("the session cannot be saved: " + saved.failure().message);
  }
  Notices notices() const {
    const Refinement refinement = !session().paused()   ? Refinement::none
                                  : refiner_->is_best() ? Refinement::done
                                                        : Refinement::drawing;
    return {quality_.quality(), quality_.automatic(), refinement, pace_, refiner_->picture_px()};
  }

  Window& window_;
  ScenarioLoader load_;
  bool plays_;
  const ViewerOptions& options_;
  Autosave autosave_;
  QualityControl quality_;
  std::unique_ptr<Session> loaded_;  ///< Until it is the game's.
  std::optional<Game> game_;         ///< Empty while the level loads.
  std::optional<LevelRefiner> refiner_;
  sim::MaskKey masks_{};  ///< Key of the masks that the refiner has.
  Figures figures_;
  double pace_ = 1;  ///< Session time per real time, smoothed.
};

}  // namespace

std::unique_ptr<Document> make_document(Window& window, ScenarioLoader load, bool play,
                                        const ViewerOptions& options) {
  return std::make_unique<LevelDocument>(window, std::move(load), play, options);
}

}  // namespace brume::viewer
