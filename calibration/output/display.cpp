#include "calibration/output/display.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <system_error>
#include <utility>

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include "calibration/fit/correction.h"
#include "calibration/output/ocio.h"
#include "io/error.h"
#include "io/exr.h"
#include "io/picture_codec.h"
#include "io/text.h"
#include "sensor/film/crop.h"
#include "spectral/library.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

namespace OCIO = OCIO_NAMESPACE;

constexpr const char* kChart = "colorchecker24_babelcolor_average";
constexpr double kPercentile = 0.99;
constexpr float kClipTolerance = 1e-5F;  // float rounding of a white at exactly 1 does not count as clipping

void require_displayable(std::size_t channels) {
  if (channels == 1 || channels == 3) return;
  throw Error(ErrorCode::usage, "display",
              fmt::format("a picture needs a sensor of one or three channels (got {})", channels));
}

std::vector<const ImageChannel*> planes(const Image& film, const std::vector<std::string>& names) {
  std::vector<const ImageChannel*> found;
  for (const std::string& name : names) {
    found.push_back(film.find(name));
    if (found.back() == nullptr || found.back()->values.size() != film.pixels())
      throw Error(ErrorCode::input, "film", "has no complete channel " + name);
  }
  return found;
}

std::array<double, 3> film_values(const std::vector<const ImageChannel*>& film_planes, std::size_t pixel) {
  std::array<double, 3> values{};
  for (std::size_t k = 0; k < film_planes.size(); ++k) values[k] = film_planes[k]->values[pixel];
  return values;
}

// True if a code value was too high.
bool clip(float* rgb) {
  const bool too_high = std::any_of(rgb, rgb + 3, [](float v) { return !(v <= 1 + kClipTolerance); });
  for (float* v = rgb; v != rgb + 3; ++v) *v = std::isnan(*v) ? 0.0F : std::clamp(*v, 0.0F, 1.0F);
  return too_high;
}

Image split_planes(const std::vector<float>& packed, const Image& film, bool grey) {
  Image image{film.width, film.height, {}, film.metadata};
  const std::vector<std::string> names =
      grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    ImageChannel channel{names[k], std::vector<float>(film.pixels())};
    for (std::size_t i = 0; i < film.pixels(); ++i) channel.values[i] = packed[3 * i + k];
    image.channels.push_back(std::move(channel));
  }
  return image;
}

std::string aces_space(const OCIO::Config& config, const std::string& file) {
  for (const char* name : {"aces_interchange", "ACES2065-1", "ACES - ACES2065-1"})
    if (config.getColorSpace(name)) return name;
  throw Error(ErrorCode::input, file,
              "has neither the role aces_interchange nor a colour space ACES2065-1, one of which is needed "
              "for the film's colours");
}

std::string choose(const char* option, const std::string& requested, int count,
                   const std::function<const char*(int)>& name) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.emplace_back(name(i));
  if (names.empty()) throw Error(ErrorCode::input, option, "the OpenColorIO configuration has none");
  if (requested.empty()) return names.front();
  if (std::ranges::find(names, requested) == names.end())
    throw Error(ErrorCode::usage, option,
                fmt::format("got {}, allowed {}", requested, fmt::join(names, ", ")));
  return requested;
}

struct ChosenView {
  OCIO::ConstConfigRcPtr config;
  std::string display;
  std::string view;
};

// Throws an Error for a configuration that is not a regular file: OpenColorIO would wait for the writer of a
// FIFO. Names of its own, such as "ocio://default", are not files.
void require_no_device(const std::filesystem::path& config) {
  std::error_code ignored;
  if (std::filesystem::exists(config, ignored)) require_file(config);
}

ChosenView choose_view(const ViewOptions& options) {
  const bool is_builtin = options.config.empty();
  if (!is_builtin) require_no_device(options.config);
  std::istringstream text(is_builtin ? ocio_config_text({}) : "");
  const OCIO::ConstConfigRcPtr config = is_builtin ? OCIO::Config::CreateFromStream(text)
                                                   : OCIO::Config::CreateFromFile(options.config.c_str());
  // Abbe's configuration offers all displays: $OCIO_ACTIVE_DISPLAYS refers to a user's configuration.
  const std::string display =
      choose("--screen", options.display, is_builtin ? config->getNumDisplaysAll() : config->getNumDisplays(),
             [&](int i) { return is_builtin ? config->getDisplayAll(i) : config->getDisplay(i); });
  const std::string view = choose("--view", options.view, config->getNumViews(display.c_str()),
                                  [&](int i) { return config->getView(display.c_str(), i); });
  return {config, display, view};
}

