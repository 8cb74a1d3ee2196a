#include "godot.hpp"

#include <algorithm>

namespace brume::godot {

const godot_gdnative_core_api_struct* api = nullptr;

namespace {

brume_point point_of(const godot_vector3& vector) {
  return {api->godot_vector3_get_axis(&vector, GODOT_VECTOR3_AXIS_X),
          api->godot_vector3_get_axis(&vector, GODOT_VECTOR3_AXIS_Y),
          api->godot_vector3_get_axis(&vector, GODOT_VECTOR3_AXIS_Z)};
}

Box box_of(const godot_variant* variant) {
  const godot_aabb box = api->godot_variant_as_aabb(variant);
  const brume_point low = point_of(api->godot_aabb_get_position(&box));
  const brume_point size = point_of(api->godot_aabb_get_size(&box));
  return {low, {low.x + size.x, low.y + size.y, low.z + size.z}};
}

/// The functions of one kind of pool array.
template <typename T, typename Array, typename Access>
struct PoolFunctions {
  void (*make)(Array*);
  void (*resize)(Array*, godot_int);
  Access* (*write)(Array*);
  T* (*pointer)(const Access*);
  void (*end)(Access*);
  void (*to_variant)(godot_variant*, const Array*);
  void (*destroy)(Array*);
};

template <typename T, typename Array, typename Access>
godot_variant pool_of(const std::vector<T>& elements, const PoolFunctions<T, Array, Access>& functions) {
  Array array;
  functions.make(&array);
  functions.resize(&array, static_cast<godot_int>(elements.size()));
  if (!elements.empty()) {
    Access* access = functions.write(&array);
    std::copy(elements.begin(), elements.end(), functions.pointer(access));
    functions.end(access);
  }
  godot_variant variant;
  functions.to_variant(&variant, &array);
  functions.destroy(&array);
  return variant;
}

}  // namespace

const godot_variant* Arguments::checked(int i, godot_variant_type type, const char* expected) const {
  if (api->godot_variant_get_type(values_[i]) != type)
    throw std::invalid_argument("argument " + std::to_string(i + 1) + " must be " + expected);
  return values_[i];
}

std::int64_t Arguments::integer(int i) const {
  return api->godot_variant_as_int(checked(i, GODOT_VARIANT_TYPE_INT, "an int"));
}

std::uint32_t Arguments::index(int i) const {
  const std::int64_t index = integer(i);
  if (index < 0 || index > UINT32_MAX)
    throw std::invalid_argument("argument " + std::to_string(i + 1) + " must be from 0 to 2^32 - 1, not " +
                                std::to_string(index));
  return static_cast<std::uint32_t>(index);
}

double Arguments::number(int i) const {
  // GDScript writes 3 for 3.0.
  if (api->godot_variant_get_type(values_[i]) == GODOT_VARIANT_TYPE_INT)
    return static_cast<double>(integer(i));
  return api->godot_variant_as_real(checked(i, GODOT_VARIANT_TYPE_REAL, "a number"));
}

bool Arguments::boolean(int i) const {
  return api->godot_variant_as_bool(checked(i, GODOT_VARIANT_TYPE_BOOL, "a bool"));
}

brume_point Arguments::point(int i) const {
  return point_of(api->godot_variant_as_vector3(checked(i, GODOT_VARIANT_TYPE_VECTOR3, "a Vector3")));
}

Box Arguments::box(int i) const {
  return box_of(checked(i, GODOT_VARIANT_TYPE_AABB, "an AABB"));
}

std::vector<Box> Arguments::boxes(int i) const {
  godot_array array = api->godot_variant_as_array(checked(i, GODOT_VARIANT_TYPE_ARRAY, "an Array of AABBs"));
  std::vector<Box> boxes;
  bool right = true;
  for (int k = 0; k < api->godot_array_size(&array) && right; ++k) {
    const godot_variant* element = api->godot_array_operator_index_const(&array, k);
    right = api->godot_variant_get_type(element) == GODOT_VARIANT_TYPE_AABB;
    if (right) boxes.push_back(box_of(element));
  }
  api->godot_array_destroy(&array);
  if (!right)
    throw std::invalid_argument("element " + std::to_string(boxes.size()) + " of argument " +
                                std::to_string(i + 1) + " must be an AABB");
  return boxes;
}

std::vector<brume_point> Arguments::points(int i) const {
  godot_pool_vector3_array array = api->godot_variant_as_pool_vector3_array(
      checked(i, GODOT_VARIANT_TYPE_POOL_VECTOR3_ARRAY, "a PoolVector3Array"));
  std::vector<brume_point> points;
  for (int k = 0; k < api->godot_pool_vector3_array_size(&array); ++k)
    points.push_back(point_of(api->godot_pool_vector3_array_get(&array, k)));
  api->godot_pool_vector3_array_destroy(&array);
  return points;
}

std::vector<std::int32_t> Arguments::integers(int i) const {
  godot_pool_int_array array =
      api->godot_variant_as_pool_int_array(checked(i, GODOT_VARIANT_TYPE_POOL_INT_ARRAY, "a PoolIntArray"));
  std::vector<std::int32_t> integers;
  for (int k = 0; k < api->godot_pool_int_array_size(&array); ++k)
    integers.push_back(api->godot_pool_int_array_get(&array, k));
  api->godot_pool_int_array_destroy(&array);
  return integers;
}

std::vector<std::uint8_t> Arguments::bytes(int i) const {
  godot_pool_byte_array array = api->godot_variant_as_pool_byte_array(
      checked(i, GODOT_VARIANT_TYPE_POOL_BYTE_ARRAY, "a PoolByteArray"));
  std::vector<std::uint8_t> bytes;
  for (int k = 0; k < api->godot_pool_byte_array_size(&array); ++k)
    bytes.push_back(api->godot_pool_byte_array_get(&array, k));
  api->godot_pool_byte_array_destroy(&array);
  return bytes;
}

godot_variant nothing() {
  godot_variant variant;
  api->godot_variant_new_nil(&variant);
  return variant;
}

godot_variant value(bool boolean) {
  godot_variant variant;
  api->godot_variant_new_bool(&variant, boolean);
  return variant;
}

godot_variant value(std::int64_t integer) {
  godot_variant variant;
  api->godot_variant_new_int(&variant, integer);
  return variant;
}

godot_variant value(double number) {
  godot_variant variant;
  api->godot_variant_new_real(&variant, number);
  return variant;
}

godot_variant value(const std::string& text) {
  godot_string string = api->godot_string_chars_to_utf8(text.c_str());
  godot_variant variant;
  api->godot_variant_new_string(&variant, &string);
  api->godot_string_destroy(&string);
  return variant;
}

godot_variant value(const std::vector<float>& numbers) {
  return pool_of(numbers, PoolFunctions<float, godot_pool_real_array, godot_pool_real_array_write_access>{
                              api->godot_pool_real_array_new, api->godot_pool_real_array_resize,
                              api->godot_pool_real_array_write, api->godot_pool_real_array_write_access_ptr,
                              api->godot_pool_real_array_write_access_destroy,
                              api->godot_variant_new_pool_real_array, api->godot_pool_real_array_destroy});
}

godot_variant value(const std::vector<std::int32_t>& integers) {
  return pool_of(
      integers,
      PoolFunctions<std::int32_t, godot_pool_int_array, godot_pool_int_array_write_access>{
          api->godot_pool_int_array_new, api->godot_pool_int_array_resize, api->godot_pool_int_array_write,
          api->godot_pool_int_array_write_access_ptr, api->godot_pool_int_array_write_access_destroy,
          api->godot_variant_new_pool_int_array, api->godot_pool_int_array_destroy});
}

godot_variant value(const std::vector<std::uint8_t>& bytes) {
  return pool_of(
      bytes,
      PoolFunctions<std::uint8_t, godot_pool_byte_array, godot_pool_byte_array_write_access>{
          api->godot_pool_byte_array_new, api->godot_pool_byte_array_resize, api->godot_pool_byte_array_write,
          api->godot_pool_byte_array_write_access_ptr, api->godot_pool_byte_array_write_access_destroy,
          api->godot_variant_new_pool_byte_array, api->godot_pool_byte_array_destroy});
}

void show_error(const std::string& line) {
  api->godot_print_error(line.c_str(), "BrumeMatch", "addons/brume", 0);
}

}  // namespace brume::godot
