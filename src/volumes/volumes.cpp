#include "volumes/volumes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "core/log.hpp"
#include "core/numbered_files.hpp"
#include "scene/carrier.hpp"

namespace brume::volumes {
namespace {

namespace fs = std::filesystem;

/// The files of a sequence's frames, by number.
Result<std::map<std::int64_t, fs::path>> files_of(const scene::VolumeOptions& options) {
  auto found = numbered_files(options.file);
  const bool is_one = found.size() == 1 && found.begin()->second == options.file;
  std::erase_if(found, [&](const auto& one) {
    return !is_one &&
           ((options.first && one.first < *options.first) || (options.last && one.first > *options.last));
  });
  if (found.empty()) return Failure{ErrorCode::bad_input, options.file.string() + ": no such frames"};
  return found;
}

/// Names of density, heat, colours and masks, as chosen.
std::vector<std::string> chosen_grids(const scene::VolumeOptions& options) {
  std::vector<std::string> names{options.density, options.heat, options.color};
  for (const scene::VolumeMask& mask : options.masks) names.push_back(mask.grid);
  // Values below 0 are stored for the range.
  if (const auto shift = shift_of(options))
    names.push_back(std::to_string(shift->least) + ' ' + std::to_string(shift->offset));
  return names;
}

/// The number of the frame at a time, before missing ones are replaced; empty: none is shown.
std::optional<std::int64_t> number_at(const scene::VolumeOptions& options, std::int64_t first,
                                      std::int64_t last, double seconds) {
  // A frame whose start and rate are rounded to float32, within the first hours, does not show the one
  // before.
  constexpr double kRounding = 2e-3;
  const double frames = (seconds - double{options.start}) * double{options.frame_rate};
  const auto passed = static_cast<std::int64_t>(std::floor(frames + kRounding));
  const std::int64_t count = last - first + 1;
  const auto repeated = [&](std::int64_t period) { return (passed % period + period) % period; };
  if (options.clip && (passed < 0 || passed >= count)) return std::nullopt;
  if (options.loop) return first + repeated(count);
  if (options.ping_pong) {
    const std::int64_t period = std::max<std::int64_t>(2 * count - 2, 1);
    return first + std::min(repeated(period), period - repeated(period));
  }
  return first + std::clamp<std::int64_t>(passed, 0, count - 1);
}

/// A box around the voxels of a brick and its apron that are not 0, grown by the filter's reach, a voxel from
/// their centres [voxel space].
Box<float> dense_box(const volume::SparseVolume& volume, std::uint32_t slot) {
  const auto texels = volume.texels<std::uint16_t>(volume::ChannelId{0}, slot);
  const glm::vec3 apron = glm::vec3(shared::kBrickVoxels * volume.brick_of(slot) - 1);
  Box<float> box = kEmptyBox;
  for (int i = 0; i < static_cast<int>(shared::kTexelsPerBrick); ++i) {
    if (texels[static_cast<std::size_t>(i)] == 0) continue;
    constexpr int kEdge = shared::kBrickTexels;
    const glm::vec3 low = apron + glm::vec3(i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge)) - 0.5f;
    box = united(box, {low, low + 2.0f});
  }
  return box;
}

/// Frames of a sequence that are measured: its first and last, its largest file, and others evenly in
/// between.
constexpr std::size_t kMostMeasured = 12;
std::vector<std::int64_t> measured_numbers(const std::map<std::int64_t, fs::path>& files) {
  std::vector<std::int64_t> all, chosen;
  std::int64_t largest = files.begin()->first;
  std::uintmax_t most = 0;
  for (const auto& [number, file] : files) {
    all.push_back(number);
    std::error_code ignored;
    const std::uintmax_t bytes = fs::file_size(file, ignored);
    if (!ignored && bytes > most) {
      most = bytes;
      largest = number;
    }
  }
  const std::size_t count = std::min(all.size(), kMostMeasured);
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(all[count > 1 ? i * (all.size() - 1) / (count - 1) : 0]);
  chosen.push_back(largest);
  std::ranges::sort(chosen);
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

bool shows_nothing(const VolumeFrame& frame) {
  return frame.density.sum <= 0 && !frame.heat;
}

/// Whether the axes of a volume span space.
bool has_inverse(const scene::VolumeOptions& options) {
  const glm::dmat3 axes(options.x_axis, options.y_axis, options.z_axis);
  const double product = glm::length(axes[0]) * glm::length(axes[1]) * glm::length(axes[2]);
  return std::abs(glm::determinant(axes)) > 1e-9 * product;
}

VolumeAt placed(const LoadedVolume& loaded, const scene::VolumeOptions& options) {
  VolumeAt at{loaded.frame, loaded.preview, {}, {}, {}, {}};
  const glm::dmat4 world(world_from_file(options));
  const auto place = [&](const grids::BrickVolume& grid) { return glm::mat4(world * grid.world_from_voxel); };
  at.world_from_density = place(at.frame->density);
  if (at.frame->heat) at.world_from_heat = place(*at.frame->heat);
  if (at.preview && at.preview->density) at.world_from_density_preview = place(*at.preview->density);
  if (at.preview && at.preview->heat) at.world_from_heat_preview = place(*at.preview->heat);
  return at;
}

}  // namespace

glm::mat4 world_from_file(const scene::VolumeOptions& options) {
  const glm::mat4 matrix =
      glm::translate(glm::mat4(1), options.position_world) * scene::rotation_of(options.rotation);
  const glm::mat3 axes(options.x_axis, options.y_axis, options.z_axis);
  return glm::scale(matrix, glm::vec3(options.scale)) * glm::mat4(axes);
}

glm::vec2 range_of(const scene::VolumeOptions& options, const VolumeFrame& typical) {
  if (options.range) return *options.range;
  const float low = typical.density.low, high = typical.density.high;
  if (high > low) return {low, high};
  return {0, high > 0 ? high : 1};
}

scene::Volume place_of(const scene::VolumeOptions& options, const VolumeExtent& extent) {
  const glm::mat4 world = world_from_file(options);
  return {options.file.filename().string(), transformed(world, extent.bounds),
          transformed(world, extent.seen)};
}

std::vector<std::uint64_t> fair_parts(std::span<const std::uint64_t> wanted, std::uint64_t total) {
  std::vector<std::size_t> order(wanted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return wanted[i]; });
  std::vector<std::uint64_t> parts(wanted.size());
  std::uint64_t remaining = total;
  for (std::size_t done = 0; done < order.size(); ++done) {
    parts[order[done]] = std::min(wanted[order[done]], remaining / (order.size() - done));
    remaining -= parts[order[done]];
  }
  return parts;
}

