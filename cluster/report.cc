#include "cluster/report.h"

#include <utility>

#include "cluster/gnuplot.h"
#include "cluster/report_page.h"
#include "cluster/training_figures.h"
#include "proto/failure.h"
#include "proto/run_directory.h"

namespace corridor::cluster {

int report(const ReportOptions& options) {
  std::vector<RunRecord> runs;
  for (const auto& root : options.runs) runs.push_back(read_run(root));
  const std::vector<RunGroup> groups = grouped_runs(std::move(runs));

  std::vector<DrawnFigure> figures;
  std::vector<std::pair<std::string, std::string>> files;  // name, content
  for (const Figure& figure : training_figures(groups)) {
    figures.push_back({figure, run_gnuplot(gnuplot_script(figure, PictureFormat::kSvg))});
    files.emplace_back(figure.name + ".svg", figures.back().svg);
    files.emplace_back(figure.name + ".png",
                       run_gnuplot(gnuplot_script(figure, PictureFormat::kPng)));
  }
  files.emplace_back("report.html", report_page(groups, figures));

  const std::filesystem::path out =
      options.out.empty() ? options.runs.front() / "report" : options.out;
  on_disk("create", out, [&] { std::filesystem::create_directories(out); });
  for (const auto& [name, content] : files) write_file(out / name, content);
  fmt::print("{}, with {} figures as SVG and PNG beside it\n", (out / "report.html").string(),
             figures.size());
  return 0;
}

}  // namespace corridor::cluster
