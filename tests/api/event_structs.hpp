// The structs of events in brume.h by the names of their members, so that tests can read and write an event
// of any kind.
#pragma once

#include <brume/brume.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "sim/event_fields.hpp"

namespace brume::api {

/// The struct of a kind of events, as the header declares it.
class EventStruct {
 public:
  /// `name`: sim::name_of the kind.
  explicit EventStruct(const std::string& name);

  struct Member {
    std::size_t word;     ///< Its place in brume_event::u.reserved.
    std::string comment;  ///< With the range in brackets.
  };
  /// Fails the test where there is none of this name.
  const Member& at(const std::string& name) const;
  const Member& member(const sim::NumberField& field) const;
  const Member& member(const sim::PositionField& field) const {
    return at(field.c_name ? field.c_name : field.key);
  }
  const Member& member(const sim::ChoiceField& field) const { return at(field.c_name); }

  std::uint32_t kind() const { return kind_; }

 private:
  std::string name_;
  std::uint32_t kind_ = 0;
  std::map<std::string, Member> members_;
};

/// The struct of a kind, read once.
template <typename Kind>
const EventStruct& event_struct() {
  static const EventStruct read(sim::name_of(Kind()));
  return read;
}

/// The event of the simulation; an edit's layout is given.
sim::Event sim_event(const brume_event& event, const voxel::GridLayout& layout);
/// The event of the C interface, of any kind but an edit, whose blocks need not be a box.
brume_event c_event(const sim::Event& event);

}  // namespace brume::api
