#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/render.h"
#include "description/load.h"
#include "develop/film_sensor.h"
#include "develop/relight.h"
#include "io/image.h"
#include "preview/page_server.h"
#include "transport/render/render.h"
#include "transport/render/sample_ranges.h"

namespace abbe::cli {

/// Parsers and checks of option values. All throw Error{usage} that names the option, the given text and the
/// allowed values. `option` only names the option in that error; `text` is its value.

/// One or more numbers separated by commas, each in [low, high], in the given order.
[[nodiscard]] std::vector<double> parse_numbers(const std::string& option, const std::string& text,
                                                double low, double high);
/// An integer in [low, high]. Digits are exact to the last one; forms such as "1e6" are read as doubles.
[[nodiscard]] std::int64_t parse_integer(const std::string& option, const std::string& text, std::int64_t low,
                                         std::int64_t high);
/// Index of `text` in `names`, in equal case.
[[nodiscard]] std::size_t parse_choice(const std::string& option, const std::string& text,
                                       const std::vector<std::string>& names);
/// Three numbers separated by commas, within the range of floats like those of scenes.
[[nodiscard]] std::array<double, 3> parse_triple(const std::string& option, const std::string& text);
/// A positive time [s]: "60s", "2m", "1h" or a number of seconds.
[[nodiscard]] double parse_seconds(const std::string& option, const std::string& text);
/// An amount of memory [bytes] from 1 to 1e18: "4G", "500M", "64k" (powers of 1000) or a number of bytes.
[[nodiscard]] std::size_t parse_bytes(const std::string& option, const std::string& text);
/// A fraction in (0, 1): "0.5%" or "0.005", both of which are 0.005.
[[nodiscard]] double parse_fraction(const std::string& option, const std::string& text);
/// "name=factor" with a factor in [0, 1e30], or with one factor per plane separated by commas. The first "="
/// ends the name.
[[nodiscard]] LightFactor parse_light_factor(const std::string& option, const std::string& text);
/// "bias", "dark" or "flat", the latter optionally with a fraction of saturation from 1e-9 to 10, such as
/// "flat:0.5". The default fraction is that of `FlatFrame`.
[[nodiscard]] CalibrationFrame parse_calibration_frame(const std::string& option, const std::string& text);
/// "x0,y0,x1,y1" in pixels, with 0 <= x0 < x1 and 0 <= y0 < y1; x1 and y1 are excluded.
[[nodiscard]] Crop parse_crop(const std::string& option, const std::string& text);
/// Pixels of a film to evaluate. They are those of the `requested` crop, all of which the film must have
/// recorded. Without a crop they are all pixels that the film has recorded, which must be one rectangle:
/// throws for a film with gaps. Errors name `--crop`.
[[nodiscard]] Crop requested_pixels(const Image& film, const std::optional<Crop>& requested);
/// "lights", optionally with names as in "lights:key,fill", or "bounces", optionally with a maximum from 1 to
/// 64 as in "bounces:4" (default 8).
[[nodiscard]] LayerChoice parse_layer_choice(const std::string& option, const std::string& text);
[[nodiscard]] std::vector<Feature> parse_feature_list(const std::string& option, const std::string& text);
/// "a:b", integers with 0 <= a < b: the samples a to b - 1.
[[nodiscard]] SampleRange parse_sample_range(const std::string& option, const std::string& text);
/// "port" or "address:port", with IPv6 addresses in brackets. Port 0 selects any free port. Without an
/// address only this machine can connect.
[[nodiscard]] ServerAddress parse_server_address(const std::string& option, const std::string& text);
/// "port" or "host:port" of a listening program, with port > 0 and IPv6 addresses in brackets. The default
/// host is this machine.
[[nodiscard]] ServerAddress parse_viewer_address(const std::string& option, const std::string& text);
[[nodiscard]] Override parse_override(const std::string& option, const std::string& text);

}  // namespace abbe::cli
