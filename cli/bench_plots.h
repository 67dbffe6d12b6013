#pragma once

#include <filesystem>
#include <string>

#include "cli/answer.h"
#include "io/inputs.h"

namespace abbe::cli {

/// The colour of a channel's line, as SVG names it: its own of R, G and B, else one by its number.
[[nodiscard]] std::string line_color(const std::string& channel, std::size_t i);

/// The photon-transfer curves of what `abbe transfer --json` answers, as SVG: variance over signal as
/// measured, and the line of each channel's gain.
[[nodiscard]] std::string transfer_plot(const Json& answer);

/// The modulation transfer function of what `abbe mtf --json` answers, as SVG.
[[nodiscard]] std::string mtf_plot(const Json& answer);

using PlotOfAnswer = std::string (*)(const Json&);

/// An answer from a file, of which `plot` can be drawn. Throws Error{input} where it cannot.
[[nodiscard]] Json read_answer(const std::filesystem::path& path, const PlotOfAnswer& plot, Inputs& inputs);

}  // namespace abbe::cli
