// Calls every function of the C interface with arguments of which some are hostile: null, another kind of
// handle, not a handle at all, structs of other sizes, NaN, numbers out of range, damaged bytes.
#pragma once

#include <brume/brume_textures.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace brume::api {

/// Live handles of a kind.
template <typename T>
using Pool = std::vector<T*>;

/// An output, filled with a pattern that a call which fails must not change.
template <typename T>
struct Output {
  Output() { std::memset(&bytes, kPattern, sizeof bytes); }
  T* pointer() { return given ? reinterpret_cast<T*>(&bytes) : nullptr; }
  T value() const {
    T out;
    std::memcpy(&out, &bytes, sizeof out);
    return out;
  }
  bool untouched() const {
    for (const unsigned char byte : bytes)
      if (byte != kPattern) return false;
    return true;
  }

  static constexpr unsigned char kPattern = 0xa5;
  bool given = true;
  alignas(T) std::array<unsigned char, sizeof(T)> bytes;
};

class Hostile {
 public:
  explicit Hostile(unsigned seed);
  Hostile(const Hostile&) = delete;
  ~Hostile();

  /// Makes a number of calls. Every result is checked.
  void run(std::uint64_t calls);

  /// By name of the function, how often it had each result.
  const std::map<std::string, std::map<int, std::uint64_t>>& results() const { return results_; }
  std::uint64_t calls() const { return calls_; }

 protected:
  using Step = void (Hostile::*)();
  static const std::vector<Step>& steps();

  // Numbers.
  bool chance(double probability) { return std::uniform_real_distribution<double>()(random_) < probability; }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
  std::uint32_t number(std::uint32_t good_below);
  std::int32_t coordinate();
  float real(float scale);
  std::size_t count(std::size_t good);
  brume_position position();
  brume_point point(float scale);
  brume_voxel voxel(std::int32_t good_below);
  brume_layout layout();
  brume_event event();
  std::vector<brume_segment> segments();
  std::vector<std::uint8_t> packet();

  // Pointers.
  template <typename T>
  T* handle(const Pool<T>& pool);
  template <typename T>
  T* wrong_handle();
  template <typename Params>
  const Params* spoiled(Params& params);
  template <typename T>
  Output<T> output();

  // Results.
  bool checked(const char* function, brume_result result, bool untouched);
  template <typename T>
  void keep(const char* function, brume_result result, const Output<T*>& out, Pool<T>& pool,
            brume_result (*destroy)(T*) BRUME_NOEXCEPT);
  template <typename T>
  void end(const char* function, Pool<T>& pool, brume_result (*destroy)(T*) BRUME_NOEXCEPT);
  template <typename Number, typename T>
  void read(const char* function, const Pool<T>& pool,
            brume_result (*call)(const T*, Number*) BRUME_NOEXCEPT);
  template <typename Call>
  void read_bytes(const char* function, Call call);
  template <typename Element, typename T>
  void read_list(const char* function, const Pool<T>& pool,
                 brume_result (*call)(const T*, Element*, std::size_t, std::size_t*) BRUME_NOEXCEPT);
  template <typename Out, typename Call>
  void query(const char* function, Call call);
  template <typename Call>
  void read_box(const char* function, Call call);

  template <typename Params>
  void write_defaults(const char* function, brume_result (*call)(Params*, std::uint32_t) BRUME_NOEXCEPT);

  // Calls.
  void general();
  void context_create();
  void context_destroy();
  void level_from_voxels();
  void level_from_triangles();
  void level_destroy();
  void level_read();
  void masks_create();
  void masks_destroy();
  void world_create();
  void world_destroy();
  void world_append();
  void world_replace();
  void world_move();
  void world_read();
  void world_state();
  void world_restore();
  void state_read();
  void state_filter();
  void state_save();
  void state_load();
  void state_destroy();
  void sender_create();
  void sender_push();
  void sender_packets();
  void sender_destroy();
  void receiver_create();
  void receiver_receive();
  void receiver_read();
  void receiver_destroy();
  void field_create();
  void field_update();
  void field_query();
  void field_destroy();
  void textures_create();
  void textures_update();
  void textures_read();
  void textures_destroy();
  void defaults();

  std::mt19937 random_;
  std::uint64_t calls_ = 0, logged_ = 0;
  std::map<std::string, std::map<int, std::uint64_t>> results_;
  Pool<brume_context> contexts_;
  Pool<brume_level> levels_;
  Pool<brume_masks> masks_;
  Pool<brume_world> worlds_;
  Pool<brume_state> states_;
  Pool<brume_sender> senders_;
  Pool<brume_receiver> receivers_;
  Pool<brume_field> fields_;
  Pool<brume_textures> textures_;
  std::vector<std::vector<std::uint8_t>> packets_;
  alignas(64) std::array<unsigned char, 4096> garbage_;
  std::vector<std::uint8_t> bits_;
  alignas(8) std::array<unsigned char, 8192> struct_;  ///< The parameters of a call.
};

}  // namespace brume::api