std::vector<glm::vec3> corners_of(const scene::VolumeOptions& options, const Volumes& volumes,
                                  std::size_t i) {
  std::vector<glm::vec3> corners;
  if (volumes.is_sequence(i)) {
    const Box<float> seen = transformed(world_from_file(options), volumes.extent(i).seen);
    for (int corner = 0; corner < 8; ++corner)
      corners.push_back(glm::mix(seen.low, seen.high, glm::bvec3(corner & 1, corner & 2, corner & 4)));
    return corners;
  }
  const VolumeFrame& frame = volumes.typical_frame(i);
  const volume::SparseVolume& volume = *frame.density.volume;
  const glm::dmat4 world = glm::dmat4(world_from_file(options)) * frame.density.world_from_voxel;
  const VolumeExtent extent = volumes.extent(i);
  const glm::mat4 file_from_voxel(frame.density.world_from_voxel);
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
    if (!volume.in_use(slot)) continue;
    // A brick inside of others, whose aprons reach its corners, is inside of their hull.
    const volume::NeighbourSlots around = volume.slots_around(volume.brick_of(slot));
    if (std::ranges::find(around, volume::SparseVolume::kNoSlot) == around.end()) continue;
    const Box<float> box = dense_box(volume, slot);
    if (box.empty()) continue;
    if (extent.stray_part > 0 && intersection(transformed(file_from_voxel, box), extent.bounds).empty())
      continue;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 p = glm::mix(box.low, box.high, glm::bvec3(corner & 1, corner & 2, corner & 4));
      const glm::vec3 inside = glm::clamp(p, volume.layout().bounds_min, volume.layout().bounds_max);
      corners.emplace_back(world * glm::dvec4(inside, 1));
    }
  }
  return corners;
}

