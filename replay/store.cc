// SPDX-License-Identifier: Apache-2.0
#include "replay/store.h"

#include <sys/mman.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "proto/base/failure.h"
#include "proto/base/random.h"
#include "proto/run/checkpoints.h"
#include "replay/power.h"

namespace corridor::replay {
namespace {

// A row is asked for so many rows before it is copied: memory answers about so late.
constexpr std::size_t kRowsAhead = 8;
constexpr std::size_t kFloatsPerCacheLine = 16;

std::uint64_t number(const TensorFile& file, const std::string& tensor, const std::string& name) {
  const auto& values = file.get<std::uint64_t>(tensor, name);
  if (values.size() != 1) {
    throw Failure("{}: \"{}\" has {} values, not 1; the file is damaged, use an older checkpoint",
                  name, tensor, values.size());
  }
  return values[0];
}

}  // namespace

// Without an early end, so that the loops are vector instructions: bits of a float that is not
// finite have all of the exponent's set.
bool are_finite(std::span<const float> values) {
  constexpr std::uint32_t kExponent = 0x7f800000;
  std::uint32_t bad = 0;
  for (const float value : values) {
    bad |=
        static_cast<std::uint32_t>((std::bit_cast<std::uint32_t>(value) & kExponent) == kExponent);
  }
  return bad == 0;
}

bool are_priorities(std::span<const float> values) {
  std::uint32_t bad = 0;
  for (const float value : values) bad |= static_cast<std::uint32_t>(value < 0.0F);
  return bad == 0 && are_finite(values);
}

Store::Store(const DqnSettings& settings, RowLayout layout, std::uint64_t seed, Phase phase,
             std::uint64_t first_key)
    : capacity_(static_cast<std::size_t>(settings.capacity)),
      priority_exponent_(static_cast<float>(settings.priority_exponent)),
      priority_offset_(static_cast<float>(settings.priority_offset)),
      layout_(layout),
      draws_(seed, Purpose::kReplaySampling, {static_cast<std::uint64_t>(phase)}),
      first_key_(first_key),
      next_key_(first_key),
      rows_(uninitialised(capacity_ * layout.stride())),
      tree_(capacity_) {
  CORRIDOR_CHECK(priority_offset_ > 0.0F, "priority_offset {}", priority_offset_);
}

// In huge pages where the system has them: a row is somewhere in hundreds of megabytes, and an
// address that the processor does not know costs as much as the row.
std::unique_ptr<float[], Store::Free> Store::uninitialised(std::size_t floats) {
  constexpr std::size_t kHugePage = 2 * 1024 * 1024;
  const std::size_t bytes = (floats * sizeof(float) + kHugePage - 1) / kHugePage * kHugePage;
  auto* memory = static_cast<float*>(std::aligned_alloc(kHugePage, bytes));
  if (memory == nullptr) {
    throw Failure("no memory for a replay of {} MB: lower [mop] and [bp] capacity", bytes >> 20);
  }
  madvise(memory, bytes, MADV_HUGEPAGE);
  return std::unique_ptr<float[], Free>(memory);
}

std::uint64_t Store::oldest_key() const {
  return next_key_ - std::min<std::uint64_t>(next_key_ - first_key_, capacity_);
}

// slots_ take the leaves of these |TD errors|.
void Store::set_leaves(std::span<const float> priorities) {
  leaves_.resize(priorities.size());
  for (std::size_t i = 0; i < priorities.size(); ++i) {
    leaves_[i] = priorities[i] + priority_offset_;
  }
  power(leaves_, priority_exponent_, leaves_);
  tree_.set(slots_, leaves_);
}

void Store::insert(std::span<const float> rows, std::span<const float> priorities) {
  const std::size_t stride = layout_.stride();
  CORRIDOR_CHECK(rows.size() == priorities.size() * stride, "{} floats for {} rows of {}",
                 rows.size(), priorities.size(), stride);
  slots_.clear();
  for (std::size_t i = 0; i < priorities.size(); ++i) slots_.push_back((next_key_ + i) % capacity_);
  // Up to the ring's end at once.
  for (std::size_t i = 0; i < priorities.size();) {
    const std::size_t count = std::min<std::size_t>(priorities.size() - i, capacity_ - slots_[i]);
    std::memcpy(row(slots_[i]), rows.data() + i * stride, count * stride * sizeof(float));
    i += count;
  }
  next_key_ += priorities.size();
  set_leaves(priorities);
}

void Store::update(std::span<const std::uint64_t> keys, std::span<const float> priorities) {
  CORRIDOR_CHECK(keys.size() == priorities.size(), "{} keys, {} priorities", keys.size(),
                 priorities.size());
  slots_.clear();
  fresh_.clear();
  const std::uint64_t oldest = oldest_key();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    CORRIDOR_CHECK(keys[i] < next_key_, "key {} of {}", keys[i], next_key_);
    if (keys[i] < oldest) {
      ++stale_priorities_;
      continue;
    }
    slots_.push_back(keys[i] % capacity_);
    fresh_.push_back(priorities[i]);
  }
  set_leaves(fresh_);
}

