// SPDX-License-Identifier: Apache-2.0
#include "proto/wire/codec.h"

#include <capnp/serialize.h>
#include <kj/exception.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>

#include "proto/base/failure.h"
#include "proto/settings/limits.h"
#include "proto/settings/transition.h"
#include "proto/wire/wire.capnp.h"

namespace corridor {
namespace {

static_assert(std::endian::native == std::endian::little, "wire.capnp's numbers are little-endian");

using capnp::word;

// Every message is one segment after a table of one word: (segments - 1, words of the first).
constexpr std::size_t kTableBytes = sizeof(word);
struct SegmentTable {
  std::uint32_t segments_less_one = 0;
  std::uint32_t words = 0;
};
static_assert(sizeof(SegmentTable) == kTableBytes);

// ---- Encoding: Cap'n Proto builds in place, in the bytes that are sent.

// Room for what is not payload: pointers, the structs' own numbers, rounding up to whole words.
constexpr std::size_t kFrameWords = 64;

// Writes the table of a message built behind it; returns how many bytes both take.
std::size_t write_table(capnp::MessageBuilder& message, void* table_at) {
  const auto segments = message.getSegmentsForOutput();
  CORRIDOR_CHECK(segments.size() == 1, "{} segments", segments.size());
  const SegmentTable table{0, static_cast<std::uint32_t>(segments[0].size())};
  std::memcpy(table_at, &table, sizeof table);
  return kTableBytes + segments[0].asBytes().size();
}

// `fill` sets the fields of an empty Root. `payload_bytes` bounds the sum of its texts and data.
template <typename Root, typename Fill>
Bytes build(std::size_t payload_bytes, const Fill& fill) {
  const std::size_t words = kFrameWords + payload_bytes / sizeof(word);
  Bytes bytes(kTableBytes + words * sizeof(word));
  // operator new aligns to two words, and zeroed memory is what the builder asks for.
  capnp::FlatMessageBuilder message(
      kj::arrayPtr(reinterpret_cast<word*>(bytes.data() + kTableBytes), words));
  fill(message.initRoot<Root>());
  bytes.resize(write_table(message, bytes.data()));
  return bytes;
}

template <typename T>
capnp::Data::Reader data_of(const std::vector<T>& values, std::size_t bytes_max = kDataBytesMax) {
  const std::size_t size = values.size() * sizeof(T);
  CORRIDOR_CHECK(size <= bytes_max, "{} bytes in a field of at most {}", size, bytes_max);
  return {reinterpret_cast<const kj::byte*>(values.data()), size};
}

capnp::Text::Reader text_of(const std::string& text, std::size_t bytes_max) {
  CORRIDOR_CHECK(text.size() <= bytes_max, "{} bytes of text, at most {}", text.size(), bytes_max);
  return {text.c_str(), text.size()};
}

template <typename... Ts>
std::size_t bytes_in(const std::vector<Ts>&... lists) {
  return (std::size_t{0} + ... + (lists.size() * sizeof(Ts)));
}

// Of a message whose texts and data are more than the frame has room for.
std::size_t payload_bytes(const Insert& insert) {
  return bytes_in(insert.rows, insert.priorities, insert.open.actions);
}
std::size_t payload_bytes(const Step& step) { return bytes_in(step.keys, step.priorities); }
std::size_t payload_bytes(const Save& save) { return save.directory.size() + save.previous.size(); }
std::size_t payload_bytes(const Joined& joined) { return bytes_in(joined.open.actions); }
std::size_t payload_bytes(const Weights& weights) {
  std::size_t bytes = 0;
  for (const std::vector<float>& parameters : weights.networks.by_id) bytes += bytes_in(parameters);
  return bytes;
}
template <typename Message>
std::size_t payload_bytes(const Message&) {
  return 0;
}

void fill(wire::OpenEpisode::Builder to, const OpenEpisode& open) {
  to.setEpisode(open.episode);
  to.setActions(data_of(open.actions, kActionsBytesMax));
}

void fill(wire::ReplayRequest::Builder root, const Join&) { root.setJoin(); }

void fill(wire::ReplayRequest::Builder root, const Insert& insert) {
  auto to = root.initInsert();
  to.setRound(insert.round);
  to.setObservations(insert.observations);
  to.setRows(data_of(insert.rows));
  to.setPriorities(data_of(insert.priorities));
  fill(to.initOpen(), insert.open);
}

void fill(wire::ReplayRequest::Builder root, const OpenBlock& block) {
  root.initOpenBlock().setRound(block.round);
}

void fill(wire::ReplayRequest::Builder root, const Step& step) {
  auto to = root.initStep();
  to.setKeys(data_of(step.keys));
  to.setPriorities(data_of(step.priorities));
  to.setCount(step.count);
  to.setImportanceExponent(step.importance_exponent);
}

void fill(wire::ReplayRequest::Builder root, const Save& save) {
  auto to = root.initSave();
  to.setDirectory(text_of(save.directory, kDirectoryBytesMax));
  to.setPrevious(text_of(save.previous, kDirectoryBytesMax));
}

void fill(wire::ReplayReply::Builder root, const Joined& joined) {
  auto to = root.initJoined();
  to.setNextRound(joined.next_round);
  fill(to.initOpen(), joined.open);
}

void fill(wire::ReplayReply::Builder root, const Inserted&) { root.setInserted(); }

void fill(wire::ReplayReply::Builder root, const Opened& opened) {
  root.initOpened().setBatches(opened.batches);
}

void fill(wire::ReplayReply::Builder root, const Saved& saved) {
  root.initSaved().setComplete(saved.complete);
}

void fill(wire::LearnerRequest::Builder root, const WeightsWanted& wanted) {
  root.initWeights().setVersion(wanted.version);
}

void fill(wire::LearnerRequest::Builder root, const SelectionOutcome& outcome) {
  auto to = root.initSelection();
  to.setRound(outcome.round);
  to.setEpisodes(outcome.episodes);
  to.setSteps(outcome.steps);
  to.setReward(outcome.reward);
  to.setCollisions(outcome.collisions);
}

void fill(wire::LearnerReply::Builder root, const Weights& weights) {
  static_assert(kNetworks.size() <= kNetworksMax);
  auto to = root.initWeights();
  to.setVersion(weights.version);
  auto networks = to.initNetworks(static_cast<unsigned>(kNetworks.size()));
  for (unsigned i = 0; i < kNetworks.size(); ++i) {
    networks[i].setName(text_of(kNetworks[i].name, kNetworkNameBytesMax));
    networks[i].setParameters(data_of(weights.networks[kNetworks[i].id]));
  }
}

void fill(wire::LearnerReply::Builder root, const Noted&) { root.setNoted(); }

template <typename Root, typename... Kinds>
Bytes encode_kind(const std::variant<Kinds...>& message) {
  return std::visit(
      [](const auto& kind) {
        return build<Root>(payload_bytes(kind), [&](auto root) { fill(root, kind); });
      },
      message);
}

// ---- Decoding: bytes from anywhere. `require` is to Malformed what CORRIDOR_CHECK is to bugs.

template <typename... Args>
void require(bool condition, fmt::format_string<Args...> reason, Args&&... args) {
  if (!condition) throw Malformed(fmt::format(reason, std::forward<Args>(args)...));
}

// The same bytes where Cap'n Proto can read their words.
Body aligned(const Body& body) {
  const ByteView bytes = body;
  const bool is = reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(word) == 0;
  return is ? body : Body(Bytes(bytes.begin(), bytes.end()));
}

// Calls `read` with the message's root.
template <typename Root, typename Read>
auto decode(ByteView from, const Read& read) {
  const Body owner = aligned(Body(nullptr, from));
  const ByteView bytes = owner;
  require(bytes.size() > kTableBytes && bytes.size() % sizeof(word) == 0, "{} bytes are no message",
          bytes.size());
  SegmentTable table;
  std::memcpy(&table, bytes.data(), sizeof table);
  const ByteView body = bytes.subspan(kTableBytes);
  require(table.segments_less_one == 0 && table.words == body.size() / sizeof(word),
          "a segment table of {} segments and {} words before {} bytes",
          std::uint64_t{table.segments_less_one} + 1, table.words, body.size());

  const kj::ArrayPtr<const word> segment(reinterpret_cast<const word*>(body.data()), table.words);
  capnp::ReaderOptions limits;
  limits.traversalLimitInWords = 4 * segment.size();
  limits.nestingLimit = 4;
  try {
    capnp::SegmentArrayMessageReader message(kj::arrayPtr(&segment, 1), limits);
    return read(message.getRoot<Root>());
  } catch (const kj::Exception& error) {
    throw Malformed(error.getDescription().cStr());
  }
}

// Where it lies: Cap'n Proto's data begin at whole words.
template <typename T>
std::span<const T> span_of(capnp::Data::Reader data, const char* name,
                           std::size_t bytes_max = kDataBytesMax) {
  require(data.size() <= bytes_max, "{} has {} bytes, more than {}", name, data.size(), bytes_max);
  require(data.size() % sizeof(T) == 0, "{} has {} bytes, no multiple of {}", name, data.size(),
          sizeof(T));
  return {reinterpret_cast<const T*>(data.begin()), data.size() / sizeof(T)};
}

template <typename T>
std::vector<T> values_of(capnp::Data::Reader data, const char* name,
                         std::size_t bytes_max = kDataBytesMax) {
  const std::span<const T> values = span_of<T>(data, name, bytes_max);
  return {values.begin(), values.end()};
}

std::string string_of(capnp::Text::Reader text, const char* name, std::size_t bytes_max) {
  require(text.size() <= bytes_max, "{} has {} bytes, more than {}", name, text.size(), bytes_max);
  return {text.cStr(), text.size()};
}

// How many whole rows there are.
std::size_t row_count(std::span<const float> rows, std::uint32_t observations) {
  require(observations <= kObservationsMax, "{} observations, more than {}", observations,
          kObservationsMax);
  const std::size_t stride = RowLayout{static_cast<int>(observations)}.stride();
  require(rows.size() % stride == 0, "{} floats are not whole rows of {}", rows.size(), stride);
  return rows.size() / stride;
}

void require_count(std::size_t count, std::size_t wanted, const char* names) {
  require(count == wanted, "{} {} for {} rows or keys", count, names, wanted);
}

void require_priorities(const std::vector<float>& priorities, std::size_t count) {
  require_count(priorities.size(), count, "priorities");
  for (const float priority : priorities) {
    require(std::isfinite(priority) && priority >= 0.0F, "a priority of {}", priority);
  }
}

OpenEpisode read_open(wire::OpenEpisode::Reader from) {
  return {from.getEpisode(),
          values_of<std::uint8_t>(from.getActions(), "actions", kActionsBytesMax)};
}

Insert read_insert(wire::ReplayRequest::Insert::Reader from) {
  Insert insert{from.getRound(), from.getObservations(), values_of<float>(from.getRows(), "rows"),
                values_of<float>(from.getPriorities(), "priorities"), read_open(from.getOpen())};
  require_priorities(insert.priorities, row_count(insert.rows, insert.observations));
  return insert;
}

Step read_step(wire::ReplayRequest::Step::Reader from) {
  Step step{values_of<std::uint64_t>(from.getKeys(), "keys"),
            values_of<float>(from.getPriorities(), "priorities"), from.getCount(),
            from.getImportanceExponent()};
  require_priorities(step.priorities, step.keys.size());
  require(step.count <= kRowsPerStepMax, "{} rows wanted, more than {}", step.count,
          kRowsPerStepMax);
  require(std::isfinite(step.importance_exponent), "an importance exponent of {}",
          step.importance_exponent);
  return step;
}

// Without its body.
ReceivedBatch read_batch(wire::ReplayReply::Batch::Reader from) {
  ReceivedBatch batch{from.getObservations(),
                      span_of<float>(from.getRows(), "rows"),
                      span_of<std::uint64_t>(from.getKeys(), "keys"),
                      span_of<float>(from.getWeights(), "weights"),
                      {}};
  const std::size_t rows = row_count(batch.rows, batch.observations);
  require_count(batch.keys.size(), rows, "keys");
  require_count(batch.weights.size(), rows, "weights");
  return batch;
}

Weights read_weights(wire::LearnerReply::Weights::Reader from) {
  Weights weights{from.getVersion(), {}};
  const auto networks = from.getNetworks();
  require(networks.size() == kNetworks.size(), "{} networks, {} are known", networks.size(),
          kNetworks.size());
  for (const NamedNetwork& network : kNetworks) {
    const auto sent = networks[static_cast<unsigned>(network.id)];
    const std::string name = string_of(sent.getName(), "name", kNetworkNameBytesMax);
    require(name == network.name, "a network '{}' in the place of '{}'", name, network.name);
    weights.networks[network.id] = values_of<float>(sent.getParameters(), network.name);
  }
  return weights;
}

[[noreturn]] void unknown_kind(const char* name, unsigned kind) {
  throw Malformed(fmt::format("{} of unknown kind {}", name, kind));
}

// Of an enum whose values are those of `To`.
template <typename To, typename From>
To enum_of(From value, From last, const char* name) {
  if (value > last) unknown_kind(name, static_cast<unsigned>(value));
  return static_cast<To>(value);
}

}  // namespace

BatchToFill batch_to_fill(std::uint32_t observations, std::size_t rows) {
  const std::size_t stride = RowLayout{static_cast<int>(observations)}.stride();
  const std::size_t row_bytes = rows * stride * sizeof(float);
  CORRIDOR_CHECK(row_bytes <= kDataBytesMax, "{} bytes of rows", row_bytes);
  const std::size_t payload_bytes =
      row_bytes + rows * (sizeof(std::uint64_t) + sizeof(float)) + 2 * sizeof(word);
  const std::size_t words = kFrameWords + payload_bytes / sizeof(word);
  // Only what is no row, key or weight need be zeroed for the builder.
  const auto memory = std::make_shared_for_overwrite<std::uint64_t[]>(words + 1);
  std::memset(memory.get(), 0, kTableBytes + kFrameWords * sizeof(word));
  capnp::FlatMessageBuilder message(kj::arrayPtr(reinterpret_cast<word*>(memory.get() + 1), words));
  auto batch = message.initRoot<wire::ReplayReply>().initBatch();
  batch.setObservations(observations);
  const auto part = [&]<typename T>(capnp::Data::Builder data) {
    std::memset(data.end(), 0, (sizeof(word) - data.size() % sizeof(word)) % sizeof(word));
    return std::span<T>(reinterpret_cast<T*>(data.begin()), data.size() / sizeof(T));
  };
  BatchToFill result;
  const auto size = [](std::size_t bytes) { return static_cast<unsigned>(bytes); };
  result.rows = part.operator()<float>(batch.initRows(size(row_bytes)));
  result.keys = part.operator()<std::uint64_t>(batch.initKeys(size(rows * sizeof(std::uint64_t))));
  result.weights = part.operator()<float>(batch.initWeights(size(rows * sizeof(float))));
  const std::size_t size_bytes = write_table(message, memory.get());
  result.body = Body(memory, {reinterpret_cast<const std::byte*>(memory.get()), size_bytes});
  return result;
}

Bytes encode(const Header& header) {
  return build<wire::Header>(header.run_id.size() + header.refusal.size(), [&](auto to) {
    to.setProtocol(header.protocol);
    to.setRunId(text_of(header.run_id, kRunIdBytesMax));
    to.setRole(static_cast<wire::Header::Role>(header.client.role));
    to.setIndex(header.client.index);
    to.setIncarnation(header.incarnation);
    to.setSequence(header.sequence);
    to.setKind(static_cast<wire::Header::Kind>(header.kind));
    if (!header.refusal.empty()) to.setRefusal(text_of(header.refusal, kRefusalBytesMax));
  });
}

Bytes encode(const ReplayRequest& request) { return encode_kind<wire::ReplayRequest>(request); }
Bytes encode(const ReplayReply& reply) { return encode_kind<wire::ReplayReply>(reply); }
Bytes encode(const LearnerRequest& request) { return encode_kind<wire::LearnerRequest>(request); }
Bytes encode(const LearnerReply& reply) { return encode_kind<wire::LearnerReply>(reply); }

Header decode_header(ByteView bytes) {
  return decode<wire::Header>(bytes, [](wire::Header::Reader from) {
    return Header{
        from.getProtocol(),
        string_of(from.getRunId(), "runId", kRunIdBytesMax),
        {enum_of<Role>(from.getRole(), wire::Header::Role::LEARNER, "a role"), from.getIndex()},
        from.getIncarnation(),
        from.getSequence(),
        enum_of<MessageKind>(from.getKind(), wire::Header::Kind::REFUSED, "a header"),
        string_of(from.getRefusal(), "refusal", kRefusalBytesMax)};
  });
}

ReplayRequest decode_replay_request(ByteView bytes) {
  using wire::ReplayRequest;
  return decode<ReplayRequest>(bytes, [](ReplayRequest::Reader from) -> corridor::ReplayRequest {
    switch (from.which()) {
      case ReplayRequest::JOIN:
        return Join{};
      case ReplayRequest::INSERT:
        return read_insert(from.getInsert());
      case ReplayRequest::OPEN_BLOCK:
        return OpenBlock{from.getOpenBlock().getRound()};
      case ReplayRequest::STEP:
        return read_step(from.getStep());
      case ReplayRequest::SAVE:
        return Save{string_of(from.getSave().getDirectory(), "directory", kDirectoryBytesMax),
                    string_of(from.getSave().getPrevious(), "previous", kDirectoryBytesMax)};
    }
    unknown_kind("a replay request", from.which());
  });
}

ReplayReply decode_replay_reply(ByteView bytes) {
  using wire::ReplayReply;
  return decode<ReplayReply>(bytes, [](ReplayReply::Reader from) -> corridor::ReplayReply {
    switch (from.which()) {
      case ReplayReply::JOINED:
        return Joined{from.getJoined().getNextRound(), read_open(from.getJoined().getOpen())};
      case ReplayReply::INSERTED:
        return Inserted{};
      case ReplayReply::OPENED:
        return Opened{from.getOpened().getBatches()};
      case ReplayReply::BATCH:
        throw Malformed("a batch where another reply is due");
      case ReplayReply::SAVED:
        return Saved{from.getSaved().getComplete()};
    }
    unknown_kind("a replay reply", from.which());
  });
}

LearnerRequest decode_learner_request(ByteView bytes) {
  using wire::LearnerRequest;
  return decode<LearnerRequest>(bytes, [](LearnerRequest::Reader from) -> corridor::LearnerRequest {
    switch (from.which()) {
      case LearnerRequest::WEIGHTS:
        return WeightsWanted{from.getWeights().getVersion()};
      case LearnerRequest::SELECTION: {
        const auto outcome = from.getSelection();
        require(std::isfinite(outcome.getReward()), "a reward of {}", outcome.getReward());
        return SelectionOutcome{outcome.getRound(), outcome.getEpisodes(), outcome.getSteps(),
                                outcome.getReward(), outcome.getCollisions()};
      }
    }
    unknown_kind("a learner request", from.which());
  });
}

LearnerReply decode_learner_reply(ByteView bytes) {
  using wire::LearnerReply;
  return decode<LearnerReply>(bytes, [](LearnerReply::Reader from) -> corridor::LearnerReply {
    switch (from.which()) {
      case LearnerReply::WEIGHTS:
        return read_weights(from.getWeights());
      case LearnerReply::NOTED:
        return Noted{};
    }
    unknown_kind("a learner reply", from.which());
  });
}

std::optional<ReceivedBatch> decode_batch(Body body) {
  body = aligned(body);
  return decode<wire::ReplayReply>(
      body, [&](wire::ReplayReply::Reader from) -> std::optional<ReceivedBatch> {
        if (!from.isBatch()) return std::nullopt;
        ReceivedBatch batch = read_batch(from.getBatch());
        batch.body = body;
        return batch;
      });
}

}  // namespace corridor
