// SPDX-License-Identifier: Apache-2.0
// A table as text for terminals, as Markdown and as HTML. Pure.
#pragma once

#include <string>
#include <vector>

namespace corridor::cluster {

struct Cell {
  std::string text;
  std::string interval = {};  // behind the text; "[506, 541]"
};

struct Table {
  std::string title;
  std::vector<std::string> columns;  // the first one says what a row is
  std::vector<std::vector<Cell>> rows;
  std::string note = {};  // below; may be empty
};

// Each ends with the end of a line. Columns are aligned in the text; characters are bytes, ASCII.
std::string text_of(const Table& table);
std::string markdown_of(const Table& table);
// What a cell says is escaped.
std::string html_of(const Table& table);

// With &, <, > and " as HTML writes them.
std::string html_escaped(const std::string& text);

}  // namespace corridor::cluster