Result<std::shared_ptr<Volumes>> Volumes::load(std::span<const scene::VolumeOptions> options,
                                               grids::GridReader read) {
  auto volumes = std::make_shared<Volumes>();
  volumes->read_ = read;
  for (const scene::VolumeOptions& one : options) {
    const std::string where = one.place.empty() ? "" : one.place + ": ";
    if (!has_inverse(one))
      return Failure{ErrorCode::bad_input,
                     where + one.file.string() + ": its axes lie in a plane; expected three that span space"};
    auto files = files_of(one);
    if (!files) return Failure{files.failure().code, where + files.failure().message};
    Sequence sequence{one, std::move(*files)};
    auto frame = load_volume_frame(sequence.files.begin()->second, one, {}, nullptr, read);
    if (!frame) return frame.failure();
    sequence.in_kelvin = (*frame)->heat_is_kelvin;
    sequence.typical = sequence.shown = {std::move(*frame), nullptr};
    sequence.typical_number = sequence.shown_number = sequence.files.begin()->first;
    // Simulations begin with nothing.
    if (shows_nothing(*sequence.typical.frame) && sequence.files.size() > 1)
      for (const std::int64_t number : measured_numbers(sequence.files)) {
        auto other = load_volume_frame(sequence.files.at(number), one, {}, nullptr, read);
        if (!other || shows_nothing(**other)) continue;
        sequence.in_kelvin = sequence.in_kelvin || (*other)->heat_is_kelvin;
        sequence.typical = {std::move(*other), nullptr};
        sequence.typical_number = number;
        break;
      }
    if (shows_nothing(*sequence.typical.frame))
      log_warning(one.file.string() + ": nothing to see: no voxel is above 0");
    volumes->sequences_.push_back(std::move(sequence));
  }
  volumes->start_loader();
  return volumes;
}

/// Replaces the loader: what it has loaded or is loading is no longer useful.
void Volumes::start_loader() {
  struct Source {
    scene::VolumeOptions options;
    std::map<std::int64_t, fs::path> files;
    VolumeRoom room;
    bool in_kelvin;
  };
  // A copy: the thread shares nothing with the sequences.
  auto sources = std::make_shared<std::vector<Source>>();
  for (const Sequence& sequence : sequences_)
    sources->push_back({sequence.options, sequence.files, sequence.room, sequence.in_kelvin});
  loader_ = std::make_unique<VolumeLoader>(
      [sources, previews = has_previews_, read = read_](
          const VolumeLoader::Key& key, const std::atomic<bool>& stopped) -> Result<LoadedVolume> {
        const Source& source = (*sources)[key.volume];
        auto frame = load_volume_frame(source.files.at(key.number), source.options, source.room, &stopped,
                                       read, source.in_kelvin);
        if (!frame) return frame.failure();
        auto preview = previews ? volumes::make_previews(**frame) : nullptr;
        return LoadedVolume{std::move(*frame), std::move(preview)};
      });
}

Result<void> Volumes::choose_grids(std::size_t volume, const scene::VolumeOptions& options) {
  Sequence& sequence = sequences_[volume];
  if (chosen_grids(sequence.options) == chosen_grids(options)) return {};
  auto frame =
      load_volume_frame(sequence.files.at(sequence.typical_number), options, sequence.room, nullptr, read_);
  if (!frame) return frame.failure();
  sequence.in_kelvin = (*frame)->heat_is_kelvin;
  auto preview = has_previews_ ? volumes::make_previews(**frame) : nullptr;
  sequence.typical = sequence.shown = {std::move(*frame), std::move(preview)};
  sequence.shown_number = sequence.typical_number;
  sequence.extent.reset();
  sequence.unreadable.clear();
  sequence.options = options;
  start_loader();
  return {};
}

