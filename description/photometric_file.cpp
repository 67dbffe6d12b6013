// Files of luminous intensity: ANSI/IES LM-63 and EULUMDAT.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "description/light.h"
#include "io/text.h"

namespace abbe::description {
namespace {

using Text = std::shared_ptr<const SourceText>;

constexpr std::size_t kMaxAngles = 3601;  // a tenth of a degree all around
constexpr double kMaxNumber = 1e9;

// A part of the text of a file.
struct Piece {
  std::string_view text;
  std::size_t offset;
};

// The part without surrounding blanks.
Piece trimmed(const Piece& piece) {
  const std::size_t begin = piece.text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {{}, piece.offset};
  const std::size_t end = piece.text.find_last_not_of(" \t\r");
  return {piece.text.substr(begin, end - begin + 1), piece.offset + begin};
}

// The lines of a text without surrounding blanks; lines end in LF, CR LF or CR.
std::vector<Piece> lines_of_text(std::string_view text) {
  std::vector<Piece> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    lines.push_back(trimmed({text.substr(at, end - at), at}));
    at = end + (text.substr(end).starts_with("\r\n") ? 2 : 1);
  }
  return lines;
}

// Numbers allowed for one value.
struct Allowed {
  double min;
  double max;
  std::string_view text;
};
constexpr Allowed kAny{-kMaxNumber, kMaxNumber, "a number in [-1e9, 1e9]"};
constexpr Allowed kPositiveFactor{1e-9, kMaxNumber, "a number in [1e-9, 1e9]"};
constexpr Allowed kNotNegative{0, kMaxNumber, "a number in [0, 1e9]"};
constexpr Allowed kVerticalAngle{0, 180, "degrees in [0, 180]"};
constexpr Allowed kHorizontalAngle{0, 360, "degrees in [0, 360]"};
constexpr Allowed kCount{1, static_cast<double>(kMaxAngles), "an integer in [1, 3601]"};
constexpr Allowed kVerticalCount{2, static_cast<double>(kMaxAngles), "an integer in [2, 3601]"};

// Reads the values of a file in order. After a fault, which is reported once, it returns zeros.
class ValueReader {
 public:
  // `values` are the pieces of the text that hold one value each.
  ValueReader(Text text, std::vector<Piece> values, bool decimal_comma, Diagnostics& diagnostics)
      : text_(std::move(text)),
        values_(std::move(values)),
        decimal_comma_(decimal_comma),
        diagnostics_(diagnostics) {}

  double number(std::string_view what, const Allowed& allowed = kAny) {
    const std::optional<Piece> piece = next(what);
    if (!piece) return 0;
    std::string digits(piece->text);
    if (decimal_comma_) std::ranges::replace(digits, ',', '.');
    if (digits.starts_with('+')) digits.erase(0, 1);
    const std::optional<double> value = parse_number(digits);
    if (value && *value >= allowed.min && *value <= allowed.max) return *value;
    fail(*piece, what, allowed.text);
    return 0;
  }
  // An integer in a range of `allowed`.
  std::size_t integer(std::string_view what, const Allowed& allowed) {
    const std::size_t at = at_;
    const double value = number(what, allowed);
    if (!failed_ && value != std::floor(value)) fail(values_[at], what, allowed.text);
    return failed_ ? 0 : static_cast<std::size_t>(value);
  }
  // Numbers that ascend strictly, unless `ascending` is false.
  std::vector<double> numbers(std::size_t count, std::string_view what, const Allowed& allowed,
                              bool ascending = true) {
    std::vector<double> found;
    if (failed_ || !require(count, what)) return found;
    found.reserve(count);
    for (std::size_t i = 0; i < count && !failed_; ++i) {
      found.push_back(number(what, allowed));
      if (!failed_ && ascending && i > 0 && !(found[i] > found[i - 1]))
        fail(values_[at_ - 1], what, fmt::format("more than the angle before it, {:g}", found[i - 1]));
    }
    return found;
  }
  void skip(std::size_t count, std::string_view what) {
    if (!failed_ && require(count, what)) at_ += count;
  }
  // Reports that the last value is not allowed.
  void refuse_last(std::string_view what, std::string_view allowed) {
    if (!failed_) fail(values_[at_ - 1], what, allowed);
  }
  [[nodiscard]] bool failed() const { return failed_; }
  // True if values are left. The position is that of the first one.
  [[nodiscard]] bool more() const { return at_ < values_.size(); }
  [[nodiscard]] SourcePosition where() const { return {text_, values_[at_].offset, ""}; }

