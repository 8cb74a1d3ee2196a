// Events and ticks of a World.
#include "python/world.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>

#include "python/bytes.hpp"
#include "scenario/level_events.hpp"
#include "wire/packet.hpp"

namespace brume::python {
namespace {

/// Most voxels of one set_solid.
constexpr std::uint64_t kMaxEditVoxels = 1ull << 27;
/// Ticks between two looks for Ctrl-C.
constexpr std::uint32_t kTicksAtOnce = 1024;

smoke::MaskAtlas pack_masks(const std::vector<py::array>& images) {
  std::vector<smoke::Mask> masks;
  for (const py::array& image : images) {
    if (image.dtype().kind() != 'u' || image.dtype().itemsize() != 1)
      throw py::type_error("masks: expected arrays of uint8");
    if (image.ndim() != 2) refuse("masks", "expected the shape (height, width), got " + shape_text(image));
    if (image.size() > py::ssize_t{smoke::kMaxMaskAxis} * smoke::kMaxMaskAxis)
      throw Error(ErrorCode::resource_limit, "masks: an image of more than 4094 x 4094 texels");
    const auto texels = py::array_t<std::uint8_t, py::array::c_style>::ensure(image);
    masks.push_back({static_cast<std::uint32_t>(image.shape(1)),
                     static_cast<std::uint32_t>(image.shape(0)),
                     {texels.data(), texels.data() + texels.size()}});
  }
  return smoke::MaskAtlas::pack(masks).value_or_throw();
}

/// A number of an event as a whole one: what is too large stays so, for check_event to refuse.
std::uint32_t rounded(const char* argument, double value) {
  if (!(value >= 0)) refuse(argument, "expected a number of at least 0");
  return static_cast<std::uint32_t>(std::llround(std::min(value, 4294967295.0)));
}

/// An angle [degrees] in 1/65536 turn, [0, 65535].
std::uint32_t to_turn(const char* argument, double degrees) {
  if (!std::isfinite(degrees)) refuse(argument, "is not finite");
  const double turns = degrees / 360 - std::floor(degrees / 360);
  return static_cast<std::uint32_t>(std::llround(turns * sim::kFullTurn)) % sim::kFullTurn;
}

template <typename Value>
const Value* find(const std::vector<std::pair<std::string_view, Value>>& values, std::string_view key) {
  const auto found = std::ranges::find(values, key, &std::pair<std::string_view, Value>::first);
  return found == values.end() ? nullptr : &found->second;
}

}  // namespace

World::World(Level level, float extinction, std::uint32_t ticks_per_second,
             const std::vector<py::array>& masks)
    : level_(std::move(level)),
      masks_(pack_masks(masks)),
      extinction_(extinction),
      world_(level_.voxels->solids(), {ticks_per_second, masks_.key(), level_.voxels->level_hash()}) {
  if (!(extinction >= 0 && extinction <= 1e6f)) refuse("extinction", "expected 0 to 1,000,000 per metre");
}

const smoke::Field& World::update_field() {
  if (!field_)
    field_ = std::make_unique<smoke::Field>(level_.voxels->solids(), level_.voxels->planes, &masks_);
  try {
    field_->update(world_);
  } catch (...) {
    field_.reset();  // It is of no further use.
    throw;
  }
  return *field_;
}

smoke::SightLook World::sight_look(bool drawn) const {
  smoke::SightLook look{extinction_};
  if (drawn) look.drawn = smoke::drawn_look({});
  return look;
}

std::uint32_t World::tick_of(std::optional<double> time, std::optional<std::int64_t> tick) const {
  if (time && tick) refuse("time, tick", "give one of them");
  if (!time && !tick) return std::max(world_.tick(), world_.first_open_tick());
  const double rate = world_.settings().ticks_per_second;
  const double at = tick ? static_cast<double>(*tick) : *time * rate;
  if (!(at >= 0 && at <= sim::kMaxTick))
    refuse(tick ? "tick" : "time", "expected a tick from 0 to 2^29, got " + std::to_string(at));
  // As scenario::tick_at: the tick at or before a time.
  return time ? scenario::tick_at(*time, world_.settings().ticks_per_second) : static_cast<std::uint32_t>(at);
}

void ValueSetter::operator()(const sim::PositionField& field, sim::Position& member) const {
  if (const glm::dvec3* metres = find(values.positions, field.key))
    member = sim::position_from_metres(*metres);
}

void ValueSetter::operator()(const sim::NumberField& field, std::uint32_t& member) const {
  const double* value = find(values.numbers, field.key);
  if (!value) return;
  if (field.unit == sim::FieldUnit::turn_65536) return void(member = to_turn(field.key, *value));
  const std::uint32_t steps =
      field.unit == sim::FieldUnit::tick ? ticks_per_second : sim::steps_of(field.unit);
  member = rounded(field.key, *value * steps);
}

void World::append_event(const When& when, sim::Event event) {
  change([&] {
    const std::uint32_t tick = tick_of(when.time, when.tick);
    std::visit([&](auto& kind) { kind.tick = tick; }, event);
    world_.append(std::move(event)).value_or_throw();
  });
}

void World::set_solid(const py::object& low, const py::object& high, bool solid, const When& when) {
  const voxel::GridLayout& layout = level_.grid().layout();
  Box<int> box =
      scenario::voxels_in(layout, glm::vec3(vector_of("low", low)), glm::vec3(vector_of("high", high)));
  box = intersection(box, {glm::ivec3(0), layout.size});
  if (box.empty()) refuse("low, high", "the box contains the centre of no voxel of the level");
  const glm::u64vec3 size(box.high - box.low);
  if (size.x * size.y * size.z > kMaxEditVoxels)
    throw Error(ErrorCode::resource_limit, "low, high: the box has more than 2^27 voxels; take smaller ones");
  append_event(when, sim::LevelEdit{0, sim::edit_box(layout, box.low, box.high, solid)});
}

void World::advance_to(std::optional<double> time, std::optional<std::int64_t> tick) {
  std::optional<std::uint32_t> target;
  while (change([&] {
    if (!target) target = time || tick ? tick_of(time, tick) : world_.tick();
    if (*target < world_.earliest_tick())
      refuse("tick",
             std::to_string(*target) + " is before earliest_tick, " + std::to_string(world_.earliest_tick()));
    world_.advance_to(std::min(*target, world_.tick() + kTicksAtOnce));
    return world_.tick() < *target;
  }))
    stop_if_interrupted();
}

void World::step(std::uint32_t ticks) {
  const auto target = read([&](const sim::World& world) { return std::int64_t{world.tick()} + ticks; });
  advance_to({}, target);
}

void World::forget_before(std::optional<double> time, std::optional<std::int64_t> tick) {
  change([&] { world_.forget_before(tick_of(time, tick)); });
}

py::bytes World::save() const {
  const auto bytes = read([](const sim::World& world) { return wire::write_keyframe(world.state()); });
  return bytes_of(bytes);
}

void World::restore(const py::bytes& bytes) {
  const std::vector<std::byte> copy = copy_of(bytes);
  change([&] {
    const wire::PacketHead head = wire::read_head(copy).value_or_throw();
    if (head.kind != wire::PacketKind::keyframe)
      throw Error(ErrorCode::bad_input, "state: the packet is not a keyframe; give a Receiver its deltas");
    world_.restore(wire::read_keyframe(head).value_or_throw()).value_or_throw();
  });
}

void World::restore_state(const sim::State& state) {
  change([&] { world_.restore(state).value_or_throw(); });
}

}  // namespace brume::python