[[noreturn]] void refuse_configuration(const ViewOptions& options, const OCIO::Exception& why) {
  throw Error(options.config.empty() ? ErrorCode::internal : ErrorCode::input, "OpenColorIO", why.what());
}

Gamut gamut_of(bool is_builtin, const std::string& display, const std::string& view) {
  if (!is_builtin || view != kPlainView) return Gamut(kAcesCg);
  return Gamut(codes_of_display(display).space, 1);
}

// Attributes that describe a picture's codes. A user's configuration only names its displays.
std::map<std::string, std::string> code_attributes(bool is_builtin, const std::string& display) {
  if (!is_builtin) return {{kColorSpace, "that of " + display}};
  const DisplayCodes& codes = codes_of_display(display);
  return {{kColorSpace, codes.color_space}, {kPrimariesKey, primaries_text(codes.space)}};
}

DisplayTransform grey_display(const Channel& channel, const ViewOptions& options) {
  const XYZ white = unit_xyz(kD65);
  return {{channel.name}, Matrix3(white[0], 0, 0, white[1], 0, 0, white[2], 0, 0), options};
}

// Matrix from film values of three sensor channels to XYZ in the light.
Matrix3 fitted_matrix(const std::vector<Channel>& channels, const std::vector<std::string>& names,
                      const Curve& illuminant) {
  const Chart chart = shipped_chart(kChart);
  try {
    const std::vector<double> diffuser = diffuser_values(channels, illuminant);
    const CorrectionFit fit = fit_correction(integrate(chart, channels, illuminant));
    const Matrix3 balance = diagonal({diffuser[1] / diffuser[0], 1, diffuser[1] / diffuser[2]});
    return linear_part(fit.correction) * balance;
  } catch (const Error& error) {
    if (error.code != ErrorCode::input) throw;
    throw Error(ErrorCode::usage, "display",
                fmt::format("in its light, channels {} do not distinguish colours between {} and {} nm, so "
                            "no colour picture can be made of them: {}",
                            fmt::join(names, ", "), SumRange{}.low_nm, SumRange{}.high_nm, error.what()));
  }
}

constexpr const char* kOption = "--ocio";

std::string light_of(const OcioCameraSpace& space) {
  return space.name.substr(std::string_view(kCameraPrefix).size());
}

// Distance of chromaticities; infinite for a light that is not an illuminant of the data directory.
double distance(const OcioCameraSpace& space, const Chromaticity& white) {
  Diagnostics unknown;
  const auto light = load_illuminant(light_of(space), {}, unknown);
  if (!light) return std::numeric_limits<double>::infinity();
  const Chromaticity xy = chromaticity(light->curve);
  return std::hypot(xy[0] - white[0], xy[1] - white[1]);
}

// Space of the film's white: by name, else by the nearest chromaticity.
const OcioCameraSpace& choose(const std::vector<OcioCameraSpace>& spaces, const std::string& white_name,
                              const std::optional<Chromaticity>& white) {
  if (spaces.size() == 1) return spaces.front();
  std::vector<std::string> names;
  const OcioCameraSpace* nearest = nullptr;
  double min_distance = std::numeric_limits<double>::infinity();
  for (const OcioCameraSpace& space : spaces) {
    if (light_of(space) == white_name) return space;
    names.push_back(space.name);
    const double candidate = white ? distance(space, *white) : min_distance;
    if (candidate < min_distance) nearest = &space;
    min_distance = std::min(candidate, min_distance);
  }
  if (nearest == nullptr)
    throw Error(
        ErrorCode::usage, kOption,
        fmt::format("has several camera spaces, none of which is for the film's white (got {}, allowed "
                    "a white among {})",
                    white_name.empty() ? "none" : white_name, fmt::join(names, ", ")));
  return *nearest;
}

Matrix3 in_order_of(std::span<const std::string> channels, const Matrix3& rgb) {
  const auto order = rgb_order(channels);
  Matrix3 ordered = rgb;
  for (std::size_t k = 0; order && k < 3; ++k)
    for (int i = 0; i < 3; ++i) ordered[i][static_cast<int>((*order)[k])] = rgb[i][static_cast<int>(k)];
  return ordered;
}

}  // namespace