 private:
  bool require(std::size_t count, std::string_view what) {
    if (count <= values_.size() - at_) return true;
    failed_ = true;
    diagnostics_.error({text_, values_.empty() ? 0 : values_.back().offset, ""},
                       fmt::format("the file ends too early, at the {} (got {} values, expected {})", what,
                                   values_.size() - at_, count),
                       ErrorCode::input);
    return false;
  }
  std::optional<Piece> next(std::string_view what) {
    if (failed_ || !require(1, what)) return std::nullopt;
    return values_[at_++];
  }
  void fail(const Piece& piece, std::string_view what, std::string_view allowed) {
    failed_ = true;
    diagnostics_.error(
        {text_, piece.offset, ""},
        fmt::format("{} (got \"{}\", allowed {})", what, valid_utf8(piece.text.substr(0, 40)), allowed),
        ErrorCode::input);
  }

  Text text_;
  std::vector<Piece> values_;
  bool decimal_comma_;
  Diagnostics& diagnostics_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

// Intensities as a file has them.
struct MeasuredPlanes {
  std::vector<double> gammas_deg;
  std::vector<double> planes_deg;        // in the order of the file
  std::vector<double> candelas;          // by half-plane, then by gamma
  std::vector<double> mirrors_deg = {};  // Planes of symmetry: C has the intensities of 2 m - C.
};

// All half-planes around the axis, with those that the symmetry implies. The last one repeats the first.
IntensityDistribution::Table all_around(const MeasuredPlanes& measured) {
  const auto wrapped = [](double degrees) {
    const double rest = std::fmod(degrees, 360.0);
    return rest < 0 ? rest + 360 : rest;
  };
  std::map<double, std::size_t> sources;  // index of the measured half-plane by angle
  for (std::size_t i = 0; i < measured.planes_deg.size(); ++i)
    sources.emplace(wrapped(measured.planes_deg[i]), i);
  for (const double mirror : measured.mirrors_deg) {
    const std::map<double, std::size_t> before = sources;
    for (const auto& [angle, source] : before) sources.emplace(wrapped(2 * mirror - angle), source);
  }
  IntensityDistribution::Table table{measured.gammas_deg, {}, {}};
  const auto add = [&](double angle, std::size_t source) {
    const auto row =
        measured.candelas.begin() + static_cast<std::ptrdiff_t>(source * measured.gammas_deg.size());
    table.planes_deg.push_back(angle);
    table.candelas.insert(table.candelas.end(), row,
                          row + static_cast<std::ptrdiff_t>(measured.gammas_deg.size()));
  };
  for (const auto& [angle, source] : sources) add(angle, source);
  add(sources.begin()->first + 360, sources.begin()->second);
  return table;
}

// The words of lines, between blanks and commas.
std::vector<Piece> words_of(std::span<const Piece> lines) {
  std::vector<Piece> words;
  for (const Piece& line : lines)
    for (std::size_t at = line.text.find_first_not_of(" \t,"); at < line.text.size();) {
      const std::size_t end = std::min(line.text.find_first_of(" \t,", at), line.text.size());
      words.push_back({line.text.substr(at, end - at), line.offset + at});
      at = line.text.find_first_not_of(" \t,", end);
    }
  return words;
}

// Reads and discards the factors of TILT=INCLUDE.
void read_tilt(ValueReader& values, Diagnostics& diagnostics, const SourcePosition& where) {
  values.integer("tilt geometry", {1, 3, "1, 2, 3"});
  const std::size_t count = values.integer("number of tilt angles", kCount);
  values.numbers(count, "tilt angle", kVerticalAngle);
  const std::vector<double> factors = values.numbers(count, "tilt factor", kNotNegative, false);
  if (!values.failed() && std::ranges::any_of(factors, [](double factor) { return factor != 1; }))
    diagnostics.warning(where,
                        "the tilt factors of the file are not applied: the luminaire is used as measured");
}

// The planes of symmetry that the first and last horizontal angle of LM-63 imply.
std::vector<double> mirrors_of(const std::vector<double>& planes, ValueReader& values) {
  const double first = planes.front();
  const double last = planes.back();
  if (first == 0 && (last == 0 || last == 360)) return {};
  if (first == 0 && last == 90) return {90, 0};
  if (first == 0 && last == 180) return {0};
  if (first == 90 && last == 270) return {90};
  values.refuse_last("last horizontal angle",
                     "0, 90, 180 or 360 after a first angle of 0; 270 after a first angle of 90");
  return {};
}

// Reads a file of LM-63 from the keyword TILT on.
std::optional<MeasuredPlanes> read_lm63(const Text& text, Diagnostics& diagnostics) {
  const std::vector<Piece> lines = lines_of_text(text->text);
  const auto tilt = std::ranges::find_if(
      lines, [](const Piece& line) { return lower_case(line.text.substr(0, 5)) == "tilt="; });
  const auto refuse = [&](std::size_t offset, const std::string& what) {
    diagnostics.error({text, offset, ""}, what, ErrorCode::input);
    return std::nullopt;
  };
  if (tilt == lines.end()) return refuse(0, "an IES file needs a line TILT=NONE or TILT=INCLUDE (got none)");
  const std::string tilt_kind = lower_case(trimmed({tilt->text.substr(5), 0}).text);
  if (tilt_kind != "none" && tilt_kind != "include")
    return refuse(tilt->offset,
                  fmt::format("TILT (got \"{}\", allowed NONE, INCLUDE)", valid_utf8(tilt_kind)));
  ValueReader values(text,
                     words_of(std::span(lines).subspan(static_cast<std::size_t>(tilt - lines.begin()) + 1)),
                     false, diagnostics);
  if (tilt_kind == "include") read_tilt(values, diagnostics, {text, tilt->offset, ""});
  values.number("number of light sources", kNotNegative);
  values.number("lumens per light source");
  double factor = values.number("candela multiplier", kPositiveFactor);
  const std::size_t gammas = values.integer("number of vertical angles", kVerticalCount);
  const std::size_t planes = values.integer("number of horizontal angles", kCount);
  values.integer("photometric type", {1, 1, "1, type C; types B (2) and A (3) are not supported"});
  values.integer("units type", {1, 2, "1 for feet, 2 for metres"});
  for (const char* size : {"width", "length", "height"}) values.number(size);
  factor *= values.number("ballast factor", kPositiveFactor);
  // The meaning of this value changed in 1995.
  const std::string header = lower_case(lines.front().text);
  const double photometric_factor = values.number("photometric factor", kNotNegative);
  if (header.find("lm-63-1995") == std::string::npos && header.find("lm-63-20") == std::string::npos) {
    if (!(photometric_factor > 0)) values.refuse_last("photometric factor", "a number greater than 0");
    factor *= photometric_factor;
  }
  values.number("input watts");
  MeasuredPlanes measured;
  measured.gammas_deg = values.numbers(gammas, "vertical angle", kVerticalAngle);
  measured.planes_deg = values.numbers(planes, "horizontal angle", kHorizontalAngle);
  if (!values.failed()) measured.mirrors_deg = mirrors_of(measured.planes_deg, values);
  measured.candelas = values.numbers(gammas * planes, "candela value", kNotNegative, false);
  if (values.failed()) return std::nullopt;
  if (values.more()) diagnostics.warning(values.where(), "values after the last candela value are ignored");
  for (double& candelas : measured.candelas) candelas *= factor;
  return measured;
}

// The intensities are in cd per 1000 lm of the light sources.
std::optional<MeasuredPlanes> read_eulumdat(const Text& text, Diagnostics& diagnostics) {
  ValueReader values(text, lines_of_text(text->text), true, diagnostics);
  values.skip(1, "manufacturer");
  values.skip(1, "type indicator");
  const std::size_t symmetry = values.integer("symmetry indicator", {0, 4, "0, 1, 2, 3, 4"});
  const std::size_t all = values.integer("number of C-planes", kCount);
  if (const std::size_t divisor = symmetry == 4 || symmetry == 3 ? 4
                                  : symmetry == 2                ? 2
                                                                 : 1;
      all % divisor != 0)
    values.refuse_last("number of C-planes",
                       fmt::format("a multiple of {} with symmetry indicator {}", divisor, symmetry));
  values.number("distance between C-planes", kHorizontalAngle);
  const std::size_t gammas = values.integer("number of intensities in a C-plane", kVerticalCount);
  values.number("distance between intensities", kVerticalAngle);
  values.skip(16, "header");  // report, names, date, sizes and light output ratios
  double factor = values.number("conversion factor of the intensities", kPositiveFactor);
  values.number("tilt of the luminaire");
  const std::size_t source_sets =
      values.integer("number of sets of light sources", {1, 20, "an integer in [1, 20]"});
  values.skip(2, "first set of light sources");
  factor *= values.number("luminous flux of the light sources", kPositiveFactor) / 1000;
  values.skip(6 * source_sets - 3, "sets of light sources");
  values.skip(10, "direct ratios");
  const std::vector<double> planes = values.numbers(all, "C-plane", kHorizontalAngle);
  MeasuredPlanes measured;
  measured.gammas_deg = values.numbers(gammas, "gamma angle", kVerticalAngle);
  // Stored half-planes by symmetry indicator: the index of the first one among those all around, their
  // number, and the planes of symmetry.
  const std::array<std::tuple<std::size_t, std::size_t, std::vector<double>>, 5> stored{
      {{0, all, {}},
       {0, 1, {}},
       {0, all / 2 + 1, {0}},
       {3 * all / 4, all / 2 + 1, {90}},
       {0, all / 4 + 1, {90, 0}}}};
  const auto& [first, count, mirrors_deg] = stored.at(symmetry);
  measured.mirrors_deg = mirrors_deg;
  measured.candelas = values.numbers(gammas * count, "luminous intensity", kNotNegative, false);
  if (values.failed()) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) measured.planes_deg.push_back(planes[(first + i) % all]);
  for (double& candelas : measured.candelas) candelas *= factor;
  return measured;
}

}  // namespace

