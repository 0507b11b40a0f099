// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "proto/base/failure.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using testing::ThrowsMessage;

const PlottedCurve kCurve = {
    {{1000, 1.0}, {2000, 3.0}}, {{1000, 1.5, 1.5, 1.5}, {2000, 2.5, 2.5, 2.5}}, std::nullopt};

Figure figure(std::vector<std::string> labels, std::vector<PlottedCurve> curves) {
  return {"name",
          "caption",
          std::move(labels),
          "moving average",
          "rules",
          false,
          {{"title", "unit", std::move(curves)}}};
}

TEST(Figure, PlotsStepsInThousandsWithALegendOfItsLines) {
  PlottedCurve curve = kCurve;
  curve.level = 2.25;
  const std::string script = gnuplot_script(figure({"paper"}, {curve}), PictureFormat::kSvg);
  EXPECT_THAT(script, HasSubstr("\n1 1 0 0\n2 3 0 0\n"));
  EXPECT_THAT(script, HasSubstr("\n1 1.5 1.5 1.5\n2 2.5 2.5 2.5\n"));
  EXPECT_THAT(script, HasSubstr("2.25 with lines"));
  for (const char* title : {"'as measured'", "'moving average'", "'rules'"}) {
    EXPECT_THAT(script, HasSubstr(title));
  }
  EXPECT_THAT(script, Not(HasSubstr("filledcurves"))) << "one seed has no band";
  EXPECT_THAT(script, Not(HasSubstr("paper")));
}

TEST(Figure, OfSeveralCurvesNamesThemAndGivesEachAColour) {
  PlottedCurve seeds = kCurve;
  seeds.trend[1].high = 4.0;
  seeds.level = 1.0;
  const std::string script =
      gnuplot_script(figure({"paper", "dense"}, {kCurve, seeds}), PictureFormat::kPng);
  for (const char* title : {"'paper'", "'dense'", "'dense, rules'", "0072b2", "d55e00"}) {
    EXPECT_THAT(script, HasSubstr(title));
  }
  EXPECT_THAT(script, HasSubstr("filledcurves"));
  EXPECT_THAT(script, Not(HasSubstr("paper, rules")));
}

TEST(Figure, IsDrawnInBothFormatsWhateverItsTextsAre) {
  Figure drawn = figure({"a \"b\" \\ <c> & `echo x` $e\nf", "g"}, {kCurve, {}});
  drawn.panels.push_back({"second", "it's", {kCurve, kCurve}});
  const std::string svg = run_gnuplot(gnuplot_script(drawn, PictureFormat::kSvg));
  EXPECT_THAT(svg, HasSubstr("a \"b\" \\ &lt;c> &amp; `echo x` $e f"));
  EXPECT_THAT(svg, HasSubstr("it's"));
  EXPECT_THAT(svg, HasSubstr("environment steps, thousands"));
  EXPECT_THAT(run_gnuplot(gnuplot_script(drawn, PictureFormat::kPng)), StartsWith("\x89PNG"));
}

TEST(Gnuplot, DrawsAPictureTheSameEachTime) {
  const std::string script =
      "set terminal pngcairo\n$d << EOD\n0 1\n1 2\nEOD\nplot $d with lines\n";
  const std::string picture = run_gnuplot(script);
  EXPECT_THAT(picture, StartsWith("\x89PNG\r\n"));
  EXPECT_EQ(run_gnuplot(script), picture);
}

TEST(Gnuplot, SaysInOneLineWhatIsWrongWithAScript) {
  EXPECT_THAT([] { run_gnuplot("set terminal svg\nplot nothing\n"); },
              ThrowsMessage<Failure>(
                  testing::AllOf(HasSubstr("undefined variable: nothing"), Not(HasSubstr("\n")))));
  EXPECT_THAT([] { run_gnuplot("x = 1\n"); }, ThrowsMessage<Failure>(HasSubstr("drew nothing")));
}

TEST(Gnuplot, IsKilledAtTheDeadline) {
  EXPECT_THAT([] { run_gnuplot("while (1) { x = 1 }\n", std::chrono::milliseconds(0)); },
              ThrowsMessage<Failure>(HasSubstr("not done within 0 s")));
}

TEST(Gnuplot, ThatIsMissingIsNamedWithItsPackage) {
  const std::string path = getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  EXPECT_THAT([] { run_gnuplot("x = 1\n"); }, ThrowsMessage<Failure>(HasSubstr("gnuplot-nox")));
  setenv("PATH", path.c_str(), 1);
}

}  // namespace
}  // namespace corridor::cluster