Result<void> Volumes::limit(const VolumeRoom& room) {
  std::vector<std::uint64_t> bricks, pages;
  for (const Sequence& sequence : sequences_) {
    const VolumeRoom takes = room_of(*sequence.typical.frame);
    bricks.push_back(takes.bricks);
    pages.push_back(takes.pages);
  }
  const std::vector<std::uint64_t> brick_parts = fair_parts(bricks, room.bricks),
                                   page_parts = fair_parts(pages, room.pages);
  VolumeRoom unused = room;
  for (std::size_t i = 0; i < sequences_.size(); ++i) {
    Sequence& sequence = sequences_[i];
    VolumeRoom takes{bricks[i], pages[i]};
    if (brick_parts[i] < bricks[i] || page_parts[i] < pages[i]) {
      auto frame = load_volume_frame(sequence.files.at(sequence.typical_number), sequence.options,
                                     {brick_parts[i], page_parts[i]}, nullptr, read_, sequence.in_kelvin);
      if (!frame) return frame.failure();
      sequence.typical = sequence.shown = {std::move(*frame), nullptr};
      sequence.shown_number = sequence.typical_number;
      takes = room_of(*sequence.typical.frame);
    }
    sequence.room = takes;
    unused.bricks -= std::min(unused.bricks, takes.bricks);
    unused.pages -= std::min(unused.pages, takes.pages);
  }
  // Later frames may be larger.
  for (Sequence& sequence : sequences_) {
    sequence.room.bricks += unused.bricks / sequences_.size();
    sequence.room.pages += unused.pages / sequences_.size();
  }
  if (has_previews_) make_previews();
  start_loader();
  return {};
}

void Volumes::make_previews() {
  has_previews_ = true;
  for (Sequence& sequence : sequences_)
    for (LoadedVolume* loaded : {&sequence.typical, &sequence.shown})
      if (!loaded->preview) loaded->preview = volumes::make_previews(*loaded->frame);
  start_loader();
}

std::int64_t Volumes::length(std::size_t volume) const {
  const auto& files = sequences_[volume].files;
  return files.rbegin()->first - files.begin()->first + 1;
}

Result<std::shared_ptr<const VolumeFrame>> Volumes::load_frame(const Sequence& sequence,
                                                               std::int64_t number) const {
  return load_volume_frame(sequence.files.at(number), sequence.options, sequence.room, nullptr, read_,
                           sequence.in_kelvin);
}

void Volumes::measure_sequence(std::size_t volume) {
  Sequence& sequence = sequences_[volume];
  const bool was_in_kelvin = sequence.in_kelvin;
  measure(sequence);
  if (sequence.in_kelvin == was_in_kelvin) return;
  // Measure again, without the frames whose heat was taken for factors of a temperature.
  for (const auto& [loaded, number] :
       {std::pair(&sequence.typical, sequence.typical_number), {&sequence.shown, sequence.shown_number}})
    if (auto frame = load_frame(sequence, number)) *loaded = {std::move(*frame), nullptr};
  measure(sequence);
  if (has_previews_) make_previews();
  start_loader();
}

void Volumes::measure(Sequence& sequence) {
  sequence.extent = extent_of(*sequence.typical.frame);
  for (const std::int64_t number : measured_numbers(sequence.files)) {
    if (number == sequence.typical_number) continue;
    // A frame that cannot be read causes a warning when it is shown.
    auto frame = load_frame(sequence, number);
    if (!frame || shows_nothing(**frame)) continue;
    sequence.in_kelvin = sequence.in_kelvin || (*frame)->heat_is_kelvin;
    const VolumeExtent own = extent_of(**frame);
    VolumeExtent& all = *sequence.extent;
    all.bounds = united(all.bounds, own.bounds);
    all.seen = united(all.seen, own.seen);
    all.stray_part = std::max(all.stray_part, own.stray_part);
    all.stray_reach = std::max(all.stray_reach, own.stray_reach);
    all.glow.insert(all.glow.end(), own.glow.begin(), own.glow.end());
    all.hottest = std::max(all.hottest, own.hottest);
    if (own.depth <= all.depth) continue;
    all.depth = own.depth;
    sequence.typical = {std::move(*frame), nullptr};
    sequence.typical_number = number;
  }
}

