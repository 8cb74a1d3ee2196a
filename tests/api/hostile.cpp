#include "tests/api/hostile.hpp"

#include <algorithm>
#include <limits>
#include <variant>

#include "sim/events.hpp"
#include "tests/api/hostile_calls.hpp"

namespace brume::api {
namespace {

constexpr std::array<std::uint32_t, 14> kNumbers{0,
                                                 1,
                                                 2,
                                                 255,
                                                 256,
                                                 65536,
                                                 1u << 24,
                                                 (1u << 24) + 1,
                                                 1u << 27,
                                                 1u << 29,
                                                 (1u << 29) + 1,
                                                 1u << 30,
                                                 0x7fffffffu,
                                                 0xffffffffu};
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::array<float, 10> kReals{
    0.0f,     -0.0f, std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, 1e38f, -1e-42f, 16384.0f,
    16385.0f, -1.0f};

template <typename T>
void destroy_all(const Pool<T>& pool, brume_result (*destroy)(T*) BRUME_NOEXCEPT) {
  for (T* one : pool) EXPECT_EQ(destroy(one), BRUME_OK);
}

}  // namespace

Hostile::Hostile(unsigned seed) : random_(seed) {
  for (auto& byte : garbage_) byte = static_cast<unsigned char>(random_());
  for (int i = 0; i < 9000; ++i)
    bits_.push_back(static_cast<std::uint8_t>(random_() & random_() & random_()));
}

Hostile::~Hostile() {
  destroy_all(contexts_, brume_context_destroy);
  destroy_all(levels_, brume_level_destroy);
  destroy_all(masks_, brume_masks_destroy);
  destroy_all(fields_, brume_field_destroy);
  destroy_all(textures_, brume_textures_destroy);
  destroy_all(worlds_, brume_world_destroy);
  destroy_all(senders_, brume_sender_destroy);
  destroy_all(receivers_, brume_receiver_destroy);
  destroy_all(states_, brume_state_destroy);
}

void Hostile::run(std::uint64_t calls) {
  const std::uint64_t end = calls_ + calls;
  while (calls_ < end && !testing::Test::HasFailure())
    (this->*steps()[below(static_cast<std::uint32_t>(steps().size()))])();
}

std::uint32_t Hostile::number(std::uint32_t good_below) {
  return chance(0.05) ? kNumbers[below(kNumbers.size())] : below(good_below);
}

std::int32_t Hostile::coordinate() {
  if (chance(0.01)) return static_cast<std::int32_t>(kNumbers[below(kNumbers.size())]);
  return static_cast<std::int32_t>(below(14000)) - 1000;
}

float Hostile::real(float scale) {
  if (chance(0.01)) return kReals[below(kReals.size())];
  return std::uniform_real_distribution<float>(-0.1f, 1.0f)(random_) * scale;
}

/// The number of elements of an array: mostly as many as it has.
std::size_t Hostile::count(std::size_t good) {
  if (!chance(0.06)) return good;
  constexpr std::size_t kMax = std::numeric_limits<std::size_t>::max();
  constexpr std::array<std::size_t, 6> kCounts{0,
                                               kMax,
                                               kMax / 2 + 1,
                                               kMax / sizeof(brume_segment) + 2,
                                               std::size_t{1} << 40,
                                               std::size_t{BRUME_MAX_QUERIES} + 1};
  return kCounts[below(kCounts.size())];
}

brume_position Hostile::position() {
  const std::int32_t x = coordinate(), y = coordinate(), z = coordinate();
  return {x, y, z};
}

brume_point Hostile::point(float scale) {
  const float x = real(scale), y = real(scale), z = real(scale);
  return {x, y, z};
}

brume_voxel Hostile::voxel(std::int32_t good_below) {
  const auto axis = [&] {
    return static_cast<std::int32_t>(chance(0.02) ? kNumbers[below(kNumbers.size())]
                                                  : below(static_cast<std::uint32_t>(good_below)));
  };
  const std::int32_t x = axis(), y = axis(), z = axis();
  return {x, y, z};
}

/// Mostly the one of which there are many levels, so that their worlds' states fit them.
brume_layout Hostile::layout() {
  brume_layout layout{{30, 12, 25}, 0.5f, {0, 0, 0}};
  if (chance(0.1)) layout.size = voxel(33);
  if (chance(0.03)) layout.voxel_size = chance(0.5) ? 1 : real(3);
  if (chance(0.03)) layout.origin = point(20);
  return layout;
}

brume_event Hostile::event() {
  const std::uint32_t kind = chance(0.02) ? number(9) : 1 + below(std::variant_size_v<sim::Event>);
  brume_event event = brume_event_defaults(kind, number(400));
  auto& u = event.u;
  if (kind == BRUME_EVENT_SMOKE) {
    u.smoke = {position(), position(), number(1500) + 1, number(90), number(200), number(90)};
  } else if (kind == BRUME_EVENT_SHOT) {
    u.shot.origin = position();
    u.shot.toward = position();
    u.shot.shape = number(chance(0.8) ? 2 : 3);
    u.shot.mask_index = chance(0.9) ? 0 : number(3);
    if (chance(0.1)) u.shot.radius_1024 = number(1000);
    if (chance(0.1)) u.shot.stay_open_ms = number(5000);
    if (chance(0.1)) u.shot.roll_65536 = number(70000);
  } else if (kind == BRUME_EVENT_MOVE) {
    u.move = {number(9), position()};
  } else if (kind == BRUME_EVENT_EDIT) {
    u.edit = {voxel(25), voxel(40), number(2)};
  } else {
    // A place, and numbers that have defaults.
    for (std::uint32_t& word : u.reserved)
      if (word != 0 && chance(0.1)) word = number(40000);
    const brume_position at = position();
    std::memcpy(u.reserved, &at, sizeof at);
  }
  if (chance(0.01)) event.struct_size = number(300);
  if (chance(0.01)) event.next = &random_;
  return event;
}

std::vector<brume_segment> Hostile::segments() {
  std::vector<brume_segment> lines(below(9));
  for (brume_segment& line : lines) {
    line.a = point(14);
    line.b = point(14);
  }
  return lines;
}

/// One that was written, damaged at times; or none.
std::vector<std::uint8_t> Hostile::packet() {
  if (packets_.empty() || chance(0.02)) return {};
  std::vector<std::uint8_t> bytes = packets_[below(static_cast<std::uint32_t>(packets_.size()))];
  if (bytes.empty() || chance(0.7)) return bytes;
  if (chance(0.4)) bytes.resize(below(static_cast<std::uint32_t>(bytes.size())));
  for (std::uint32_t i = below(3); i > 0 && !bytes.empty(); --i)
    bytes[below(static_cast<std::uint32_t>(bytes.size()))] = static_cast<std::uint8_t>(random_());
  return bytes;
}

/// Counts a call and checks what holds for all; true when it succeeded.
bool Hostile::checked(const char* function, brume_result result, bool untouched) {
  ++calls_;
  ++results_[function][result];
  if (result == BRUME_OK) return true;
  EXPECT_TRUE((result > BRUME_OK && result < BRUME_ERROR_BROKEN) || result == BRUME_ERROR_DEVICE)
      << function << ": " << result << ", " << brume_last_error();
  EXPECT_TRUE(untouched) << brume_last_error();
  const std::string line = brume_last_error();
  EXPECT_EQ(line.rfind(std::string(function) + ": ", 0), 0u) << function << ": " << line;
  EXPECT_GT(line.size(), std::strlen(function) + 10);
  EXPECT_EQ(line.find('\n'), line.npos);
  return false;
}

}  // namespace brume::api