struct DisplayTransform::Processor {
  Gamut gamut;
  Matrix3 to_input;  // from linear RGB of the gamut
  OCIO::ConstCPUProcessorRcPtr cpu;
  std::map<std::string, std::string> attributes;  // description of the codes
};

std::filesystem::path users_configuration() {
  const char* named = std::getenv("OCIO");
  return named == nullptr ? "" : named;
}

std::vector<std::string> view_names(const ViewOptions& options) {
  try {
    const auto [config, display, view] = choose_view(options);
    std::vector<std::string> names{view};
    for (int i = 0; i < config->getNumViews(display.c_str()); ++i)
      if (const std::string name = config->getView(display.c_str(), i); name != view) names.push_back(name);
    return names;
  } catch (const OCIO::Exception& e) {
    refuse_configuration(options, e);
  }
}

DisplayTransform::DisplayTransform(std::vector<std::string> channels, const Matrix3& to_xyz_d65,
                                   const ViewOptions& options)
    : channels_(std::move(channels)), to_xyz_d65_(to_xyz_d65) {
  require_displayable(channels_.size());
  const bool is_builtin = options.config.empty();
  try {
    const auto [config, display, view] = choose_view(options);
    const std::string input = is_builtin ? kReferenceSpace : aces_space(*config, options.config.string());
    const Gamut gamut = gamut_of(is_builtin, display, view);
    const Matrix3 from_xyz = is_builtin ? Matrix3() : rgb_to_xyz_d65(kAces2065).inverse();
    // Lossless, because the fast powers and logarithms of other settings have unbounded errors, which are
    // large for negative values on some processors.
    const OCIO::ConstProcessorRcPtr processor =
        config->getProcessor(input.c_str(), display.c_str(), view.c_str(), OCIO::TRANSFORM_DIR_FORWARD);
    processor_ = std::make_shared<const Processor>(Processor{
        gamut, from_xyz * gamut.to_xyz_d65, processor->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS),
        code_attributes(is_builtin, display)});
    if (is_builtin) return;
    files_.push_back(options.config);
    const OCIO::ConstProcessorMetadataRcPtr used = processor->getProcessorMetadata();
    for (int i = 0; i < used->getNumFiles(); ++i) files_.emplace_back(used->getFile(i));
  } catch (const OCIO::Exception& e) {
    refuse_configuration(options, e);
  }
}

DisplayPicture DisplayTransform::operator()(const Image& film, std::optional<double> scale) const {
  const std::vector<const ImageChannel*> film_planes = planes(film, channels_);
  DisplayPicture picture;
  picture.scale = scale ? *scale : automatic_scale(film);
  if (film.pixels() == 0) return picture;
  const auto& [gamut, to_input, cpu, attributes] = *processor_;
  const Matrix3 to_gamut = gamut.from_xyz_d65 * to_xyz_d65_ * picture.scale;
  std::vector<float> packed(3 * film.pixels(), 0.0F);
  std::vector<bool> too_bright(film.pixels());
  ImageChannel outside{"Y", std::vector<float>(film.pixels())};
  for (std::size_t i = 0; i < film.pixels(); ++i) {
    const MappedColor mapped = map_into(gamut, multiply(to_gamut, film_values(film_planes, i)));
    const std::array<double, 3> input = multiply(to_input, mapped.rgb);
    std::copy(input.begin(), input.end(), packed.begin() + static_cast<std::ptrdiff_t>(3 * i));
    outside.values[i] = mapped.outside ? 1.0F : 0.0F;
    too_bright[i] = mapped.too_bright;
  }
  OCIO::PackedImageDesc pixels(packed.data(), film.width, film.height, 3);
  try {
    cpu->apply(pixels);
  } catch (const OCIO::Exception& e) {
    throw Error(ErrorCode::internal, "OpenColorIO", e.what());
  }
  std::size_t clipped = 0;
  for (std::size_t i = 0; i < film.pixels(); ++i) clipped += clip(&packed[3 * i]) || too_bright[i] ? 1U : 0U;
  const auto count = static_cast<double>(recorded_pixels(film).size());
  picture.clipped_fraction = static_cast<double>(clipped) / count;
  picture.outside_fraction = std::accumulate(outside.values.begin(), outside.values.end(), 0.0) / count;
  picture.outside = {film.width, film.height, {std::move(outside)}, film.metadata};
  picture.image = split_planes(packed, film, channels_.size() == 1);
  for (const auto& [key, text] : attributes) picture.image.metadata[key] = text;
  picture.image.metadata[kDisplayExposureKey] = fmt::format("{:.7g}", 1 / picture.scale);
  return picture;
}

