// SPDX-License-Identifier: Apache-2.0
#include "cluster/results/table.h"

#include <gtest/gtest.h>

namespace corridor::cluster {
namespace {

const Table kTable{"Sums",
                   {"planner", "reward", "note"},
                   {{{"rules"}, {"5", "[4, 6]"}, {"a|b"}}, {{"keep+mop"}, {"1234"}, {"<&>"}}},
                   "Of two."};

TEST(Table, IsAlignedInText) {
  EXPECT_EQ(text_of(kTable),
            "Sums\n"
            "planner     reward  note\n"
            "rules     5 [4, 6]   a|b\n"
            "keep+mop      1234   <&>\n"
            "Of two.\n");
}

TEST(Table, KeepsItsCellsApartInMarkdown) {
  EXPECT_EQ(markdown_of(kTable),
            "**Sums**\n\n"
            "| planner | reward | note |\n"
            "|---|--:|--:|\n"
            "| rules | 5 [4, 6] | a\\|b |\n"
            "| keep+mop | 1234 | <&> |\n"
            "\nOf two.\n");
}

TEST(Table, EscapesWhatHtmlWouldRead) {
  EXPECT_EQ(html_of(kTable),
            "<div class=\"table\"><table>\n<caption>Sums</caption>\n"
            "<thead><tr><th scope=\"col\">planner</th><th scope=\"col\">reward</th>"
            "<th scope=\"col\">note</th></tr></thead>\n<tbody>\n"
            "<tr><th scope=\"row\">rules</th><td>5 <small>[4, 6]</small></td><td>a|b</td></tr>\n"
            "<tr><th scope=\"row\">keep+mop</th><td>1234</td><td>&lt;&amp;&gt;</td></tr>\n"
            "</tbody></table><p class=\"note\">Of two.</p></div>\n");
}

TEST(Table, MayHaveNoNote) {
  const Table bare{"T", {"a"}, {{{"1"}}}};
  EXPECT_EQ(text_of(bare), "T\na\n1\n");
  EXPECT_EQ(markdown_of(bare), "**T**\n\n| a |\n|---|\n| 1 |\n");
  EXPECT_EQ(html_of(bare).find("note"), std::string::npos);
}

}  // namespace
}  // namespace corridor::cluster
