// The events of brume.h have the fields, ranges and defaults of sim/event_fields.hpp.
#include "sim/event_fields.hpp"

#include <brume/brume.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <string>

#include "core/file.hpp"

namespace brume::api {
namespace {

/// What members of the C interface have behind their names.
const char* suffix_of(sim::FieldUnit unit) {
  switch (unit) {
    case sim::FieldUnit::tick:
      return "_ticks";
    case sim::FieldUnit::metre_1024:
      return "_1024";
    case sim::FieldUnit::millisecond:
      return "_ms";
    case sim::FieldUnit::fraction_255:
      return "_255";
    case sim::FieldUnit::turn_65536:
      return "_65536";
    case sim::FieldUnit::one:
      break;
  }
  return "";
}

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

/// A struct of an event in brume.h: the place of each member among the words of an event, and its comment.
class HeaderStruct {
 public:
  explicit HeaderStruct(const std::string& name) {
    const std::string header = read_text_file(BRUME_SOURCE_DIR "/include/brume/brume.h").value_or_throw();
    const auto begin = header.find("typedef struct " + name + " {"), end = header.find("} " + name + ";");
    EXPECT_TRUE(begin < end && end != std::string::npos) << name;
    const std::string text = header.substr(begin, end - begin);
    static const std::regex line("((?:\\n *///[^<\\n][^\\n]*)*)\\n *(\\w+) ([\\w, ]+);( *///<[^\\n]*)?");
    for (std::sregex_iterator at(text.begin(), text.end(), line), none; at != none; ++at) {
      const std::string names = (*at)[3];
      static const std::regex word("\\w+");
      for (std::sregex_iterator one(names.begin(), names.end(), word); one != none; ++one) {
        members[one->str()] = {words_, (*at)[1].str() + (*at)[4].str()};
        words_ += (*at)[2] == "brume_position" ? 3 : 1;
      }
    }
  }
  struct Member {
    std::size_t word;
    std::string comment;
  };
  std::map<std::string, Member> members;

 private:
  std::size_t words_ = 0;
};

/// Compares the members of a struct with the fields of an event: a visitor of sim/event_fields.hpp.
struct FieldComparison {
  const HeaderStruct& header;
  const brume_event& defaults;
  int ranges = 0;

  void operator()(const sim::PositionField&, const sim::Position&) {}
  void operator()(const sim::ChoiceField&, const auto&) {}
  void operator()(const sim::NumberField& field, std::uint32_t initial) {
    const std::string name = std::string(field.c_name) + suffix_of(field.unit);
    const auto member = header.members.find(name);
    ASSERT_NE(member, header.members.end()) << name;
    EXPECT_EQ(defaults.u.reserved[member->second.word], initial) << name;
    static const std::regex range("\\[([^, \\]]+), ([^, \\]]+)\\]");
    std::smatch match;
    if (field.in_voxels || !std::regex_search(member->second.comment, match, range)) return;
    ++ranges;
    EXPECT_EQ(number_of(match[1]).value_or(field.low), field.low) << name;
    EXPECT_EQ(number_of(match[2]), field.high) << name;
  }
};

template <typename Event>
void expect_fields(const std::string& name, std::uint32_t kind, int ranges) {
  const HeaderStruct header(name);
  const brume_event defaults = brume_event_defaults(kind, 0);
  FieldComparison compare{header, defaults};
  const Event event;
  sim::visit_fields(event, compare);
  EXPECT_EQ(compare.ranges, ranges) << name;
}

TEST(EventFields, OfTheHeaderAreThoseOfTheSimulation) {
  expect_fields<sim::ThrowSmoke>("brume_smoke_event", BRUME_EVENT_SMOKE, 4);
  expect_fields<sim::Shot>("brume_shot_event", BRUME_EVENT_SHOT, 2);
  expect_fields<sim::Blast>("brume_blast_event", BRUME_EVENT_BLAST, 4);
}

}  // namespace
}  // namespace brume::api
