#include "cluster/report/html.h"

#include "proto/base/format.h"

namespace corridor::cluster {
namespace {

constexpr const char* kStyle = R"(
body { max-width: 72rem; margin: 2rem auto; padding: 0 1rem; color: #222;
       font: 15px/1.45 Helvetica, Arial, sans-serif; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.25rem; margin-top: 2.2rem; } h3 { font-size: 1.05rem; }
figure { margin: 1.2rem 0; } figure > svg { width: 100%; height: auto; }
figcaption, .note { color: #555; font-size: 0.9rem; }
.table { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: bold; padding-bottom: 0.3rem; }
thead th { border-top: 1.5px solid #222; border-bottom: 1px solid #222; vertical-align: bottom; }
tbody tr:last-child > * { border-bottom: 1.5px solid #222; }
th, td { padding: 0.2rem 0.8rem 0.2rem 0; text-align: right; font-weight: normal; }
th:first-child { text-align: left; } td small { color: #666; }
pre { background: #f5f5f5; padding: 0.7rem; overflow-x: auto; font-size: 0.85rem; }
summary { cursor: pointer; }
@media print { body { max-width: none; } figure { break-inside: avoid; } }
)";

}  // namespace

std::string html_document(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}</body>\n</"
      "html>\n",
      html_escaped(title), kStyle, body);
}

std::string html_heading(int level, const std::string& text) {
  return fmt::format("<h{0}>{1}</h{0}>\n", level, html_escaped(text));
}

std::string html_paragraph(const std::string& text) {
  return "<p>" + html_escaped(text) + "</p>\n";
}

std::string html_preformatted(const std::string& text) {
  return "<pre>" + html_escaped(text) + "</pre>\n";
}

std::string html_folded(const std::string& summary, const std::string& text) {
  return "<details><summary>" + html_escaped(summary) + "</summary>\n" + html_preformatted(text) +
         "</details>\n";
}

std::string html_figure(const std::string& svg, const std::string& caption) {
  // What is before belongs to an XML document of its own.
  const std::size_t start = svg.find("<svg");
  return "<figure>\n" + (start == std::string::npos ? "" : svg.substr(start)) + "<figcaption>" +
         html_escaped(caption) + "</figcaption>\n</figure>\n";
}

}  // namespace corridor::cluster
