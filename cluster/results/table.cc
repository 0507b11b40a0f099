#include "cluster/results/table.h"

#include <algorithm>

#include "proto/base/format.h"

namespace corridor::cluster {
namespace {

std::string joined(const Cell& cell) {
  return cell.interval.empty() ? cell.text : cell.text + " " + cell.interval;
}

// "|" would end a cell of Markdown.
std::string markdown_escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string padded(const std::string& text, std::size_t width, bool first) {
  return first ? fmt::format("{:<{}}", text, width) : fmt::format("  {:>{}}", text, width);
}

std::string without_trailing_spaces(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

}  // namespace

std::string text_of(const Table& table) {
  std::vector<std::size_t> widths;
  for (const std::string& column : table.columns) widths.push_back(column.size());
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], joined(row[i]).size());
    }
  }
  std::string text = table.title.empty() ? "" : table.title + "\n";
  std::string line;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    line += padded(table.columns[i], widths[i], i == 0);
  }
  text += without_trailing_spaces(line);
  for (const auto& row : table.rows) {
    line.clear();
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += padded(joined(row[i]), widths[i], i == 0);
    }
    text += without_trailing_spaces(line);
  }
  return table.note.empty() ? text : text + table.note + "\n";
}

std::string markdown_of(const Table& table) {
  std::string text = table.title.empty() ? "" : "**" + table.title + "**\n\n";
  std::string rule;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    text += "| " + markdown_escaped(table.columns[i]) + " ";
    rule += i == 0 ? "|---" : "|--:";
  }
  text += "|\n" + rule + "|\n";
  for (const auto& row : table.rows) {
    for (const Cell& cell : row) text += "| " + markdown_escaped(joined(cell)) + " ";
    text += "|\n";
  }
  return table.note.empty() ? text : text + "\n" + table.note + "\n";
}

std::string html_escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string html_of(const Table& table) {
  std::string html = "<div class=\"table\"><table>\n";
  if (!table.title.empty()) html += "<caption>" + html_escaped(table.title) + "</caption>\n";
  html += "<thead><tr>";
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
