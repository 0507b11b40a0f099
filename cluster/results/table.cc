// SPDX-License-Identifier: Apache-2.0
#include "cluster/results/table.h"

#include <algorithm>
#include <utility>

#include "proto/base/format.h"
#include "proto/base/text.h"

namespace corridor::cluster {
namespace {

// What the columns are, then the rows.
std::vector<std::vector<std::string>> lines_of(const Table& table) {
  std::vector<std::vector<std::string>> lines = {table.columns};
  for (const auto& row : table.rows) {
    lines.emplace_back();
    for (const auto& [text, interval] : row)
      lines.back().push_back(interval.empty() ? text : fmt::format("{} {}", text, interval));
  }
  return lines;
}

}  // namespace

std::string text_of(const Table& table) {
  const auto lines = lines_of(table);
  std::vector<std::size_t> widths(table.columns.size());
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text = table.title + "\n";
  for (const auto& line : lines) {
    text += fmt::format("{:<{}}", line[0], widths[0]);
    for (std::size_t i = 1; i < line.size(); ++i)
      text += fmt::format("  {:>{}}", line[i], widths[i]);
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return table.note.empty() ? text : text + table.note + "\n";
}

std::string markdown_of(const Table& table) {
  std::string text = "**" + table.title + "**\n\n";
  std::string rule = "|---";
  for (std::size_t i = 1; i < table.columns.size(); ++i) rule += "|--:";
  rule += "|\n";
  for (const auto& line : lines_of(table)) {
    for (const std::string& cell : line) text += "| " + replaced(cell, '|', "\\|") + " ";
    text += "|\n" + std::exchange(rule, "");
  }
  return table.note.empty() ? text : text + "\n" + table.note + "\n";
}

std::string html_escaped(const std::string& text) {
  std::string escaped = replaced(text, '&', "&amp;");
  escaped = replaced(escaped, '<', "&lt;");
  escaped = replaced(escaped, '>', "&gt;");
  return replaced(escaped, '"', "&quot;");
}

std::string html_of(const Table& table) {
  std::string html = "<div class=\"table\"><table>\n<caption>" + html_escaped(table.title) +
                     "</caption>\n<thead><tr>";
  for (const std::string& column : table.columns) {
    html += "<th scope=\"col\">" + html_escaped(column) + "</th>";
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string interval =
          row[i].interval.empty() ? "" : " <small>" + html_escaped(row[i].interval) + "</small>";
      html += (i == 0 ? "<th scope=\"row\">" : "<td>") + html_escaped(row[i].text) + interval +
              (i == 0 ? "</th>" : "</td>");
    }
    html += "</tr>\n";
  }
  html += "</tbody></table>";
  if (!table.note.empty()) html += "<p class=\"note\">" + html_escaped(table.note) + "</p>";
  return html + "</div>\n";
}

}  // namespace corridor::cluster
