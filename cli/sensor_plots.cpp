#include "cli/sensor_plots.h"

#include <array>

#include "io/error.h"
#include "io/text.h"
#include "report/line_plot.h"
#include "report/log_plot.h"

namespace abbe::cli {

std::string line_color(const std::string& channel, std::size_t i) {
  constexpr std::array kOtherColors{"#333333", "#8e44ad", "#b7791f"};
  return channel == "R"   ? "#c0392b"
         : channel == "G" ? "#2e8b57"
         : channel == "B" ? "#2a5db0"
                          : kOtherColors.at(i % 3);
}

std::string transfer_plot(const Json& answer) {
  LogPlot plot{"Photon transfer", "signal [DN]", "variance [DN^2]", {}};
  for (std::size_t i = 0; i < answer.at("channel").size(); ++i) {
    const auto channel = answer.at("channel").at(i).get<std::string>();
    PlotSeries measured{channel, {}, line_color(channel, i), true, true};
    PlotSeries fitted{channel + ", signal / gain", {}, line_color(channel, i)};
    for (std::size_t k = 0; k < answer.at("signal_dn").at(i).size(); ++k) {
      const double signal = answer.at("signal_dn").at(i).at(k);
      const double variance = answer.at("variance_dn2").at(i).at(k);
      if (!(signal > 0 && variance > 0)) continue;
      measured.points.emplace_back(signal, variance);
      fitted.points.emplace_back(signal, signal / answer.at("gain_e_per_dn").at(i).get<double>());
    }
    plot.series.push_back(std::move(measured));
    plot.series.push_back(std::move(fitted));
  }
  return svg(plot);
}

std::string mtf_plot(const Json& answer) {
  PlotSeries curve{"", {}, line_color("B", 0)};
  for (std::size_t i = 0; i < answer.at("frequency").size(); ++i)
    curve.points.emplace_back(answer.at("frequency").at(i), answer.at("mtf").at(i));
  return svg(LinePlot{"Modulation transfer", "cycles per pixel", "modulation", {curve}});
}

Json read_answer(const std::filesystem::path& path, const AnswerPlot& plot, Inputs& inputs) {
  inputs.add_file(path);
  Diagnostics diagnostics;
  const auto source = read_text(path, diagnostics);
  if (!source) throw Error(diagnostics.code(), path.string(), diagnostics.text());
  try {
    Json answer = Json::parse(source->text);
    (void)plot(answer);
    return answer;
  } catch (const Json::exception&) {
    throw Error(ErrorCode::input, path.string(), "is not an answer that the command printed with --json");
  }
}

}  // namespace abbe::cli
