#include "cluster/report/html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Html, EscapesWhateverIsText) {
  const std::string text = "<script>&\"";
  for (const std::string& html :
       {html_heading(2, text), html_paragraph(text), html_preformatted(text),
        html_folded(text, text), html_figure("<svg/>", text), html_document(text, "")}) {
    EXPECT_THAT(html, HasSubstr("&lt;script&gt;&amp;"));
    EXPECT_THAT(html, Not(HasSubstr("<script")));
  }
}

TEST(Html, TakesTheSvgElementOutOfItsDocument) {
  const std::string html =
      html_figure("<?xml version=\"1.0\"?>\n<!DOCTYPE svg>\n<svg a=\"b\"/>", "c");
  EXPECT_THAT(html, HasSubstr("<svg a=\"b\"/>"));
  EXPECT_THAT(html, Not(HasSubstr("xml version")));
}

}  // namespace
}  // namespace corridor::cluster
