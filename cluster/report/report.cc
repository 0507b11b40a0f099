// SPDX-License-Identifier: Apache-2.0
#include "cluster/report/report.h"

#include <utility>

#include "cluster/pictures/figures.h"
#include "cluster/report/report_episodes.h"
#include "cluster/report/report_page.h"
#include "cluster/report/training_figures.h"
#include "proto/base/failure.h"
#include "proto/run/manifest.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"

namespace corridor::cluster {
namespace {

constexpr double kPrintScale = 2.0;

// That can be written to. A page that is there is replaced if it is an earlier report.
std::filesystem::path report_folder(const ReportOptions& options) {
  std::filesystem::path out =
      options.out.empty() ? open_results(options.runs.front()).root() / "report" : options.out;
  check_folder_for_results(out);
  const std::filesystem::path page = out / "report.html";
  if (!options.out.empty() && std::filesystem::exists(page) &&
      read_file(page).find(kGenerator) == std::string::npos) {
    throw Failure("{} is no report of corridor, and would be replaced: choose another --out",
                  page.string());
  }
  return out;
}

}  // namespace

int report(const ReportOptions& options) {
  const std::filesystem::path out = report_folder(options);
  std::vector<RunRecord> runs;
  for (const auto& root : options.runs) runs.push_back(read_run(open_results(root).root()));
  const std::vector<RunGroup> groups = grouped_runs(std::move(runs));

  std::vector<DrawnFigure> training, episodes;
  for (const Figure& figure : training_figures(groups)) {
    training.push_back({figure.name, figure.caption,
                        run_gnuplot(gnuplot_script(figure, PictureFormat::kSvg)),
                        run_gnuplot(gnuplot_script(figure, PictureFormat::kPng))});
  }
  const ReportedEpisodes driven = report_episodes(groups);
  for (const EpisodeFigure& figure : driven.figures) {
    const Canvas picture = picture_of(figure);
    episodes.push_back({"episodes_" + figure.planner, caption_of(figure), picture.svg(),
                        picture.png(kPrintScale)});
  }
  const std::string page = report_page(groups, training, episodes);

  create_folders(out);
  const std::filesystem::path page_file = out / "report.html";
  for (const auto* figures : {&training, &episodes}) {
    for (const DrawnFigure& drawn : *figures) {
      write_file(out / (drawn.name + ".svg"), drawn.svg);
      write_file(out / (drawn.name + ".png"), drawn.png);
    }
  }
  write_file(page_file, page);
  fmt::print("{}, with {} figures as SVG and PNG beside it\n", page_file.string(),
             training.size() + episodes.size());
  for (const std::string& note : driven.notes) fmt::print("{}\n", note);
  return 0;
}

}  // namespace corridor::cluster
