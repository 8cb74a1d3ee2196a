#include "wire/packet.hpp"

#include <string>

#include "wire/bytes.hpp"
#include "wire/state_coding.hpp"
#include "wire/world_archive.hpp"

namespace brume::wire {
namespace {

Failure refused(const std::string& what) {
  return {ErrorCode::bad_input, "packet: " + what + "; request it again"};
}

std::uint8_t first_byte(PacketKind kind) {
  return static_cast<std::uint8_t>(kVersion << 4 | static_cast<std::uint8_t>(kind));
}

Result<sim::State> checked(Result<sim::State> state, const PacketHead& head) {
  if (!state) return refused(state.failure().message);
  if (checksum_of(*state) != head.checksum) return refused("the state's checksum differs from the sender's");
  return state;
}

}  // namespace

std::uint32_t checksum_of(const sim::State& state) {
  return static_cast<std::uint32_t>(state.hash());
}

std::vector<std::byte> write_keyframe(const sim::State& state) {
  ByteWriter out;
  out.number(first_byte(PacketKind::keyframe));
  out.varint(state.tick);
  out.number(checksum_of(state));
  write_world(out, archive_of(state));
  out.raw(write_body(sim::State{}, state));
  return out.take();
}

std::vector<std::byte> write_delta(const sim::State& base, const sim::State& now) {
  BRUME_ASSERT(
      base.tick < now.tick && base.events <= now.events && !sim::foreign_reason(now, base, "the base"),
      std::to_string(base.tick) + " to " + std::to_string(now.tick));
  ByteWriter out;
  out.number(first_byte(PacketKind::delta));
  out.varint(now.tick);
  out.varint(now.tick - base.tick);
  out.number(checksum_of(now));
  out.raw(write_body(base, now));
  return out.take();
}

std::vector<std::byte> write_request(const Request& request) {
  ByteWriter out;
  out.number(first_byte(PacketKind::request));
  out.varint(request.tick ? std::uint64_t{*request.tick} + 1 : 0);
  if (request.tick) out.number(request.checksum);
  return out.take();
}

Result<PacketHead> read_head(std::span<const std::byte> packet, const Limits& limits) {
  if (packet.size() > limits.max_bytes)
    return refused(std::to_string(packet.size()) + " bytes, at most " + std::to_string(limits.max_bytes) +
                   " are accepted");

  // Kind and version.
  ByteReader in(packet);
  PacketHead head;
  const auto first = in.number<std::uint8_t>();
  head.kind = static_cast<PacketKind>(first & 0xf);
  if (!in.ok() || first >> 4 != kVersion ||
      (head.kind != PacketKind::keyframe && head.kind != PacketKind::delta))
    return refused("not a keyframe or delta of version " + std::to_string(kVersion));

  // Ticks and checksum.
  head.tick = static_cast<std::uint32_t>(in.varint(kMaxPacketTick));
  if (head.kind == PacketKind::delta) {
    const std::uint64_t ticks = in.varint(head.tick);
    if (ticks == 0) return refused("a delta must start from an earlier tick");
    head.base_tick = head.tick - static_cast<std::uint32_t>(ticks);
  }
  head.checksum = in.number<std::uint32_t>();
  head.body = in.remaining();
  if (!in.ok()) return refused("truncated");
  return head;
}

Result<Request> read_request(std::span<const std::byte> packet) {
  ByteReader in(packet);
  const auto first = in.number<std::uint8_t>();
  const std::uint64_t tick = in.varint(std::uint64_t{1} << 32);
  Request request;
  if (tick > 0) {
    request.tick = static_cast<std::uint32_t>(tick - 1);
    request.checksum = in.number<std::uint32_t>();
  }
  if (!in.ok() || first != first_byte(PacketKind::request) || !in.remaining().empty())
    return refused("not a request of version " + std::to_string(kVersion));
  return request;
}

Result<sim::State> read_keyframe(const PacketHead& head, const Limits& limits) {
  ByteReader in(head.body);
  const auto world = read_world(in);
  if (!world) return refused(world.failure().message);
  return checked(read_body(in.remaining(), first_state(*world), head.tick, limits), head);
}

Result<sim::State> read_delta(const PacketHead& head, const sim::State& base, const Limits& limits) {
  return checked(read_body(head.body, base, head.tick, limits), head);
}

}  // namespace brume::wire
