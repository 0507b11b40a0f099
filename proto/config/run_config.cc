// SPDX-License-Identifier: Apache-2.0
#include "proto/config/run_config.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <type_traits>

#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/base/text.h"
#include "proto/config/config_checks.h"
#include "proto/config/config_keys.h"
#include "proto/config/toml_library.h"
#include "proto/config/toml_text.h"
#include "proto/system/files.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;
using config_keys::kRetiredKeys;
using config_keys::RetiredKey;
using toml_library::text_of;

// What a name or an address is made of: needs no escapes when written.
constexpr const char* kWordCharacters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.:_/-";
bool is_word(std::string_view text) {
  return !text.empty() && text.find_first_not_of(kWordCharacters) == std::string_view::npos;
}

constexpr const char* kOverride = "override";

// "scenario.toml:12", or "override".
std::string place_of(const toml::source_location& location) {
  return location.file_name() == kOverride
             ? kOverride
             : fmt::format("{}:{}", location.file_name(), toml_library::line_of(location));
}
std::string place_of(const toml::value& value) { return place_of(value.location()); }

// On one line. The TOML library's own writer lays values out differently in every version.
std::string written(const toml::value& value) {
  std::vector<std::string> parts;
  switch (value.type()) {
    case toml::value_t::boolean:
      return toml_of(value.as_boolean());
    case toml::value_t::integer:
      return std::to_string(value.as_integer());
    case toml::value_t::floating:
      return toml_of(value.as_floating());
    case toml::value_t::string:
      return Json(text_of(value)).dump(-1, ' ', false, Json::error_handler_t::replace);
    case toml::value_t::array:
      for (const toml::value& element : value.as_array()) parts.push_back(written(element));
      return fmt::format("[{}]", listed(parts));
    case toml::value_t::table:
      for (const auto& [key, member] : value.as_table()) {
        parts.push_back(key + " = " + written(member));
      }
      std::ranges::sort(parts);
      return fmt::format("{{{}}}", listed(parts));
    default:  // dates and times
      return toml::format(value);
  }
}

// For a message: cut short.
std::string shown(const toml::value& value) {
  std::string text = written(value);
  constexpr std::size_t kShownMax = 80;
  if (text.size() > kShownMax) text = text.substr(0, kShownMax) + " ...";
  return text;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

// "; did you mean x?", or the known names when none is near.
std::string suggestion(const std::string& unknown, const std::vector<std::string>& known) {
  const auto nearest =
      std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
        return edit_distance(unknown, a) < edit_distance(unknown, b);
      });
  if (nearest != known.end() &&
      edit_distance(unknown, *nearest) <= std::max<std::size_t>(2, unknown.size() / 3)) {
    return fmt::format("did you mean {}?", *nearest);
  }
  return "known are " + toml_of(known);
}

// Also 1e6, which TOML has no whole number for.
std::optional<std::int64_t> whole(const toml::value& value) {
  if (value.is_integer()) return value.as_integer();
  constexpr double kExact = 9007199254740992.0;
  if (!value.is_floating() || std::abs(value.as_floating()) > kExact) return std::nullopt;
  const double number = value.as_floating();
  if (number != std::trunc(number)) return std::nullopt;  // NaN is above nothing and equals nothing
  return static_cast<std::int64_t>(number);
}

// In alphabetical order: the TOML library's is a hash's.
std::set<std::string> unknown_in(const toml::value& table, const std::vector<std::string>& known) {
  std::set<std::string> names;
  for (const auto& [name, value] : table.as_table()) names.insert(name);
  for (const std::string& name : known) names.erase(name);
  return names;
}

// Sets what the document says, and leaves the rest. Throws Failure at the first fault.
class Reader {
 public:
  explicit Reader(const toml::value& document) : document_(document) {}

  void table(const char* name, const char*, Heeds) {
    check_keys();
    tables_.push_back(name);
    keys_.clear();
    table_ = document_.contains(name) ? &document_.at(name) : nullptr;
    if (table_ && !table_->is_table()) {
      throw Failure("{}: {} is no table: write [{}] and its keys below", place_of(*table_), name,
                    name);
    }
  }
  template <typename T>
  void key(const ConfigKey& key, T& member, std::type_identity_t<T> low,
           std::type_identity_t<T> high) {
    const toml::value* value = find(key);
    if (value) member = in_range<T>(key, *value, *value, low, high);
  }
  template <typename T>
  void key(const ConfigKey& key, std::vector<T>& member, ListSize size, std::type_identity_t<T> low,
           std::type_identity_t<T> high) {
    const toml::value* value = find(key);
    if (!value) return;
    if (!value->is_array()) wrong(key, *value, "a list of numbers, as in [1, 2]");
    const auto& elements = value->as_array();
    if (elements.size() < size.low || elements.size() > size.high) {
      wrong(key, *value, fmt::format("a list of {} to {} numbers", size.low, size.high));
    }
    member.clear();
    for (const toml::value& element : elements) {
      member.push_back(in_range<T>(key, *value, element, low, high));
    }
  }
  void key(const ConfigKey& key, bool& member) {
    const toml::value* value = find(key);
    if (!value) return;
    if (!value->is_boolean()) wrong(key, *value, "true or false");
    member = value->as_boolean();
  }
  void key(const ConfigKey& key, std::string& member) {
    const toml::value* value = find(key);
    if (!value) return;
    if (!value->is_string() || !is_word(text_of(*value))) {
      wrong(key, *value, "a name or an address in quotes");
    }
    member = text_of(*value);
  }
  template <typename E>
  requires std::is_enum_v<E>
  void key(const ConfigKey& key, E& member) {
    const toml::value* value = find(key);
    if (!value) return;
    try {
      member = parse_choice<E>(value->is_string() ? text_of(*value) : "");
    } catch (const Failure& failure) {
      refuse(key.name, *value, failure.what());
    }
  }

