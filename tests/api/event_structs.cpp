#include "tests/api/event_structs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <type_traits>
#include <variant>

#include "core/file.hpp"
#include "sim/level_edit.hpp"

namespace brume::api {
namespace {

const std::string& header_text() {
  static const std::string text = read_text_file(BRUME_SOURCE_DIR "/include/brume/brume.h").value_or_throw();
  return text;
}

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

/// Reads the fields of an event from its struct: a visitor of sim/event_fields.hpp.
struct FieldReader {
  const EventStruct& layout;
  const std::uint32_t* words;

  void operator()(const sim::PositionField& field, sim::Position& position) const {
    for (int axis = 0; axis < 3; ++axis)
      position[axis] = static_cast<int>(words[layout.member(field).word + static_cast<std::size_t>(axis)]);
  }
  void operator()(const auto& field, auto& member) const {
    member = static_cast<std::remove_reference_t<decltype(member)>>(words[layout.member(field).word]);
  }
};
/// The reverse.
struct FieldWriter {
  const EventStruct& layout;
  std::uint32_t* words;

  void operator()(const sim::PositionField& field, const sim::Position& position) const {
    for (int axis = 0; axis < 3; ++axis)
      words[layout.member(field).word + static_cast<std::size_t>(axis)] =
          static_cast<std::uint32_t>(position[axis]);
  }
  void operator()(const auto& field, const auto& member) const {
    words[layout.member(field).word] = static_cast<std::uint32_t>(member);
  }
};

template <typename... Kinds>
sim::Event read_event(const brume_event& event, const std::variant<Kinds...>*) {
  sim::Event result;
  const auto read_kind = [&]<typename Kind>(Kind made) {
    if (event_struct<Kind>().kind() != event.kind) return;
    made.tick = event.tick;
    sim::visit_fields(made, FieldReader{event_struct<Kind>(), event.u.reserved});
    result = made;
  };
  (read_kind(Kinds()), ...);
  return result;
}

}  // namespace

EventStruct::EventStruct(const std::string& name) : name_("brume_" + name + "_event") {
  // The number of its kind.
  std::string upper = name;
  std::ranges::transform(upper, upper.begin(), [](char c) { return static_cast<char>(std::toupper(c)); });
  std::smatch match;
  EXPECT_TRUE(std::regex_search(header_text(), match, std::regex("BRUME_EVENT_" + upper + " = (\\d+)")))
      << upper;
  if (!match.empty()) kind_ = static_cast<std::uint32_t>(std::stoul(match[1]));

  // Its members, each with the comment before or behind it.
  const auto begin = header_text().find("typedef struct " + name_ + " {");
  const auto end = header_text().find("} " + name_ + ";");
  EXPECT_TRUE(begin < end && end != std::string::npos) << name_;
  if (begin >= end || end == std::string::npos) return;
  const std::string text = header_text().substr(begin, end - begin);
  static const std::regex line("((?:\\n *///[^<\\n][^\\n]*)*)\\n *(\\w+) ([\\w, ]+);( *///<[^\\n]*)?");
  static const std::regex word("\\w+");
  std::size_t words = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), line), none; at != none; ++at) {
    const std::string names = (*at)[3];
    for (std::sregex_iterator one(names.begin(), names.end(), word); one != none; ++one) {
      members_[one->str()] = {words, (*at)[1].str() + (*at)[4].str()};
      words += (*at)[2] == "uint32_t" ? 1 : 3;
    }
  }
}

const EventStruct::Member& EventStruct::at(const std::string& name) const {
  static const Member none{};
  const auto found = members_.find(name);
  EXPECT_NE(found, members_.end()) << name_ << ": " << name;
  return found == members_.end() ? none : found->second;
}

const EventStruct::Member& EventStruct::member(const sim::NumberField& field) const {
  return at(std::string(field.c_name) + suffix_of(field.unit));
}

sim::Event sim_event(const brume_event& event, const voxel::GridLayout& layout) {
  if (event.kind != BRUME_EVENT_EDIT) return read_event(event, static_cast<const sim::Event*>(nullptr));
  const brume_edit_event& edit = event.u.edit;
  const glm::ivec3 low(edit.low.x, edit.low.y, edit.low.z), high(edit.high.x, edit.high.y, edit.high.z);
  return sim::LevelEdit{event.tick, sim::edit_box(layout, low, high, edit.solid == 1)};
}

brume_event c_event(const sim::Event& event) {
  return std::visit(
      []<typename Kind>(const Kind& e) {
        brume_event result = brume_event_defaults(event_struct<Kind>().kind(), e.tick);
        sim::visit_fields(e, FieldWriter{event_struct<Kind>(), result.u.reserved});
        return result;
      },
      event);
}

}  // namespace brume::api