std::shared_ptr<const IntensityDistribution> read_photometric_file(const schema::Located<std::string>& name,
                                                                   LoadContext& context) {
  const auto path = context.file(name.value, name.where);
  if (!path) return nullptr;
  const std::string extension = extension_of(*path);
  const auto refuse = [&](const SourcePosition& where, const std::string& what) {
    context.diagnostics.error(where, what, ErrorCode::input);
    return nullptr;
  };
  if (extension != ".ies" && extension != ".ldt")
    return refuse(name.where, fmt::format("photometric \"{}\" (got \"{}\", allowed .ies, .ldt)", name.value,
                                          path->extension().string()));
  if (!is_file(*path, name.where, context.diagnostics)) return nullptr;
  const Text text = read_unicode_text(*path, context.diagnostics);
  if (!text) return nullptr;
  const auto measured =
      extension == ".ies" ? read_lm63(text, context.diagnostics) : read_eulumdat(text, context.diagnostics);
  if (!measured) return nullptr;
  if (std::ranges::none_of(measured->candelas, [](double candelas) { return candelas > 0; }))
    return refuse({text, SourcePosition::kWholeFile, ""},
                  "all intensities are 0 (got 0, allowed a positive one)");
  const IntensityDistribution::Table table = all_around(*measured);
  context.take_memory(path->string(),
                      IntensityDistribution::memory_bytes(table.gammas_deg.size(), table.planes_deg.size()));
  auto distribution = std::make_shared<const IntensityDistribution>(table);
  if (!(distribution->luminous_flux() > 0))
    return refuse({text, SourcePosition::kWholeFile, ""},
                  "the luminous flux is 0 (got 0, allowed a positive one)");
  return distribution;
}

}  // namespace abbe::description
