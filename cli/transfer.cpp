#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "calibration/chart/transfer_frames.h"
#include "cli/answer.h"
#include "cli/output_files.h"
#include "cli/sensor_measurements.h"
#include "cli/sensor_plots.h"
#include "io/atomic_file.h"
#include "io/text.h"

namespace abbe::cli {
namespace {

void warn_of_missing_saturation(const std::vector<ChannelTransfer>& channels) {
  std::string unsaturated;
  for (const ChannelTransfer& one : channels)
    if (!one.transfer.saturation_e) unsaturated += (unsaturated.empty() ? "" : ", ") + one.channel;
  if (unsaturated.empty()) return;
  print_message(
      fmt::format("warning: no flat pair saturates {}, so that full well and dynamic range are unknown: add "
                  "a pair above saturation",
                  unsaturated));
}

// Warns of a gain that is biased by a response that is not linear.
void warn_of_nonlinearity(const std::vector<ChannelTransfer>& channels) {
  constexpr double kNegligible = 0.01;
  constexpr double kStandardErrors = 3;
  for (const ChannelTransfer& one : channels) {
    const auto& bias = one.transfer.gain_bias;
    const double limit = bias ? std::max(kNegligible, kStandardErrors * bias->standard_error) : 0;
    if (!bias || std::abs(bias->value) <= limit) continue;
    print_message(fmt::format(
        "warning: {} does not respond linearly, so that its gain and all its figures in electrons are {:.2g} "
        "% too {} (the gain in weak light is {:.5g} e/DN): use weaker light, or linearise the response first",
        one.channel, 100 * std::abs(bias->value), bias->value > 0 ? "large" : "small",
        one.transfer.gain_e_per_dn / (1 + bias->value)));
  }
}

}  // namespace

int transfer(const TransferOptions& options) {
  if (!options.plot.empty()) require_extension(options.plot, {".svg"});
  Inputs inputs(options.max_memory_bytes);
  std::vector<std::string> warnings;
  const std::vector<ChannelTransfer> channels =
      measure_transfer(options.dark, options.flat, inputs, &warnings);
  for (const std::string& warning : warnings) print_message("warning: " + warning);
  warn_of_missing_saturation(channels);
  warn_of_nonlinearity(channels);
  Json answer;
  for (const ChannelTransfer& one : channels) {
    const PhotonTransfer& transfer = one.transfer;
    answer["channel"].push_back(one.channel);
    answer["gain_e_per_dn"].push_back(transfer.gain_e_per_dn);
    answer["gain_standard_error"].push_back(transfer.gain_standard_error);
    answer["read_noise_e"].push_back(transfer.read_noise_e);
    answer["read_noise_standard_error"].push_back(
        transfer.read_noise_standard_error ? Json(*transfer.read_noise_standard_error) : Json());
    answer["dark_e_per_s"].push_back(transfer.dark_e_per_s);
    answer["prnu_percent"].push_back(transfer.prnu_percent);
    answer["dsnu_e"].push_back(transfer.dsnu_e);
    answer["full_well_e"].push_back(transfer.full_well_e ? Json(*transfer.full_well_e) : Json());
    const std::optional<double>& range_db = one.dynamic_range_db;
    answer["dynamic_range_db"].push_back(range_db && std::isfinite(*range_db) ? Json(*range_db) : Json());
    answer["snr10_e"].push_back(one.snr10_e);
    const std::optional<double>& nonlinear = transfer.linearity_error_percent;
    answer["linearity_error_percent"].push_back(nonlinear ? Json(*nonlinear) : Json());
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
