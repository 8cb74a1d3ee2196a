#include "wire/event_log.hpp"

#include <memory>
#include <string>
#include <utility>

#include "core/hash.hpp"
#include "wire/archive.hpp"
#include "wire/bytes.hpp"
#include "wire/packet.hpp"

namespace brume::wire {
namespace {

constexpr auto kFirstByte = static_cast<std::uint8_t>(kVersion << 4 | static_cast<int>(PacketKind::events));

// A default event of the variant's alternative with this index.
template <std::size_t... kIndices>
sim::Event event_of_kind(std::size_t kind, std::index_sequence<kIndices...>) {
  sim::Event event;
  static_cast<void>(((kind == kIndices && (event.emplace<kIndices>(), true)) || ...));
  return event;
}

template <typename Coder>
void code_event(Archive<Coder>& archive, sim::Event& event) {
  constexpr std::size_t kKinds = std::variant_size_v<sim::Event>;
  std::size_t kind = event.index();
  archive.field(Field::kind, kind);
  if (kind >= kKinds) archive.fail("an event of an unknown kind");
  if (!archive.ok()) return;
  if constexpr (Coder::kReads) event = event_of_kind(kind, std::make_index_sequence<kKinds>());
  std::visit(
      [&](auto& e) {
        serialize_event(archive, e);
        if constexpr (requires { e.blocks; }) serialize(archive, e.blocks);
      },
      event);
  if constexpr (Coder::kReads) {
    const Result<void> checked = sim::check_event(event, archive.layout());
    if (!checked) archive.fail(checked.failure().message);
  }
}

}  // namespace

std::vector<std::byte> write_events(std::span<const sim::Event> events, const voxel::GridLayout& layout) {
  Encoder coder;
  const auto archive = std::make_unique<Archive<Encoder>>(coder, layout, 0, Limits{});
  archive->count(events.size());
  for (sim::Event event : events) code_event(*archive, event);
  const std::vector<std::byte> body = coder.finish();
  ByteWriter out;
  out.number(kFirstByte);
  out.number(static_cast<std::uint32_t>(hash_bytes(body)));
  out.raw(body);
  return out.take();
}

Result<std::vector<sim::Event>> read_events(std::span<const std::byte> bytes, const voxel::GridLayout& layout,
                                            const Limits& limits) {
  // Check the version and the checksum.
  ByteReader in(bytes);
  const auto first = in.number<std::uint8_t>();
  const auto checksum = in.number<std::uint32_t>();
  if (!in.ok() || first != kFirstByte)
    return Failure{ErrorCode::bad_input, "event log: not one of version " + std::to_string(kVersion)};
  if (checksum != static_cast<std::uint32_t>(hash_bytes(in.remaining())))
    return Failure{ErrorCode::bad_input, "event log: damaged, its checksum is wrong"};

  // Decode the events.
  Decoder coder(in.remaining());
  const auto archive = std::make_unique<Archive<Decoder>>(coder, layout, 0, limits);
  const std::uint64_t count = archive->count(0);
  std::vector<sim::Event> events;
  for (std::uint64_t i = 0; i < count && archive->ok(); ++i) {
    sim::Event event;
    code_event(*archive, event);
    events.push_back(std::move(event));
  }
  if (!archive->reason().empty()) return Failure{ErrorCode::bad_input, "event log: " + archive->reason()};
  if (!coder.at_end())
    return Failure{ErrorCode::bad_input,
                   "event log: truncated, or longer than its number of events; write it again"};
  return events;
}

}  // namespace brume::wire