void Store::sample(double importance_exponent, const Drawn& into) {
  const std::size_t count = into.keys.size();
  const std::size_t stride = layout_.stride();
  CORRIDOR_CHECK(into.rows.size() == count * stride && into.weights.size() == count,
                 "room for {} floats, {} keys, {} weights", into.rows.size(), count,
                 into.weights.size());
  if (count == 0) return;

  units_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    units_[i] = (static_cast<double>(i) + draws_.unit(sampled_++)) / static_cast<double>(count);
  }
  slots_.resize(count);
  tree_.sample(units_, slots_);

  leaves_.resize(count);
  const std::uint64_t oldest = oldest_key();
  const std::uint64_t oldest_slot = oldest % capacity_;
  for (std::size_t i = 0; i < count; ++i) {
    if (i + kRowsAhead < count) prefetch(slots_[i + kRowsAhead]);
    const std::uint64_t slot = slots_[i];
    std::memcpy(into.rows.data() + i * stride, row(slot), stride * sizeof(float));
    const std::uint64_t age =
        slot >= oldest_slot ? slot - oldest_slot : slot + capacity_ - oldest_slot;
    into.keys[i] = oldest + age;
    leaves_[i] = tree_.value(slot);
  }
  // The least probable row has the largest weight, and size and total cancel out in the quotient.
  const float smallest = *std::min_element(leaves_.begin(), leaves_.end());
  for (float& leaf : leaves_) leaf = smallest / leaf;
  power(leaves_, static_cast<float>(importance_exponent), into.weights);
}

void Store::prefetch(std::uint64_t slot) const {
  const float* const last = row(slot) + layout_.stride() - 1;
  for (const float* line = row(slot); line < last; line += kFloatsPerCacheLine) {
    __builtin_prefetch(line);
  }
  __builtin_prefetch(last);
}

std::vector<float> Store::rows_from(std::uint64_t key) const {
  CORRIDOR_CHECK(key >= oldest_key() && key <= next_key_, "key {} of {} to {}", key, oldest_key(),
                 next_key_);
  const std::size_t stride = layout_.stride();
  std::vector<float> rows;
  rows.reserve((next_key_ - key) * stride);
  for (; key < next_key_; ++key) {
    const float* const first = row(key % capacity_);
    rows.insert(rows.end(), first, first + stride);
  }
  return rows;
}

void Store::save(TensorFile& file) const {
  std::vector<float> leaves;
  leaves.reserve(size());
  for (std::uint64_t key = oldest_key(); key < next_key_; ++key) {
    leaves.push_back(tree_.value(key % capacity_));
  }
  file.put(kLeavesTensor, std::move(leaves));
  file.put("first_key", std::vector{first_key_});
  file.put(kNextKeyTensor, std::vector{next_key_});
  file.put("sampled", std::vector{sampled_});
  file.put("stale_priorities", std::vector{stale_priorities_});
}

void Store::load(const TensorFile& file, const std::string& name) {
  CORRIDOR_CHECK(inserted() == 0, "{} rows in the way", inserted());
  const auto& leaves = file.get<float>(kLeavesTensor, name);
  first_key_ = number(file, "first_key", name);
  next_key_ = number(file, kNextKeyTensor, name);
  sampled_ = number(file, "sampled", name);
  stale_priorities_ = number(file, "stale_priorities", name);
  const bool fits = first_key_ <= next_key_ && leaves.size() == size() && are_priorities(leaves);
  if (!fits) {
    throw Failure(
        "{}: {} priorities for keys {} to {}, capacity {}; the file is damaged or of another "
        "configuration, use the run's own checkpoint",
        name, leaves.size(), first_key_, next_key_, capacity_);
  }
  slots_.clear();
  for (std::uint64_t key = oldest_key(); key < next_key_; ++key) slots_.push_back(key % capacity_);
  tree_.set(slots_, leaves);
}

void Store::load_rows(std::uint64_t first_key, const TensorFile& file, const std::string& name) {
  const auto& rows = file.get<float>(kRowsTensor, name);
  const std::size_t stride = layout_.stride();
  const std::uint64_t count = rows.size() / stride;
  if (rows.size() % stride != 0 || !are_finite(rows) || first_key > next_key_ ||
      count > next_key_ - first_key) {
    throw Failure(
        "{}: {} floats are no rows of {} with keys from {} to at most {}; use an older "
        "checkpoint",
        name, rows.size(), stride, first_key, next_key_);
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    if (first_key + i < oldest_key()) continue;
    std::memcpy(row((first_key + i) % capacity_), rows.data() + i * stride, stride * sizeof(float));
  }
}

}  // namespace corridor::replay
