// The events of brume.h have the fields, ranges and defaults of sim/event_fields.hpp.
#include "sim/event_fields.hpp"

#include <brume/brume.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <regex>
#include <string>
#include <variant>

#include "tests/api/event_structs.hpp"

namespace brume::api {
namespace {

/// "255", "2^24", a constant of brume.h; nothing for the name of a member.
std::optional<std::uint64_t> number_of(const std::string& text) {
  static const std::map<std::string, std::uint64_t> kNames{
      {"BRUME_MAX_TICK", BRUME_MAX_TICK},
      {"BRUME_MAX_COORDINATE", BRUME_MAX_COORDINATE},
      {"BRUME_MAX_SMOKE_VOXELS", BRUME_MAX_SMOKE_VOXELS}};
  if (const auto named = kNames.find(text); named != kNames.end()) return named->second;
  if (text.starts_with("2^")) return std::uint64_t{1} << std::stoi(text.substr(2));
  if (text.find_first_not_of("0123456789") != std::string::npos) return {};
  return std::stoull(text);
}

/// Compares the members of a struct with the fields of an event: a visitor of sim/event_fields.hpp.
struct FieldComparison {
  const EventStruct& header;
  const brume_event& defaults;
  int ranges = 0;

  void operator()(const sim::PositionField& field, const sim::Position&) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_EQ(defaults.u.reserved[header.member(field).word + axis], 0u) << field.key;
  }
  void operator()(const sim::ChoiceField& field, auto initial) {
    EXPECT_EQ(defaults.u.reserved[header.member(field).word], static_cast<std::uint32_t>(initial))
        << field.c_name;
  }
  void operator()(const sim::NumberField& field, std::uint32_t initial) {
    const EventStruct::Member& member = header.member(field);
    EXPECT_EQ(defaults.u.reserved[member.word], initial) << field.c_name;
    static const std::regex range("\\[([^, \\]]+), ([^, \\]]+)\\]");
    std::smatch match;
    if (field.in_voxels || !std::regex_search(member.comment, match, range)) return;
    ++ranges;
    EXPECT_EQ(number_of(match[1]).value_or(field.low), field.low) << field.c_name;
    EXPECT_EQ(number_of(match[2]), field.high) << field.c_name;
  }
};

/// The number of ranges in the comments of a kind's members.
template <typename Kind>
int compare_fields() {
  const brume_event defaults = brume_event_defaults(event_struct<Kind>().kind(), 0);
  FieldComparison compare{event_struct<Kind>(), defaults};
  const Kind event;
  sim::visit_fields(event, compare);
  return compare.ranges;
}
template <typename... Kinds>
int compare_all(const std::variant<Kinds...>&) {
  return (compare_fields<Kinds>() + ...);
}

TEST(EventFields, OfTheHeaderAreThoseOfTheSimulation) {
  EXPECT_GE(compare_all(sim::Event()), 10);
  EXPECT_EQ(std::uint32_t{BRUME_MAX_SMOKE_VOXELS}, sim::kMaxFillVoxels);
}

}  // namespace
}  // namespace brume::api