VolumeExtent Volumes::extent(std::size_t volume) const {
  const Sequence& sequence = sequences_[volume];
  return sequence.extent ? *sequence.extent : extent_of(*sequence.typical.frame);
}

/// The frame that a time shows: the one before a missing one. Empty: none.
std::optional<std::int64_t> Volumes::frame_at(const Sequence& sequence, const scene::VolumeOptions& options,
                                              double seconds) const {
  const auto& files = sequence.files;
  const auto number = number_at(options, options.first.value_or(files.begin()->first),
                                options.last.value_or(files.rbegin()->first), seconds);
  if (!number) return std::nullopt;
  const auto after = files.upper_bound(*number);
  return after == files.begin() ? after->first : std::prev(after)->first;
}

/// The frame that follows in time, if it is to be loaded.
std::optional<std::int64_t> Volumes::frame_after(const Sequence& sequence,
                                                 const scene::VolumeOptions& options,
                                                 std::int64_t number) const {
  auto next = sequence.files.upper_bound(number);
  if (next == sequence.files.end()) {
    if (!options.loop) return std::nullopt;
    next = sequence.files.begin();
  }
  if (next->first == sequence.shown_number || sequence.unreadable.contains(next->first)) return std::nullopt;
  return next->first;
}

void Volumes::show(std::size_t volume, std::int64_t number, Result<LoadedVolume> loaded) {
  Sequence& sequence = sequences_[volume];
  sequence.shown_number = number;
  if (loaded) {
    sequence.shown = std::move(*loaded);
  } else {
    log_warning(loaded.failure().message + "; the frame before it is shown");
    sequence.unreadable.insert(number);
  }
}

std::vector<VolumeAt> Volumes::at(std::span<const scene::VolumeOptions> options, double seconds,
                                  VolumeWait wait) {
  BRUME_ASSERT(options.size() == sequences_.size(), std::to_string(options.size()));
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (const auto done = choose_grids(i, options[i]); !done) {
      log_warning(done.failure().message + "; the grids before are shown");
      sequences_[i].options = options[i];
    }
  }
  // What to load: the frames of this time, then those after them.
  std::vector<VolumeLoader::Key> wanted, ahead;
  std::vector<bool> is_shown(options.size(), false);
  for (std::size_t i = 0; i < options.size(); ++i) {
    const auto number = frame_at(sequences_[i], options[i], seconds);
    if (!number) continue;
    is_shown[i] = true;
    if (*number != sequences_[i].shown_number && !sequences_[i].unreadable.contains(*number))
      wanted.push_back({i, *number});
    if (const auto next = frame_after(sequences_[i], options[i], *number)) ahead.push_back({i, *next});
  }
  std::vector<VolumeLoader::Key> all = wanted;
  all.insert(all.end(), ahead.begin(), ahead.end());
  VolumeLoader::Results late = loader_->want(all);

  // Show what is loaded.
  is_behind_ = false;
  for (const VolumeLoader::Key& key : wanted) {
    auto loaded = wait == VolumeWait::until_loaded ? loader_->wait(key) : loader_->take(key);
    is_behind_ |= !loaded;
    if (loaded) {
      show(key.volume, key.number, std::move(*loaded));
      continue;
    }
    for (auto& [other, result] : late)
      if (other.volume == key.volume && result) show(other.volume, other.number, std::move(result));
  }
  std::vector<VolumeAt> volumes;
  for (std::size_t i = 0; i < options.size(); ++i)
    volumes.push_back(is_shown[i] ? placed(sequences_[i].shown, options[i]) : VolumeAt{});
  return volumes;
}

std::vector<fs::path> Volumes::files() const {
  std::vector<fs::path> files;
  for (const Sequence& sequence : sequences_)
    for (const auto& [number, file] : sequence.files) files.push_back(file);
  return files;
}

}  // namespace brume::volumes