  // After the last table: whether the document has anything else.
  void finish() {
    check_keys();
    for (const std::string& unknown : unknown_in(document_, tables_)) {
      throw Failure("{}: unknown table [{}]: {}", place_of(document_.at(unknown)), unknown,
                    suggestion(unknown, tables_));
    }
  }

 private:
  const toml::value* find(const ConfigKey& key) {
    keys_.push_back(key.name);
    return table_ && table_->contains(key.name) ? &table_->at(key.name) : nullptr;
  }

  [[noreturn]] void refuse(std::string_view key, const toml::value& value,
                           std::string_view why) const {
    throw Failure("{}: {}.{} = {}: {}", place_of(value), tables_.back(), key, shown(value), why);
  }
  [[noreturn]] void wrong(const ConfigKey& key, const toml::value& value,
                          const std::string& right) const {
    refuse(key.name, value, "must be " + right);
  }

  // `element` is `value` or one of its list.
  template <typename T>
  T in_range(const ConfigKey& key, const toml::value& value, const toml::value& element, T low,
             T high) {
    constexpr bool kWhole = std::is_integral_v<T>;
    const std::string right =
        fmt::format("{}{} from {} to {}", value.is_array() ? "a list, each " : "",
                    kWhole ? "a whole number" : "a number", low, high);
    if constexpr (kWhole) {
      // Compared as TOML's type, of which T may hold less, or no negative ones.
      const std::optional<std::int64_t> number = whole(element);
      if (!number || *number < static_cast<std::int64_t>(low) ||
          *number > static_cast<std::int64_t>(high)) {
        wrong(key, value, right);
      }
      return static_cast<T>(*number);
    } else {
      if (!element.is_floating() && !element.is_integer()) wrong(key, value, right);
      const double number =
          element.is_floating() ? element.as_floating() : static_cast<double>(element.as_integer());
      if (!(number >= low && number <= high)) wrong(key, value, right);  // NaN is neither
      return number;
    }
  }

  void check_keys() const {
    if (!table_) return;
    for (const std::string& unknown : unknown_in(*table_, keys_)) {
      const toml::value& value = table_->at(unknown);
      const auto retired = std::ranges::find_if(kRetiredKeys, [&](const RetiredKey& key) {
        return key.table == tables_.back() && key.name == unknown;
      });
      if (retired == std::end(kRetiredKeys)) {
        throw Failure("{}: unknown key {}.{}: {}", place_of(value), tables_.back(), unknown,
                      suggestion(unknown, keys_));
      }
      if (shown(value) != retired->always) {
        refuse(unknown, value, fmt::format("there is no such key any more: {}", retired->advice));
      }
    }
  }

  const toml::value& document_;
  const toml::value* table_ = nullptr;  // nothing when the document lacks it
  std::vector<std::string> tables_;     // so far; the last is the one being read
  std::vector<std::string> keys_;       // of the table being read
};

// ---- Documents.

// One line of the TOML library's pictures: "[error] toml::parse_value: ...".
std::string first_line(std::string_view what) {
  what = what.substr(0, what.find('\n'));
  constexpr std::string_view kPrefix = "[error] ";
  if (what.starts_with(kPrefix)) what.remove_prefix(kPrefix.size());
  return std::string(what);
}

