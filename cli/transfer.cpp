#include <array>
#include <cmath>

#include "calibration/chart/transfer_frames.h"
#include "cli/answer.h"
#include "cli/bench_measurements.h"
#include "cli/output_files.h"
#include "io/atomic_file.h"
#include "io/extension.h"
#include "validation/plot/log_plot.h"

namespace abbe::cli {
namespace {

const char* color_of(const std::string& channel) {
  return channel == "R" ? "#c0392b" : channel == "G" ? "#2e8b57" : channel == "B" ? "#2a5db0" : "#333333";
}

// Variance over signal as measured, and the line of the fitted gain.
LogPlot plot_of(const std::vector<ChannelTransfer>& channels) {
  LogPlot plot{"Photon transfer", "signal [DN]", "variance [DN^2]", {}};
  for (const ChannelTransfer& one : channels) {
    PlotSeries measured{one.channel, {}, color_of(one.channel), true, true};
    PlotSeries fitted{one.channel + " by the gain", {}, color_of(one.channel)};
    for (const TransferPoint& point : one.transfer.points) {
      if (!(point.signal_dn > 0 && point.variance_dn2 > 0)) continue;
      measured.points.emplace_back(point.signal_dn, point.variance_dn2);
      fitted.points.emplace_back(point.signal_dn, point.signal_dn / one.transfer.gain_e_per_dn);
    }
    plot.series.push_back(std::move(measured));
    plot.series.push_back(std::move(fitted));
  }
  return plot;
}

}  // namespace

int transfer(const TransferOptions& options) {
  if (!options.plot.empty()) require_extension(options.plot, {".svg"});
  Inputs inputs(options.max_memory_bytes);
  const std::vector<ChannelTransfer> channels = measure_transfer(options.dark, options.lit, inputs);
  if (!options.plot.empty()) {
    require_distinct(std::array{options.plot}, inputs.files());
    write_atomically(options.plot, svg(plot_of(channels)));
  }
  Json answer;
  for (const ChannelTransfer& one : channels) {
    const PhotonTransfer& found = one.transfer;
    answer["channel"].push_back(one.channel);
    answer["gain_e_per_dn"].push_back(found.gain_e_per_dn);
    answer["gain_standard_error"].push_back(found.gain_standard_error);
    answer["read_noise_e"].push_back(found.read_noise_e);
    answer["read_noise_standard_error"].push_back(
        found.read_noise_standard_error ? Json(*found.read_noise_standard_error) : Json());
    answer["dark_e_per_s"].push_back(found.dark_e_per_s);
    answer["prnu_percent"].push_back(found.prnu_percent);
    answer["dsnu_e"].push_back(found.dsnu_e);
    answer["full_well_e"].push_back(found.full_well_e ? Json(*found.full_well_e) : Json());
    answer["dynamic_range_db"].push_back(std::isfinite(one.dynamic_range_db) ? Json(one.dynamic_range_db)
                                                                             : Json());
    answer["snr10_e"].push_back(one.snr10_e);
    answer["snr10_lx_s"].push_back(one.snr10_lx_s ? Json(*one.snr10_lx_s) : Json());
  }
  print(answer, options.json);
  return 0;
}

}  // namespace abbe::cli
