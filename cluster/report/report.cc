#include "cluster/report/report.h"

#include <utility>

#include "cluster/pictures/gnuplot.h"
#include "cluster/report/report_episodes.h"
#include "cluster/report/report_page.h"
#include "cluster/report/training_figures.h"
#include "proto/base/failure.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"

namespace corridor::cluster {
namespace {

constexpr double kPrintScale = 2.0;

}  // namespace

int report(const ReportOptions& options) {
  std::vector<RunRecord> runs;
  for (const auto& root : options.runs) runs.push_back(read_run(root));
  const std::vector<RunGroup> groups = grouped_runs(std::move(runs));

  std::vector<std::pair<std::string, std::string>> files;  // name, content
  std::vector<DrawnFigure> training, episodes;
  for (const Figure& figure : training_figures(groups)) {
    const std::string svg = run_gnuplot(gnuplot_script(figure, PictureFormat::kSvg));
    files.emplace_back(figure.name + ".svg", svg);
    files.emplace_back(figure.name + ".png",
                       run_gnuplot(gnuplot_script(figure, PictureFormat::kPng)));
    training.push_back({figure.caption, svg});
  }
  const ReportedEpisodes driven = report_episodes(groups);
  for (const EpisodeFigure& figure : driven.figures) {
    const Canvas picture = picture_of(figure);
    files.emplace_back("episodes_" + figure.planner + ".svg", picture.svg());
    files.emplace_back("episodes_" + figure.planner + ".png", picture.png(kPrintScale));
    episodes.push_back({caption_of(figure), picture.svg()});
  }
  const std::size_t figures = files.size() / 2;
  files.emplace_back("report.html", report_page(groups, training, episodes));

  const std::filesystem::path out =
      options.out.empty() ? options.runs.front() / "report" : options.out;
  on_disk("create", out, [&] { std::filesystem::create_directories(out); });
  for (const auto& [name, content] : files) write_file(out / name, content);
  fmt::print("{}, with {} figures as SVG and PNG beside it\n", (out / "report.html").string(),
             figures);
  for (const std::string& note : driven.notes) fmt::print("{}\n", note);
  return 0;
}

}  // namespace corridor::cluster
