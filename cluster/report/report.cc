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

int report(const ReportOptions& options) {
  std::vector<RunRecord> runs;
  for (const auto& root : options.runs) runs.push_back(read_run(root));
  const std::vector<RunGroup> groups = grouped_runs(std::move(runs));

  std::vector<std::pair<std::string, std::string>> files;  // name, content
  const auto drawn = [&](const auto& figure, const std::string& name, const std::string& caption) {
    const std::string svg = run_gnuplot(gnuplot_script(figure, PictureFormat::kSvg));
    files.emplace_back(name + ".svg", svg);
    files.emplace_back(name + ".png", run_gnuplot(gnuplot_script(figure, PictureFormat::kPng)));
    return DrawnFigure{caption, svg};
  };
  std::vector<DrawnFigure> training, episodes;
  for (const Figure& figure : training_figures(groups)) {
    training.push_back(drawn(figure, figure.name, figure.caption));
  }
  const ReportedEpisodes driven = report_episodes(groups);
  for (const EpisodeFigure& figure : driven.figures) {
    episodes.push_back(drawn(figure, "episodes_" + figure.planner, caption_of(figure)));
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
