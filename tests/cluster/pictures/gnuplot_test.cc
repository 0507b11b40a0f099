#include "cluster/pictures/gnuplot.h"

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
