#include "replay/store.h"

#include <algorithm>
#include <cmath>

#include "proto/failure.h"
#include "proto/random.h"

namespace corridor::replay {
namespace {

std::uint64_t number(const TensorFile& file, const std::string& tensor, const std::string& name) {
  const auto& values = file.get<std::uint64_t>(tensor, name);
  if (values.size() != 1) {
    throw Failure("{}: \"{}\" has {} values, not 1; the file is damaged, use an older checkpoint",
                  name, tensor, values.size());
  }
  return values[0];
}

}  // namespace

bool are_priorities(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(),
                     [](float value) { return std::isfinite(value) && value >= 0.0F; });
}

Store::Store(const DqnSettings& settings, RowLayout layout, std::uint64_t seed, Phase phase,
             std::uint64_t first_key)
    : capacity_(static_cast<std::size_t>(settings.capacity)),
      priority_exponent_(settings.priority_exponent),
      priority_offset_(settings.priority_offset),
      layout_(layout),
      seed_(seed),
      phase_(phase),
      first_key_(first_key),
      next_key_(first_key),
      rows_(capacity_ * layout.stride()),
      tree_(capacity_) {
  CORRIDOR_CHECK(priority_offset_ > 0.0, "priority_offset {}", priority_offset_);
}

std::uint64_t Store::oldest_key() const {
  return next_key_ - std::min<std::uint64_t>(next_key_ - first_key_, capacity_);
}

double Store::leaf(float priority) const {
  return std::pow(static_cast<double>(priority) + priority_offset_, priority_exponent_);
}

void Store::insert(std::span<const float> rows, std::span<const float> priorities) {
  const std::size_t stride = layout_.stride();
  CORRIDOR_CHECK(rows.size() == priorities.size() * stride, "{} floats for {} rows of {}",
                 rows.size(), priorities.size(), stride);
  slots_.clear();
  numbers_.clear();
  for (std::size_t i = 0; i < priorities.size(); ++i) {
    const std::uint64_t slot = next_key_++ % capacity_;
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(i * stride), stride,
                rows_.begin() + static_cast<std::ptrdiff_t>(slot * stride));
    slots_.push_back(slot);
    numbers_.push_back(leaf(priorities[i]));
  }
  tree_.set(slots_, numbers_);
}

void Store::update(std::span<const std::uint64_t> keys, std::span<const float> priorities) {
  CORRIDOR_CHECK(keys.size() == priorities.size(), "{} keys, {} priorities", keys.size(),
                 priorities.size());
  slots_.clear();
  numbers_.clear();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    CORRIDOR_CHECK(keys[i] < next_key_, "key {} of {}", keys[i], next_key_);
    if (keys[i] < oldest_key()) {
      ++stale_priorities_;
      continue;
    }
    slots_.push_back(keys[i] % capacity_);
    numbers_.push_back(leaf(priorities[i]));
  }
  tree_.set(slots_, numbers_);
}

Batch Store::sample(std::uint32_t count, double importance_exponent) {
  Batch batch;
  batch.observations = static_cast<std::uint32_t>(layout_.observations);
  if (count == 0) return batch;

  numbers_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    const double unit = random_unit(seed_, Purpose::kReplaySampling,
                                    {static_cast<std::uint64_t>(phase_), sampled_++});
    numbers_.push_back((i + unit) / count);
  }
  slots_.resize(count);
  tree_.sample(numbers_, slots_);

  const std::size_t stride = layout_.stride();
  batch.rows.reserve(count * stride);
  batch.keys.reserve(count);
  batch.weights.reserve(count);
  const std::uint64_t oldest = oldest_key();
  const std::uint64_t oldest_slot = oldest % capacity_;
  double smallest_leaf = tree_.value(slots_[0]);
  for (const std::uint64_t slot : slots_) {
    const auto row = rows_.begin() + static_cast<std::ptrdiff_t>(slot * stride);
    batch.rows.insert(batch.rows.end(), row, row + static_cast<std::ptrdiff_t>(stride));
    const std::uint64_t age =
        slot >= oldest_slot ? slot - oldest_slot : slot + capacity_ - oldest_slot;
    batch.keys.push_back(oldest + age);
    smallest_leaf = std::min(smallest_leaf, tree_.value(slot));
  }
  // The least probable row has the largest weight, and size and total cancel out in the quotient.
  for (const std::uint64_t slot : slots_) {
    batch.weights.push_back(
        static_cast<float>(std::pow(smallest_leaf / tree_.value(slot), importance_exponent)));
  }
  return batch;
}

void Store::save(TensorFile& file) const {
  const std::size_t stride = layout_.stride();
  std::vector<float> rows;
  std::vector<double> leaves;
  rows.reserve(size() * stride);
  leaves.reserve(size());
  for (std::uint64_t key = oldest_key(); key < next_key_; ++key) {
    const std::uint64_t slot = key % capacity_;
    const auto row = rows_.begin() + static_cast<std::ptrdiff_t>(slot * stride);
    rows.insert(rows.end(), row, row + static_cast<std::ptrdiff_t>(stride));
    leaves.push_back(tree_.value(slot));
  }
  file.tensors.insert_or_assign("rows", Tensor{{leaves.size(), stride}, std::move(rows)});
  file.put("leaves", std::move(leaves));
  file.put("first_key", std::vector{first_key_});
  file.put("next_key", std::vector{next_key_});
  file.put("sampled", std::vector{sampled_});
  file.put("stale_priorities", std::vector{stale_priorities_});
}

void Store::load(const TensorFile& file, const std::string& name) {
  CORRIDOR_CHECK(inserted() == 0, "{} rows in the way", inserted());
  const auto& rows = file.get<float>("rows", name);
  const auto& leaves = file.get<double>("leaves", name);
  first_key_ = number(file, "first_key", name);
  next_key_ = number(file, "next_key", name);
  sampled_ = number(file, "sampled", name);
  stale_priorities_ = number(file, "stale_priorities", name);

  const std::size_t stride = layout_.stride();
  const bool fits = first_key_ <= next_key_ && leaves.size() == size() &&
                    rows.size() == leaves.size() * stride &&
                    std::all_of(leaves.begin(), leaves.end(),
                                [](double value) { return std::isfinite(value) && value >= 0.0; });
  if (!fits) {
    throw Failure(
        "{}: {} floats and {} priorities for keys {} to {} of rows of {} floats, capacity {}; the "
        "file is damaged or of another configuration, use the run's own checkpoint",
        name, rows.size(), leaves.size(), first_key_, next_key_, stride, capacity_);
  }
  slots_.clear();
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const std::uint64_t slot = (oldest_key() + i) % capacity_;
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(i * stride), stride,
                rows_.begin() + static_cast<std::ptrdiff_t>(slot * stride));
    slots_.push_back(slot);
  }
  tree_.set(slots_, leaves);
}

}  // namespace corridor::replay
