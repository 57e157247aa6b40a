// Checks of atomic operations on storage buffers, one at a time and under contention.
#include <fmt/format.h>

#include "gl/commands.h"
#include "lists/validation/probe_gpu.h"

namespace sfumato::lists::validation {
namespace {

const std::vector<std::string> everyStrategy = {"spinlock", "lockfree", "append", "count"};

struct Tickets {
  uint64_t drawn = 0;      // tickets in all
  uint64_t duplicate = 0;  // drawn more than once
  uint64_t missing = 0;    // below the counter, but never drawn
  uint64_t kept = 0;       // what the counters say
  bool right() const { return duplicate == 0 && missing == 0 && kept == drawn; }
};

// Every fragment of `layers` squares draws a ticket from one of `addresses` counters.
Tickets drawTickets(const Context& context, int side, size_t layers, uint32_t addresses, bool atomic) {
  const uint32_t fragments =
      static_cast<uint32_t>(side) * static_cast<uint32_t>(side) * static_cast<uint32_t>(layers);
  const uint32_t capacity = addresses == 1 ? fragments : 2 * fragments / addresses + 64;
  gl::ShaderDefines defines = {{"SIDE", fmt::format("{}u", side)},
                               {"ADDRESSES", fmt::format("{}u", addresses)},
                               {"CAPACITY", fmt::format("{}u", capacity)}};
  if (!atomic) defines.emplace_back("WITHOUT_ATOMIC", "1");
  const gl::Program& program = probeProgram(context, {"layers.vert", "ticket.frag"}, defines);
  gl::Buffer counters = zeroWords(context.device, addresses);
  gl::Buffer drawn = zeroWords(context.device, size_t{addresses} * capacity);
  gl::Buffer outcome = zeroWords(context.device, 1);
  counters.bindStorage(0);
  drawn.bindStorage(1);
  outcome.bindStorage(2);
  drawLayers(context.device, program, side, layers);
  gl::storageBarrier();

  Tickets tickets{.drawn = fragments};
  const auto count = counters.readValues<uint32_t>(addresses);
  const auto times = drawn.readValues<uint32_t>(size_t{addresses} * capacity);
  for (uint32_t a = 0; a < addresses; ++a) {
    tickets.kept += count[a];
    for (uint32_t t = 0; t < capacity; ++t) {
      const uint32_t n = times[size_t{a} * capacity + t];
      if (n > 1) tickets.duplicate += n - 1;
      if (n == 0 && t < count[a]) ++tickets.missing;
    }
  }
  return tickets;
}

Result ticket(const Context& context) {
  const int side = context.scale == Scale::Full ? 512 : 256;
  const size_t layers = 4;
  const Tickets tickets = drawTickets(context, side, layers, 1, true);
  Result result;
  result.figures = {{"fragments", static_cast<int64_t>(tickets.drawn)},
                    {"kept", static_cast<int64_t>(tickets.kept)}};
  if (!tickets.right()) {
    result.verdict = Verdict::Fail;
    result.finding = fmt::format("{} tickets drawn: {} kept, {} twice, {} never", tickets.drawn, tickets.kept,
                                 tickets.duplicate, tickets.missing);
    result.meaning = "nodes are lost or shared: no list can be built on this driver";
    return result;
  }
  const Tickets control = drawTickets(context, side, layers, 1, false);
  result.figures.emplace_back("kept by a plain increment", static_cast<int64_t>(control.kept));
  if (control.right()) {
    result.verdict = Verdict::NoPower;
    result.finding = "a plain increment lost nothing either";
  }
  return result;
}

}  // namespace

std::vector<Check> atomicsChecks() {
  return {
      {.name = "ticket",
       .group = "atomics",
       .does = "every fragment draws a ticket from one counter: each ticket once",
       .strategies = everyStrategy,
       .mutants = {"NO_ATOMIC"},
       .run = ticket},
  };
}

}  // namespace sfumato::lists::validation
