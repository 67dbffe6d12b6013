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
#include "transport/render/sampled_areas.h"

namespace abbe::cli {

/// Parsers of option values. All throw Error{usage} that names the option, the given text and the allowed
/// values.

/// One or more numbers separated by commas, each in [low, high].
[[nodiscard]] std::vector<double> parse_numbers(const std::string& option, const std::string& text,
                                                double low, double high);
/// An integer in [low, high] that a double represents exactly.
[[nodiscard]] std::int64_t parse_integer(const std::string& option, const std::string& text, std::int64_t low,
                                         std::int64_t high);
/// Index of `text` in `names`.
[[nodiscard]] std::size_t parse_choice(const std::string& option, const std::string& text,
                                       const std::vector<std::string>& names);
/// Three numbers separated by commas, in single precision like those of scenes.
[[nodiscard]] std::array<double, 3> parse_triple(const std::string& option, const std::string& text);
/// A positive time [s]: "60s", "2m", "1h" or a number of seconds.
[[nodiscard]] double parse_seconds(const std::string& option, const std::string& text);
/// A positive amount of memory [bytes]: "4G", "500M", "64k" (powers of 1000) or a number of bytes.
[[nodiscard]] std::size_t parse_bytes(const std::string& option, const std::string& text);
/// A fraction in (0, 1): "0.5%" or "0.005".
[[nodiscard]] double parse_fraction(const std::string& option, const std::string& text);
/// "name=factor" with a factor >= 0, or with one factor per plane separated by commas.
[[nodiscard]] LightFactor parse_light_factor(const std::string& option, const std::string& text);
/// "bias", "dark" or "flat", the latter optionally with a fraction of saturation, such as "flat:0.5".
[[nodiscard]] CalibrationFrame parse_calibration_frame(const std::string& option, const std::string& text);
/// "x0,y0,x1,y1" in pixels, with x0 < x1 and y0 < y1.
[[nodiscard]] Crop parse_crop(const std::string& option, const std::string& text);
/// Pixels of a film to evaluate: those of `--crop`, which the film must contain, or the rectangle that the
/// film has.
[[nodiscard]] Crop requested_pixels(const Image& film, const std::optional<Crop>& requested);
/// "lights", optionally with names as in "lights:key,fill", or "bounces", optionally with a maximum as in
/// "bounces:4".
[[nodiscard]] LayerChoice parse_layer_choice(const std::string& option, const std::string& text);
/// Names of first-hit features separated by commas.
[[nodiscard]] std::vector<Feature> parse_feature_list(const std::string& option, const std::string& text);
/// "a:b", integers with a < b.
[[nodiscard]] SampleRange parse_sample_range(const std::string& option, const std::string& text);
/// "port" or "address:port", with IPv6 addresses in brackets. Without an address only this machine can
/// connect.
[[nodiscard]] ServerAddress parse_server_address(const std::string& option, const std::string& text);
/// "port" or "host:port" of a listening program, with port > 0 and IPv6 addresses in brackets. The default
/// host is this machine.
[[nodiscard]] ServerAddress parse_viewer_address(const std::string& option, const std::string& text);
/// "/pointer=value".
[[nodiscard]] Override parse_override(const std::string& option, const std::string& text);

}  // namespace abbe::cli
