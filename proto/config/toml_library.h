// SPDX-License-Identifier: Apache-2.0
// toml11, the TOML library, where its versions 3 (Debian 12) and 4 (Debian 13) differ; what is
// written here once is the same with both. Private to proto/config.
#pragma once

#include <cstddef>
#include <string>
#include <toml.hpp>

namespace corridor::toml_library {

#if TOML11_VERSION_MAJOR >= 4
using SyntaxError = toml::syntax_error;

inline std::size_t line_of(const toml::source_location& location) {
  return location.first_line_number();
}
inline const std::string& text_of(const toml::value& value) { return value.as_string(); }
inline toml::source_location location_of(const SyntaxError& error) {
  return error.errors().at(0).locations().at(0).first;
}
#else
using SyntaxError = toml::exception;

inline std::size_t line_of(const toml::source_location& location) { return location.line(); }
inline const std::string& text_of(const toml::value& value) { return value.as_string().str; }
inline toml::source_location location_of(const SyntaxError& error) { return error.location(); }
#endif

}  // namespace corridor::toml_library
