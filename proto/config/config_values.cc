// SPDX-License-Identifier: Apache-2.0
#include "proto/config/config_values.h"

#include <algorithm>
#include <type_traits>

#include "proto/base/text.h"
#include "proto/config/config_keys.h"
#include "proto/config/run_config.h"
#include "proto/config/toml_text.h"

namespace corridor {
namespace {

class Writer {
 public:
  void table(const char* name, const char* comment, Heeds) {
    text_ += fmt::format("{}# {}\n[{}]\n", text_.empty() ? "" : "\n", comment, name);
  }
  template <typename T, typename... Range>
  void key(const ConfigKey& key, const T& value, const Range&...) {
    const std::string assignment = fmt::format("{} = {}", key.name, toml_of(value));
    const std::string comment = comment_of<T>(key);
    text_ +=
        comment.empty() ? assignment + "\n" : fmt::format("{:<36}  # {}\n", assignment, comment);
  }
  const std::string& result() const { return text_; }

 private:
  template <typename T>
  static std::string comment_of(const ConfigKey& key) {
    std::string text = key.comment;
    if constexpr (std::is_enum_v<T>) {
      for (const Choice<T>& choice : kChoices<T>) {
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", choice.name, choice.meaning);
      }
    }
    return text;
  }
  std::string text_;
};

struct ListedKey {
  std::string table;
  std::string name;  // with its table
  std::string value;
  Heeds heeds;
};

class Lister {
 public:
  void table(const char* name, const char*, Heeds heeds) { table_ = name, heeds_ = heeds; }
  template <typename T, typename... Range>
  void key(const ConfigKey& key, const T& value, const Range&...) {
    keys_.push_back({table_, fmt::format("{}.{}", table_, key.name), toml_of(value),
                     key.heeds.value_or(heeds_)});
  }
  const std::vector<ListedKey>& result() const { return keys_; }

 private:
  const char* table_ = "";
  Heeds heeds_ = {};
  std::vector<ListedKey> keys_;
};

// Every key with its value as TOML.
std::vector<ListedKey> keys_in(RunConfig config) {  // a copy: visitors may write
  Lister lister;
  config_keys::describe(config, lister);
  return lister.result();
}

}  // namespace

RunConfig in_world(const RunConfig& trained, const RunConfig& world, const std::string& name) {
  std::vector<std::string> overrides;
  for (const ListedKey& key : keys_in(world)) {
    if (set_by_world(key.heeds)) overrides.push_back(fmt::format("{}={}", key.name, key.value));
  }
  return with_overrides(trained, name, overrides);
}

std::string to_toml(const RunConfig& config) {
  RunConfig copy = config;  // visitors may write
  Writer writer;
  config_keys::describe(copy, writer);
  return writer.result();
}

std::vector<ChangedKey> changed_keys(const RunConfig& before, const RunConfig& now) {
  const std::vector<ListedKey> keys_before = keys_in(before);
  const std::vector<ListedKey> keys_now = keys_in(now);
  std::vector<ChangedKey> changed;
  for (std::size_t i = 0; i < keys_now.size(); ++i) {
    const ListedKey& key = keys_now[i];
    if (keys_before[i].value == key.value) continue;
    changed.push_back({key.name, keys_before[i].value, key.value, key.heeds});
  }
  return changed;
}

std::string keys_where(bool (*holds)(Heeds)) {
  const std::vector<ListedKey> keys = keys_in({});
  std::vector<std::string> names;
  for (auto begin = keys.begin(); begin != keys.end();) {
    const auto end = std::find_if(begin, keys.end(),
                                  [&](const ListedKey& key) { return key.table != begin->table; });
    const auto chosen = [&](const ListedKey& key) { return holds(key.heeds); };
    if (std::all_of(begin, end, chosen)) {
      names.push_back(fmt::format("[{}]", begin->table));
    } else {
      for (auto key = begin; key != end; ++key) {
        if (chosen(*key)) names.push_back(key->name);
      }
    }
    begin = end;
  }
  return listed(names);
}

}  // namespace corridor
