// What the add-on uses of GDNative: arguments and results of methods as values of C++.
#pragma once

#include <brume/brume.h>
#include <gdnative_api_struct.gen.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace brume::godot {

/// The functions of Godot, from its start to its end.
extern const godot_gdnative_core_api_struct* api;

/// A box in the world [m].
struct Box {
  brume_point low, high;
};

/// The arguments of a method. What is not of the expected type throws std::invalid_argument.
class Arguments {
 public:
  Arguments(const godot_variant* const* values, int count) : values_(values), count_(count) {}

  int count() const { return count_; }
  std::int64_t integer(int i) const;
  std::uint32_t index(int i) const;  ///< An int from 0 to 2^32 - 1.
  double number(int i) const;
  bool boolean(int i) const;
  brume_point point(int i) const;
  Box box(int i) const;
  std::vector<Box> boxes(int i) const;
  std::vector<brume_point> points(int i) const;
  std::vector<std::int32_t> integers(int i) const;
  std::vector<std::uint8_t> bytes(int i) const;

 private:
  const godot_variant* checked(int i, godot_variant_type type, const char* expected) const;

  const godot_variant* const* values_;
  int count_;
};

godot_variant nothing();
godot_variant value(bool boolean);
godot_variant value(std::int64_t integer);
godot_variant value(double number);
godot_variant value(const std::string& text);
godot_variant value(const std::vector<float>& numbers);
godot_variant value(const std::vector<std::int32_t>& integers);
godot_variant value(const std::vector<std::uint8_t>& bytes);

/// Shows a line among Godot's errors.
void show_error(const std::string& line);

}  // namespace brume::godot