double DisplayTransform::automatic_scale(const Image& film) const {
  const std::vector<const ImageChannel*> film_planes = planes(film, channels_);
  const Gamut gamut(kRec709);
  const Matrix3 to_gamut = gamut.from_xyz_d65 * to_xyz_d65_;
  std::vector<double> brightness;
  for (const std::size_t i : recorded_pixels(film)) {
    const std::array<double, 3> rgb = multiply(to_gamut, film_values(film_planes, i));
    if (!std::all_of(rgb.begin(), rgb.end(), [](double v) { return std::isfinite(v); })) continue;
    const MappedColor mapped = map_into(gamut, rgb);
    brightness.push_back(*std::max_element(mapped.rgb.begin(), mapped.rgb.end()));
  }
  if (brightness.empty()) return 1;
  const auto rank = static_cast<std::ptrdiff_t>(kPercentile * static_cast<double>(brightness.size() - 1));
  std::nth_element(brightness.begin(), brightness.begin() + rank, brightness.end());
  double bright = brightness[static_cast<std::size_t>(rank)];
  if (!(bright > 0)) bright = *std::max_element(brightness.begin(), brightness.end());
  return bright > 0 ? 1 / bright : 1;
}

Matrix3 white_adaptation(const Chromaticity& white) {
  return adaptation(unit_xyz(white), unit_xyz(kD65)).value_or(Matrix3());
}

DisplayTransform make_display(const std::vector<Channel>& channels, const Curve& illuminant,
                              const ViewOptions& options, std::optional<Chromaticity> white) {
  require_displayable(channels.size());
  if (channels.size() == 1) return grey_display(channels.front(), options);
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  const std::optional<Observer> observer = standard_observer(channels);
  const FilmObserver film_observer{observer.value_or(Observer::cie1931)};
  const Matrix3 adapted = white_adaptation(white.value_or(chromaticity(illuminant, film_observer)));
  const Matrix3 to_xyz = observer ? Matrix3() : fitted_matrix(channels, names, illuminant);
  return {std::move(names), adapted * to_xyz, options};
}

std::optional<std::array<double, 3>> brightest_neutral(const Matrix3& to_xyz_d65,
                                                       const std::vector<double>& saturation) {
  std::array<double, 3> neutral = multiply(to_xyz_d65.inverse(true), unit_xyz(kD65));
  double brightest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < neutral.size(); ++k) {
    if (!(neutral[k] > 0 && saturation[k] > 0)) return std::nullopt;
    brightest = std::min(brightest, saturation[k] / neutral[k]);
  }
  for (double& value : neutral) value *= brightest;
  return neutral;
}

void clip_to_white(Image& planes, const std::vector<std::string>& channels, const Matrix3& to_xyz_d65,
                   const std::vector<double>& saturation) {
  const auto white = brightest_neutral(to_xyz_d65, saturation);
  if (!white) return;
  for (ImageChannel& channel : planes.channels) {
    const auto found = std::find(channels.begin(), channels.end(), channel.name);
    if (found == channels.end()) continue;
    const auto highest = static_cast<float>((*white)[static_cast<std::size_t>(found - channels.begin())]);
    for (float& value : channel.values) value = std::min(value, highest);
  }
}

std::optional<CameraMatrix> camera_matrix(const ViewOptions& view, std::span<const std::string> channels,
                                          const std::string& white_name, std::optional<Chromaticity> white) {
  const bool is_observer = std::ranges::equal(channels, std::array<std::string, 3>{"X", "Y", "Z"});
  if (view.config.empty() || channels.size() != 3 || is_observer) return std::nullopt;
  const std::vector<OcioCameraSpace> spaces = camera_spaces(view.config);
  if (spaces.empty()) return std::nullopt;
  const OcioCameraSpace& space = choose(spaces, white_name, white);
  if (!space.to_xyz_d65 || !is_invertible(*space.to_xyz_d65))
    throw Error(ErrorCode::usage, kOption,
                fmt::format("\"{}\" is not a matrix, which films need (allowed: a configuration of calibrate "
                            "--correction matrix)",
                            space.name));
  const Matrix3 matrix = in_order_of(channels, *space.to_xyz_d65);
  const std::array<double, 3> neutral = multiply(matrix.inverse(true), unit_xyz(kD65));
  return CameraMatrix{space.name, matrix * neutral[1]};
}

}  // namespace abbe
