// Structs of shaders/shared have the same layout in C++ and in GLSL: each member is compared with the
// compiled shader.
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <spirv_cross/spirv_cross.hpp>

#include "brume_test_shaders.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/probes.h"
#include "tests/passes/shared_structs.h"
#include "tests/passes/struct_members.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::passes {
namespace {

using spirv_cross::SPIRType;

/// The types of a member's numbers: PackedVec3 is a vector in one language and a struct in the other.
using NumberTypes = std::vector<SPIRType::BaseType>;

template <typename Number>
constexpr SPIRType::BaseType kTypeOf = std::is_same_v<Number, float> ? SPIRType::Float
                                       : std::is_same_v<Number, int> ? SPIRType::Int
                                                                     : SPIRType::UInt;

template <typename T>
void add_numbers(const T& value, NumberTypes& types) {
  if constexpr (std::is_arithmetic_v<T>)
    types.push_back(kTypeOf<T>);
  else if constexpr (requires { typename T::value_type; })
    types.insert(types.end(), sizeof(T) / 4, kTypeOf<typename T::value_type>);
  else
    for_each_member(value, [&](const auto& member) { add_numbers(member, types); });
}

template <typename T>
NumberTypes numbers_of(const T& value) {
  NumberTypes types;
  add_numbers(value, types);
  return types;
}

/// Layouts in the compiled shader.
class Layouts {
 public:
  explicit Layouts(const gpu::ShaderCode& shader)
      : compiler_(shader.words.data(), shader.words.size()),
        block_(compiler_.get_type(compiler_.get_shader_resources().storage_buffers[0].base_type_id)) {}

  template <typename T>
  void expect_same(std::uint32_t number, const char* name) const {
    ASSERT_LT(2 * number, block_.member_types.size()) << name;
    const SPIRType& type = compiler_.get_type(block_.member_types[2 * number]);
    EXPECT_EQ(compiler_.get_declared_struct_size(type), sizeof(T)) << name;
    ASSERT_EQ(type.member_types.size(), member_count<T>()) << name;
    const T value{};
    std::uint32_t i = 0;
    for_each_member(value, [&](const auto& member) {
      const auto offset =
          reinterpret_cast<const std::byte*>(&member) - reinterpret_cast<const std::byte*>(&value);
      EXPECT_EQ(compiler_.type_struct_member_offset(type, i), offset) << name << " member " << i;
      NumberTypes numbers;
      add_member(type.member_types[i], numbers);
      EXPECT_EQ(numbers, numbers_of(member)) << name << " member " << i;
      ++i;
    });
  }

 private:
  void add_member(spirv_cross::TypeID id, NumberTypes& types) const {
    const SPIRType& type = compiler_.get_type(id);
    if (type.basetype != SPIRType::Struct)
      types.insert(types.end(), std::size_t{type.vecsize} * type.columns, type.basetype);
    for (const spirv_cross::TypeID member : type.member_types) add_member(member, types);
  }