// The TOML library reads beyond what it was given where text is no UTF-8, overflows on long binary
// numbers, and recurses without a bound: none of that gets as far.
void check_text(const std::string& text, const std::string& name) {
  constexpr std::size_t kBytesMax = 1 << 20;
  constexpr int kNestingMax = 64;
  if (text.size() > kBytesMax) throw Failure("{}: {} bytes are no scenario", name, text.size());
  try {
    Json(text).dump();
  } catch (const Json::exception&) {
    throw Failure("{}: not valid TOML: it is no UTF-8 text", name);
  }
  for (std::size_t at = text.find("0b"); at != std::string::npos; at = text.find("0b", at + 1)) {
    constexpr std::size_t kDigitsMax = 62;
    if (text.find_first_not_of("01_", at + 2) > at + 2 + kDigitsMax) {
      throw Failure("{}: not valid TOML: a binary number of too many digits", name);
    }
  }
  int nesting = 0;
  for (const char c : text) {
    nesting += (c == '[' || c == '{') - (c == ']' || c == '}');
    if (nesting > kNestingMax) throw Failure("{}: not valid TOML: brackets without end", name);
  }
}

toml::value parse_document(const std::string& text, const std::string& name) {
  check_text(text, name);
  try {
    std::istringstream in(text);
    return toml::parse(in, name);
  } catch (const toml_library::SyntaxError& error) {
    throw Failure("{}: not valid TOML: {}", place_of(toml_library::location_of(error)),
                  first_line(error.what()));
  } catch (const std::exception& error) {
    throw Failure("{}: not valid TOML: {}", name, first_line(error.what()));
  }
}

// Key by key, one table deep: as deep as scenarios are.
void merge(toml::value& into, const toml::value& over) {
  for (const auto& [name, value] : over.as_table()) {
    if (value.is_table() && into.contains(name) && into.at(name).is_table()) {
      for (const auto& [key, member] : value.as_table()) into[name][key] = member;
    } else {
      into[name] = value;
    }
  }
}

// The file with everything that it takes from its base. `open` are the files that led here.
toml::value load_document(const fs::path& file, std::vector<fs::path> open) {
  std::error_code ignored;
  const fs::path identity = fs::weakly_canonical(file, ignored);
  if (std::find(open.begin(), open.end(), identity) != open.end()) {
    throw Failure("{}: base leads back to this file", file.string());
  }
  open.push_back(identity);

  toml::value document = parse_document(read_file(file), file.string());
  if (!document.contains("base")) return document;
  const toml::value base = document.at("base");
  if (!base.is_string()) {
    throw Failure("{}: base = {}: must be a file's name in quotes", place_of(base), shown(base));
  }
  document.as_table().erase("base");
  toml::value whole = load_document(file.parent_path() / text_of(base), std::move(open));
  merge(whole, document);
  return whole;
}

void apply_override(toml::value& document, const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string key = text.substr(0, equals);
  const bool is_key = is_word(key) && std::count(key.begin(), key.end(), '.') == 1;
  if (equals == std::string::npos || !is_key || text.find('\n') != std::string::npos) {
    throw Failure("override {}: must be table.key=value", text);
  }
  const std::string value = text.substr(equals + 1);
  try {
    merge(document, parse_document(text, kOverride));
  } catch (const Failure&) {
    if (!is_word(value)) throw Failure("override {}: the value is not valid TOML", text);
    merge(document, parse_document(fmt::format("{}=\"{}\"", key, value), kOverride));
  }
}

// `config` with what the document and then the overrides say.
RunConfig changed(RunConfig config, toml::value document, const std::string& name,
                  const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides) apply_override(document, text);
  Reader reader(document);
  config_keys::describe(config, reader);
  reader.finish();
  check_config(config, name);
  return config;
}

Json as_json(const toml::value& value) {
  switch (value.type()) {
    case toml::value_t::boolean:
      return value.as_boolean();
    case toml::value_t::integer:
      return value.as_integer();
    case toml::value_t::floating:
      return value.as_floating();
    case toml::value_t::string:
      return text_of(value);
    case toml::value_t::array: {
      Json list = Json::array();
      for (const toml::value& element : value.as_array()) list.push_back(as_json(element));
      return list;
    }
    case toml::value_t::table: {
      Json table = Json::object();
      for (const auto& [key, member] : value.as_table()) table[key] = as_json(member);
      return table;
    }
    default:
      throw Failure("{}: {}: dates and times mean nothing here", place_of(value), shown(value));
  }
}

}  // namespace

Json load_toml(const fs::path& file) {
  return as_json(parse_document(read_file(file), file.string()));
}

RunConfig load_run_config(const fs::path& file, const std::vector<std::string>& overrides) {
  toml::value document = load_document(file, {});
  return changed({}, std::move(document), file.string(), overrides);
}

RunConfig parse_run_config(const std::string& text, const std::string& name,
                           const std::vector<std::string>& overrides) {
  toml::value document = parse_document(text, name);
  if (document.contains("base")) {
    throw Failure("{}: base is for scenario files", place_of(document.at("base")));
  }
  return changed({}, std::move(document), name, overrides);
}

RunConfig with_overrides(const RunConfig& config, const std::string& name,
                         const std::vector<std::string>& overrides) {
  return changed(config, toml::table(), name, overrides);
}

}  // namespace corridor
