// HTML, by parts. Pure. Everything that is given as text is escaped.
#pragma once

#include <string>

#include "cluster/results/table.h"

namespace corridor::cluster {

// A whole page that needs nothing else: its style is in it. `body` is HTML.
std::string html_document(const std::string& title, const std::string& body);

std::string html_heading(int level, const std::string& text);
std::string html_paragraph(const std::string& text);
// Text as it is, in a fixed font.
std::string html_preformatted(const std::string& text);
// Text of which only the first line shows until one asks for more.
std::string html_folded(const std::string& summary, const std::string& text);
// An SVG document as part of the page.
std::string html_figure(const std::string& svg, const std::string& caption);

}  // namespace corridor::cluster