  spirv_cross::Compiler compiler_;
  const SPIRType& block_;  // its members 2 `number` and the next are that struct
};

TEST(SharedStructs, HaveOneLayoutInBothLanguages) {
  const Layouts layouts(shaders::echo_comp);
#define EXPECT_SAME(number, Type) layouts.expect_same<shared::Type>(number, #Type);
  FOR_EACH_SHARED_STRUCT(EXPECT_SAME)
#undef EXPECT_SAME
}

TEST(SharedStructs, AllAreListed) {
  std::set<std::string> listed, declared;
#define INSERT(number, Type) listed.insert(#Type);
  FOR_EACH_SHARED_STRUCT(INSERT)
#undef INSERT
  const std::regex sized(R"re(\nSHARED_SIZE\((\w+),)re");
  for (const auto& file : std::filesystem::directory_iterator(BRUME_SOURCE_DIR "/shaders/shared")) {
    std::ifstream in(file.path());
    const std::string text(std::istreambuf_iterator<char>(in), {});
    for (std::sregex_iterator match(text.begin(), text.end(), sized), end; match != end; ++match)
      declared.insert((*match)[1]);
  }
  EXPECT_EQ(listed, declared);
}

using SharedStructsOnTheDevice = gpu::GpuTest;

TEST_F(SharedStructsOnTheDevice, AreCopiedWhole) {
  // Two of each: the first counts up, the second is to become equal. A byte that no member covers would
  // differ.
  const gpu::ComputePipeline pipeline(context(), shaders::echo_comp);
  std::vector<std::uint32_t> values;
  std::vector<std::size_t> words;
  const auto rounded_up = [](std::size_t count) { return (count + 3) / 4 * 4; };  // to 16 bytes
  const auto add = [&](std::size_t bytes) {
    words.push_back(bytes / 4);
    for (std::uint32_t i = 0; i < bytes / 4; ++i) values.push_back(0x3f800000u + i);  // floats from 1 on
    values.resize(rounded_up(values.size()) + rounded_up(bytes / 4));
  };
#define ADD(number, Type) add(sizeof(shared::Type));
  FOR_EACH_SHARED_STRUCT(ADD)
#undef ADD
  const gpu::Buffer buffer = upload(values);
  runner().run([&](gpu::Recorder& recorder) {
    recorder.bind(pipeline, {{shared::kBindProbeOut, gpu::read_write(buffer)}});
    recorder.dispatch_threads(pipeline, 1);
  });
  const auto copied = read_back<std::uint32_t>(buffer, values.size());
  auto first = copied.begin();
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto room = static_cast<std::ptrdiff_t>(rounded_up(words[i]));
    const auto second = first + room;
    EXPECT_TRUE(std::equal(first, first + static_cast<std::ptrdiff_t>(words[i]), second)) << "struct " << i;
    first = second + room;
  }
}

TEST(PackedHole, UnpacksToTheHole) {
  shared::Hole hole{{1, 2, 3}, 0.5f, {4, 5, 6}, 8,  {7, 8, 9}, 10,       {11, 12, 13},
                    14,        15,   16,        17, 0,         {18, 19}, {20, 21}};
  for (const std::uint32_t shape : {shared::kHoleCylinder, shared::kHoleBox, shared::kHoleMask})
    for (const bool wide_open : {false, true}) {
      hole.shape = shape;
      const shared::PackedHole packed = shared::pack_hole(hole, wide_open);
      EXPECT_EQ(shared::hole_is_round(packed.forward_far), shape == shared::kHoleCylinder);
      EXPECT_EQ(shared::hole_is_partial(packed.origin_radius), !wide_open || shape == shared::kHoleMask);
      const shared::Hole unpacked = shared::unpack_hole(packed);
      EXPECT_EQ(std::memcmp(&unpacked, &hole, sizeof hole), 0);
    }
}

TEST(PackedReach, UnpacksToTheReach) {
  const shared::HoleReach reach{{1, 2, 3}, 4, {5, 6, 7}, -1};
  const shared::HoleReach unpacked = shared::unpack_reach(shared::pack_reach(reach));
  EXPECT_EQ(std::memcmp(&unpacked, &reach, sizeof reach), 0);
}

TEST(AtlasBrick, InvertsTheOrderOfSlots) {
  const glm::ivec3 bricks(8, 2, 5);
  shared::BrickLayout behind_seven{};
  volume::set_atlas(behind_seven, bricks);
  behind_seven.first_slot = 7;
  for (std::uint32_t slot = 0; slot < 80; ++slot) {
    const glm::uvec3 at = shared::atlas_brick(behind_seven, slot);
    EXPECT_EQ(slot, at.x + 8 * (at.y + 2 * at.z));
    EXPECT_TRUE(glm::all(glm::lessThan(at, glm::uvec3(bricks))));
    if (slot >= 7) {
      EXPECT_EQ(shared::atlas_first_texel(behind_seven, slot - 7), 10u * at);
    }
  }
}

}  // namespace
}  // namespace brume::passes
