#include <array>
#include <cmath>

#include "calibration/chart/transfer_frames.h"
#include "cli/answer.h"
#include "cli/bench_measurements.h"
#include "cli/bench_plots.h"
#include "cli/output_files.h"
#include "io/atomic_file.h"
#include "io/extension.h"

namespace abbe::cli {
int transfer(const TransferOptions& options) {
  if (!options.plot.empty()) require_extension(options.plot, {".svg"});
  Inputs inputs(options.max_memory_bytes);
  const std::vector<ChannelTransfer> channels = measure_transfer(options.dark, options.lit, inputs);
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
  Json with_curves = answer;
  for (const ChannelTransfer& one : channels) {
    Json signals = Json::array();
    Json variances = Json::array();
    for (const TransferPoint& point : one.transfer.points) {
      signals.push_back(point.signal_dn);
      variances.push_back(point.variance_dn2);
    }
    with_curves["signal_dn"].push_back(std::move(signals));
    with_curves["variance_dn2"].push_back(std::move(variances));
  }
  if (!options.plot.empty()) {
    require_distinct(std::array{options.plot}, inputs.files());
    write_atomically(options.plot, transfer_plot(with_curves));
  }
  print(options.json ? with_curves : answer, options.json);
  return 0;
}

}  // namespace abbe::cli
